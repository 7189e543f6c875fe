#!/usr/bin/env bash
# Nacre: runs our program and each peer that is installed on the same work, in pairs, and prints one table.
# Usage: run.sh [PEER...], of mesh_3 surface_nets tetgen ftetwild openvdb embree surface_lic; all without a word.
# Environment: NACRE_BUILD (build folder; else build/release or build/cpu), PEERS_PYTHON (a python that has the wheels vtk and pytetwild),
# PVPYTHON (ParaView's), PEERS_PHANTOMS (surfaces of which, as torso:64), PEERS_LABELS (other label images for mesh_3, as
# liver=FILE:4.1, the last is the size of triangles in their unit), PEERS_RUNS (pairs of each, default 3),
# PEERS_THREADS (default 2), PEERS_PREFIX (words before each command that is timed, such as "chrt -f 1"), PEERS_SECONDS
# (limit of each command, default 300), PEERS_QUALITY (of our meshes: draft, standard or best, default standard), OUT (keeps
# reports, meshes and peers.json).
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$here/../bench/report.sh"
source "$here/../bench/begin.sh"
source "$here/rows.sh"
for build in "${NACRE_BUILD:-}" "$here"/../../build/{release,cpu}; do
  [[ -z $build || ! -e $build/build.ninja ]] || break
done
begin_bench peers "$build/bin/nacre"
runs=${PEERS_RUNS:-3}
threads=${PEERS_THREADS:-2}
read -ra prefix <<<"timeout ${PEERS_SECONDS:-300} ${PEERS_PREFIX:-}"
: >"$out/rows.tsv"
: >"$out/versions.txt"

# skip PEER WHY: aloud.
skip() {
  echo "run.sh: $1 is skipped: $2" >&2
  return 0
}

# broken WHAT: says so, and the script fails at its end.
broken() {
  echo "run.sh: $1 failed; OUT=folder keeps what it wrote" >&2
  failed=1
}

# built TARGET: builds a program that runs a peer; fails where the build knows no such target. The script ends where it
# does not compile.
built() {
  ninja -C "$build" -t query "$1" >/dev/null 2>&1 || return
  cmake --build "$build" --target "$1" -j1 >"$out/build.log" 2>&1 && return
  grep -m 3 error "$out/build.log" >&2
  echo "run.sh: $1 does not compile" >&2
  exit 1
}

# sample NAME DETAIL: writes a phantom once.
sample() {
  [[ -e $out/$1-$2.nrrd ]] || "$nacre" sample "$1" --detail "$2" --out "$out/$1-$2.nrrd" >/dev/null
}

# ours OUTPUT REPORT INPUT [words of nacre mesh]: one timed run of ours.
ours() {
  "${prefix[@]}" "$nacre" mesh "$3" --labels --quiet --threads "$threads" --quality "${PEERS_QUALITY:-standard}" "${@:4}" --out "$1" --report "$2" >/dev/null
}

# our_seconds REPORT [STAGE..]: computing time of a run: the stages that make the surface, or those named.
our_seconds() {
  local report=$1 stage total=0
  shift
  (($#)) || set -- materials tighten distance sizing embed seed relax population triangulate smooth remesh
  for stage in "$@"; do total="$total + $(stage_seconds "$report" "$stage" | grep . || echo 0)"; done
  awk "BEGIN { print $total }"
}

# pairs OURS THEIRS: calls both functions in turn, and sets our_median and their_median of what they print. Fails, aloud,
# where one of them does.
pairs() {
  local a=() b=() k
  for ((k = 0; k < runs; ++k)); do
    a+=("$($1)") || { broken "$1"; return 1; }
    b+=("$($2)") || { broken "$2"; return 1; }
  done
  our_median=$(printf '%s\n' "${a[@]}" | middle)
  their_median=$(printf '%s\n' "${b[@]}" | middle)
}

# surface_rows NAME WORK: rows of both surfaces, $out/ours-NAME.txt against $out/theirs-NAME.txt.
surface_rows() {
  local key
  for key in vertices triangles radius_ratio_mean radius_ratio_min angle_min share_under_25 stairs_vertex_mean \
    stairs_vertex_max stairs_facet_mean sphere_vertex_mean sphere_vertex_max sphere_facet_mean; do
    [[ -z $(value "$out/ours-$1.txt" "$key") ]] ||
      row "$1" "$2" "$key" "$(value "$out/ours-$1.txt" "$key")" "$(value "$out/theirs-$1.txt" "$key")"
  done
}

for part in mesh band texture; do source "$here/peers_$part.sh"; done

all=(mesh_3 surface_nets tetgen ftetwild openvdb embree surface_lic)
for peer in "${@:-${all[@]}}"; do
  [[ " ${all[*]} " == *" $peer "* ]] || { echo "run.sh: no peer '$peer'; choose from ${all[*]}" >&2; exit 2; }
  "peer_$peer"
done
print_table
write_json >"$out/peers.json"
exit $failed
