#!/usr/bin/env bash
# Nacre: its two filters inside ParaView's own Python (pvpython), with pictures. ParaView is never installed here: it goes
# into a Debian of its own, a folder that debootstrap makes; several hundred megabytes are downloaded the first time.
# Usage: run.sh NACRE WORK [WHEEL]. WORK keeps that folder for the next time; WHEEL is for Python 3.11, else one is made.
# Ends with 77, and says why, where debootstrap, root, the network or Python 3.11 is missing.
set -euo pipefail
nacre=$(readlink -f "${1:?usage: run.sh NACRE WORK [WHEEL]}")
mkdir -p "${2:?usage: run.sh NACRE WORK [WHEEL]}"
work=$(readlink -f "$2")
wheel=${3:-}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../debian/make_root.sh"
python=${PYTHON:-python3.11}
[[ $wheel ]] || command -v "$python" >/dev/null || skip "$python makes the wheel for Debian's ParaView, and is not installed"

make_debian "$work/debian" "$work/debian.log" paraview python3-paraview xvfb xauth libgl1-mesa-dri

if [[ ! $wheel ]]; then
  PYTHON=$python bash "$nacre/python/wheel.sh" "$nacre" "$work/wheel" >"$work/wheel.log" 2>&1 ||
    { tail -20 "$work/wheel.log"; exit 1; }
  wheel=$(ls "$work"/wheel/*cp311*.whl)
fi
rm -rf "$work/debian/opt/nacre" "$work/debian/opt/out"
mkdir -p "$work/debian/opt/nacre" "$work/debian/opt/out"
python3 -m zipfile -e "$wheel" "$work/debian/opt/nacre"
# ParaView 5.11 calls a function that Python 3.11 no longer has, so that Debian's loads no plugin of Python without this.
printf 'import inspect\n\nif not hasattr(inspect, "getargspec"):\n    inspect.getargspec = inspect.getfullargspec\n' \
  >"$work/debian/opt/nacre/sitecustomize.py"
cp "$nacre/python/paraview/nacre_filters.py" "$here/check.py" "$work/debian/opt/"

# Displays of the machine itself cannot be seen from there, but take numbers.
in_debian "$work/debian" xvfb-run -a -n $((1000 + $$ % 50000)) -s "-screen 0 1280x1024x24" pvpython /opt/check.py /opt/nacre_filters.py /opt/out
cp "$work"/debian/opt/out/*.png "$work/"
echo "pictures: $(ls "$work"/*.png | xargs)"
