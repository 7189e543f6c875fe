#!/usr/bin/env bash
# Nacre: the same as run.sh, with OpenFOAM's checkMesh and CalculiX of a Debian of its own, in which they are installed
# (much to download the first time). Usage: solvers.sh NACRE FOLDER [PYTHON]; FOLDER keeps that Debian and what run.sh keeps.
# Ends with 77, and says why, where root, debootstrap or the network is missing.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
mkdir -p "${2:?usage: solvers.sh NACRE FOLDER [PYTHON]}"
folder=$(readlink -f "$2")
source "$here/../debian/make_root.sh"
make_debian "$folder/debian" "$folder/debian.log" openfoam calculix-ccx

# Stand-ins: what is to be read goes into the Debian, and what was written comes back.
mkdir -p "$folder/bin"
cat >"$folder/bin/checkMesh" <<SCRIPT
#!/usr/bin/env bash
# checkMesh -allTopology -case CASE
set -euo pipefail
source "$here/../debian/make_root.sh"
rm -rf "$folder/debian/opt/case"
cp -r "\$3" "$folder/debian/opt/case"
in_debian "$folder/debian" bash -c 'for f in /usr/share/openfoam/etc/bashrc /etc/openfoam/bashrc; do
  [[ -e \$f ]] && source \$f; done; checkMesh -allTopology -case /opt/case'
SCRIPT
cat >"$folder/bin/ccx" <<SCRIPT
#!/usr/bin/env bash
# ccx JOB
set -euo pipefail
source "$here/../debian/make_root.sh"
rm -rf "$folder/debian/opt/job"
mkdir "$folder/debian/opt/job"
cp ./*.inp "$folder/debian/opt/job/"
in_debian "$folder/debian" bash -c "cd /opt/job && ccx \$1"
cp "$folder/debian/opt/job/\$1".* .
SCRIPT
chmod +x "$folder/bin/checkMesh" "$folder/bin/ccx"
said=$(PATH="$folder/bin:$PATH" bash "$here/run.sh" "$1" "$folder" "${@:3}")
echo "$said"
grep -q "^Skipped" <<<"$said" && exit 77
grep -q "checkMesh: the mesh is OK" <<<"$said" && grep -q "^ccx: .* leaves" <<<"$said"
