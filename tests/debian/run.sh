#!/usr/bin/env bash
# Nacre: makes the Debian packages, has lintian look at them, installs them into a Debian of its own, and runs what they
# bring. Usage: run.sh NACRE WORK [PACKAGES]. WORK keeps the Debian; PACKAGES: a folder with packages, else they are made.
# Ends with 77, and says why, where root, debootstrap, lintian or the network is missing.
set -euo pipefail
nacre=$(readlink -f "${1:?usage: run.sh NACRE WORK [PACKAGES]}")
mkdir -p "${2:?usage: run.sh NACRE WORK [PACKAGES]}"
work=$(readlink -f "$2")
packages=${3:-}
source "$(dirname "${BASH_SOURCE[0]}")/make_root.sh"
command -v lintian >/dev/null || skip "lintian is not installed; apt-get install lintian"
make_debian "$work/debian" "$work/debian.log" g++ cmake make

if [[ ! $packages ]]; then
  "$nacre/dev" package >"$work/package.log" 2>&1 || { tail -20 "$work/package.log"; exit 1; }
  packages=$nacre/out/package
fi
lintian --fail-on error,warning "$packages"/*.deb
rm -rf "$work/debian/opt/packages" "$work/debian/opt/examples" "$work/debian/opt/out"
mkdir -p "$work/debian/opt/packages" "$work/debian/opt/out"
cp "$packages"/*.deb "$work/debian/opt/packages/"
cp -r "$nacre/examples" "$work/debian/opt/"
in_debian "$work/debian" bash -euxc '
  apt-get update -q >/dev/null
  apt-get install -y -q --no-install-recommends /opt/packages/*.deb libgl1-mesa-dri >/opt/out/apt.log
  cd /opt/out
  nacre --version
  nacre mesh --sample three-sectors --max-size 2 --quiet --out sectors.vtu --image sectors.png
  for level in x86-64-v2 x86-64-v3; do
    NACRE_LEVEL=$level nacre mesh --sample two-spheres --detail 16 --max-size 4 --quiet --out $level.obj
  done
  ! NACRE_LEVEL=x86-64-v9 nacre --version
  nacre flow --sample torus --detail 48 --resolution 128 --steps 4 --quiet --image torus.png
  nacre view --offscreen --sample sphere --detail 24 --resolution 48 --frames-count 2 --image view.png --quiet
  nacre info sectors.vtu
  test -x /usr/libexec/nacre/nacre-vtk-import
  printf "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n" >t.vtk
  nacre info t.vtk | grep -q "1 triangles"
  zcat /usr/share/man/man1/nacre.1.gz | head -1
  cmake -S /opt/examples -B build -DCMAKE_BUILD_TYPE=Release >cmake.log
  cmake --build build --target labels_to_mesh >>cmake.log
  build/labels_to_mesh balls.vtp balls.vtu
  apt-get purge -y -q nacre libnacre-dev >/opt/out/purge.log
  ! test -e /usr/bin/nacre' || { tail -5 "$work/debian/opt/out"/*.log; exit 1; }
cp "$work/debian/opt/out"/*.png "$work/"
echo "the packages can be installed, run and removed; pictures: $(ls "$work"/*.png | xargs)"
