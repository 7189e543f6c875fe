#!/usr/bin/env bash
# Nacre: writes a mesh with named materials in each format and has programs of others read it, and reads what they write.
# Usage: run.sh NACRE FOLDER [PYTHON]; FOLDER keeps the Python environment for the next time.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
nacre=$(readlink -f "${1:?usage: run.sh NACRE FOLDER [PYTHON]}")
folder=$(readlink -f "${2:?usage: run.sh NACRE FOLDER [PYTHON]}")
python=$folder/venv/bin/python

if ! cmp -s "$here/requirements.txt" "$folder/installed.txt"; then
  rm -rf "$folder/venv" "$folder/installed.txt"
  if ! "${3:-python3}" -m venv "$folder/venv" >"$folder/pip.log" 2>&1 ||
    ! "$python" -m pip install --quiet --disable-pip-version-check -r "$here/requirements.txt" >>"$folder/pip.log" 2>&1; then
    tail -n 3 "$folder/pip.log"
    echo "Skipped: the packages of requirements.txt cannot be installed from PyPI"
    exit 0
  fi
  cp "$here/requirements.txt" "$folder/installed.txt"
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/case"
"$python" "$here/make_inputs.py" "$work"
"$python" -W ignore "$here/make_dicom.py" "$work"

# The meshes are coarse: what pyfebio takes to read one grows with the square of its elements (seven minutes for 6,000).
mesh() {
  "$nacre" mesh "$work/labels.seg.nrrd" --max-size 6 --min-size 4 --quiet --out "$work/$1" "${@:2}" >/dev/null
}
mesh cells.vtu
for file in cells.msh cells.msh4 cells.inp cells.mesh cells.feb cells.xdmf case/liver.foam; do mesh "$file"; done
# The surface of those cells, to compare with: one made from stars has other triangles where these are bad.
mesh surface.glb --triangulation delaunay
for file in surface.msh4 surface.inp surface.xdmf; do mesh "$file" --surface-only --triangulation delaunay; done
"$python" "$here/read_meshes.py" "$work"
mesh curved.vtu --element-order 2 --report "$work/curved.json"
for file in curved.msh curved.msh4 curved.inp curved.mesh curved.feb; do mesh "$file" --element-order 2; done
for file in shells.msh4 shells.inp; do mesh "$file" --element-order 2 --surface-only; done
"$python" "$here/read_second_order.py" "$work"

info() { "$nacre" info --json "$work/$1" "${@:2}" >"$work/$1.json"; }
for file in labels.mgz labels.mgh; do info "$file" --names "$work/names.txt"; done
info a.flow.gii
if command -v checkMesh >/dev/null; then
  head='FoamFile { version 2.0; format ascii; class dictionary; object schemes; }'
  echo "$head" >"$work/case/system/fvSolution"
  echo "$head ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} snGradSchemes {}" \
    >"$work/case/system/fvSchemes"
  checkMesh -allTopology -case "$work/case" >"$folder/checkMesh.log" 2>&1 || true
  grep -q "^Mesh OK" "$folder/checkMesh.log" || { cat "$folder/checkMesh.log"; exit 1; }
  echo "checkMesh: the mesh is OK"
else
  echo "checkMesh is left out: OpenFOAM is not installed"
fi
"$python" "$here/add_steps.py" "$work/case"
if info case/liver.foam; then :; else echo "case/liver.foam is left out: this program reads nothing through VTK"; fi

patches() { "$nacre" info --json "$work/case/liver.foam" --patch "$1"; }
if [[ -s $work/case/liver.foam.json ]]; then
  patches 'outside_kidney*' >"$work/kidney.json"
  if patches inlet >"$work/none.json" 2>"$work/none.txt"; then echo "a patch that does not exist is found"; exit 1; fi
  grep -q "no part inlet.*outside_kidney_left" "$work/none.txt" || { cat "$work/none.txt"; exit 1; }
fi

if "$nacre" info "$work/segments.dcm" >/dev/null 2>"$work/none.txt"; then
  for file in truth.seg.nrrd numbered.seg.nrrd series implicit segments.dcm overlapping.dcm; do info "$file"; done
  for place in gap two; do
    if info "$place" 2>"$work/$place.txt"; then echo "$place is read"; exit 1; fi
  done
  "$nacre" mesh "$work/truth.seg.nrrd" --max-size 3 --quiet --out "$work/truth.ply" >/dev/null
  "$nacre" mesh "$work/series/IM007" --labels --max-size 3 --quiet --out "$work/series.ply" >/dev/null
  "$nacre" mesh "$work/segments.dcm" --max-size 3 --quiet --out "$work/segments.vtu" >/dev/null
  "$nacre" mesh "$work/numbered.seg.nrrd" --max-size 3 --quiet --out "$work/numbered.vtu" >/dev/null
  "$python" "$here/check_dicom.py" "$work"
else
  grep -q "built without GDCM" "$work/none.txt" || { cat "$work/none.txt"; exit 1; }
  echo "DICOM is left out: this program was built without GDCM"
fi
if "$nacre" info --json "$work/image.vtkhdf" >"$work/image.vtkhdf.json" 2>"$work/none.txt"; then
  :
else
  echo "image.vtkhdf is left out: $(<"$work/none.txt")"
fi
"$python" "$here/check_inputs.py" "$work"
