#!/usr/bin/env bash
# Nacre: the octree tables of docs/performance/flow.md, or those named in NACRE_BENCH_CASES (default: all):
#   table   train, aircraft and delta-wing at NACRE_BENCH_RESOLUTIONS (default 512 to 4096), NACRE_BENCH_STEPS steps
#           (default 2) of the samples NACRE_BENCH_SAMPLES
#   large   train at 6000 (64.9 million cells), delta-wing and train at 8192, one step
#   source  both octrees on the train, steady, at 512, 1024 and 2048
#   embree  the builder against Embree: bench_octree_build (its target is not built by default), beside BINARY
#   stray   a million stray triangles at 4096
# Usage: octree.sh BINARY [nacre flow's options, e.g. --device cuda --threads 2]. Reports go to $OUT where it is set.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/begin.sh"
begin_bench octree "$@"
read -ra resolutions <<<"${NACRE_BENCH_RESOLUTIONS:-512 1024 2048 4096}"
read -ra samples <<<"${NACRE_BENCH_SAMPLES:-train aircraft delta-wing}"
steps=${NACRE_BENCH_STEPS:-2}

# wanted CASE: whether it is asked for.
wanted() { [[ -z ${NACRE_BENCH_CASES:-} || " $NACRE_BENCH_CASES " == *" $1 "* ]]; }

# flow NAME OPTIONS...: one run, its report in $out/octree-NAME.json; says so if it fails.
flow() {
  local name=$1
  shift
  "$nacre" flow --method octree --quiet --ttl 2 --warmup 0 "$@" "${options[@]}" --report "$out/octree-$name.json" \
    >/dev/null 2>"$out/octree-$name.err" && return
  printf '| %s | failed: %s |\n' "$name" "$(head -n 1 "$out/octree-$name.err")"
  failed=1
  return 1
}

table_head() {
  printf '| data | N | cells | surface cells | sparseness, %% | read, s | build, s | build, ns per cell | vectors, s | step, s |'
  printf ' step, ns per cell | embedding, bytes per cell | picture 1024x768, s | peak memory, GB |\n'
  printf '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n'
}

# row SAMPLE RESOLUTION STEPS: one run and its line of the table.
row() {
  local report="$out/octree-$1-$2.json"
  flow "$1-$2" --sample "$1" --resolution "$2" --steps "$3" --size 1024x768 --image "$out/octree-$1-$2.png" || return 0
  awk -v name="$1" -v resolution="$2" -v cells="$(report_value "$report" embedding.cells)" \
    -v surface="$(report_value "$report" embedding.surface_cells)" -v build="$(stage_seconds "$report" embed)" \
    -v step="$(report_value "$report" flow.seconds_per_step.median)" -v bytes="$(report_value "$report" embedding.bytes)" \
    -v read="$(stage_seconds "$report" read)" -v vectors="$(stage_seconds "$report" velocity)" \
    -v render="$(stage_seconds "$report" render)" -v memory="$(report_value "$report" memory.peak_bytes)" 'BEGIN {
      printf "| %s | %d | %d | %d | %.5f | ", name, resolution, cells, surface, 100 * (1 - cells / resolution ^ 3)
      printf "%.2f | %.2f | %.0f | %.2f | %.2f | %.0f | ", read, build, 1e9 * build / cells, vectors, step, 1e9 * step / cells
      printf "%.1f | %.2f | %.2f |\n", bytes / cells, render, memory / 1e9
    }'
}

# both RESOLUTION: our octree and the source's over the same cells.
both() {
  local kind values=()
  for kind in brick source; do
    flow "$kind-$1" --sample train --time 0:0 --octree "$kind" --radius 2.24 --resolution "$1" --steps 3 || return 0
    values+=("$(stage_seconds "$out/octree-$kind-$1.json" embed)"
      "$(report_value "$out/octree-$kind-$1.json" flow.seconds_per_step.median)")
  done
  awk -v n="$1" -v a="${values[0]}" -v b="${values[2]}" -v c="${values[1]}" -v d="${values[3]}" \
    'BEGIN { printf "| %d | %.2f | %.2f | %.1f | %.3f | %.2f | %.1f |\n", n, a, b, b / a, c, d, d / c }'
}

# builder MESH OPTIONS...: bench_octree_build's ratios at each of its resolutions.
builder() {
  "$(dirname "$nacre")/bench_octree_build" "$@" threads="$(nproc)" | awk -v radius="${3#radius=}" '
    / triangles, / { mesh = $1; sub(/.*\//, "", mesh); sub(/,$/, "", mesh); triangles = $2; n = $4; cells = $5 }
    $1 == "octree" { ours = $8 }
    $1 == "Embree" && $3 == "s" { theirs = $8 }
    /Embree \/ octree/ {
      printf "| %s, %d triangles | %d | %s | %.3f | %.0f | %.0f | %s | %s |\n", mesh, triangles, n, radius,
        triangles / cells / 1e6, ours, theirs, $6, $8
    }'
}

# strays FILE: a million small triangles anywhere in a cube.
strays() {
  awk 'BEGIN {
    srand(7); n = 1000000; printf "OFF\n%d %d 0\n", 3 * n, n
    for (i = 0; i < n; ++i) {
      x = rand(); y = rand(); z = rand()
      for (k = 0; k < 3; ++k) printf "%.6f %.6f %.6f\n", x + 1e-3 * rand(), y + 1e-3 * rand(), z + 1e-3 * rand()
    }
    for (i = 0; i < n; ++i) printf "3 %d %d %d\n", 3 * i, 3 * i + 1, 3 * i + 2
  }' >"$1"
}

echo "Median of $steps steps, ttl 2; $(machine)"
if wanted table || wanted large; then
  echo
  table_head
fi
if wanted table; then
  for sample in "${samples[@]}"; do
    for resolution in "${resolutions[@]}"; do row "$sample" "$resolution" "$steps"; done
  done
fi
if wanted large; then
  row train 6000 1
  row delta-wing 8192 1
  row train 8192 1
fi
if wanted source; then
  printf '\n| N | bricks: build, s | source: build, s | ratio | bricks: step, s | source: step, s | ratio |\n'
  printf '|---:|---:|---:|---:|---:|---:|---:|\n'
  for resolution in 512 1024 2048; do both "$resolution"; done
fi
if wanted embree; then
  bunny=$data/meshes/defects/bunny00.off
  if [[ ! -x $(dirname "$nacre")/bench_octree_build || ! -e $bunny ]]; then
    echo "octree.sh: embree left out: no bench_octree_build beside the program, or no $bunny" >&2
  else
    printf "\n| mesh | N | radius | triangles per cell | octree, ns a cell | Embree, ns a cell | Embree's time / ours | with its tree |\n"
    printf '|---|---:|---:|---:|---:|---:|---:|---:|\n'
    builder "$bunny" resolution=1024,2048 radius=2.24
    builder "$bunny" resolution=512 radius=4.47
    builder "$bunny:2" resolution=512,1024,2048 radius=2.24
    builder train resolution=512,1024,4096 radius=2.24
  fi
fi
if wanted stray; then
  strays "$out/strays.off"
  before=$SECONDS
  if flow stray "$out/strays.off" --vectors @swirl --resolution 4096 --steps 1; then
    printf '\nA million stray triangles at 4096: %s cells, %d s, %.1f GB\n' \
      "$(report_value "$out/octree-stray.json" embedding.cells)" $((SECONDS - before)) \
      "$(report_value "$out/octree-stray.json" memory.peak_bytes | awk '{ print $1 / 1e9 }')"
  fi
fi
exit $failed
