#!/usr/bin/env bash
# Nacre: the octree table of docs/performance.md: train, aircraft and delta-wing from 512 to 4096 (8192) cells per axis.
# Usage: octree.sh BINARY [nacre flow's words, e.g. --octree source --threads 2]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_RESOLUTIONS, NACRE_BENCH_STEPS (default 3), NACRE_BENCH_SAMPLES.
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/begin.sh"
begin_bench octree "$@"
read -ra resolutions <<<"${NACRE_BENCH_RESOLUTIONS:-512 1024 2048 4096}"
read -ra samples <<<"${NACRE_BENCH_SAMPLES:-train aircraft delta-wing}"
steps=${NACRE_BENCH_STEPS:-3}

# row SAMPLE RESOLUTION: one run and its line of the table; a run that fails is a line that says so.
row() {
  local report="$out/octree-$1-$2.json"
  if ! "$nacre" flow --sample "$1" --method octree "${words[@]}" --quiet --resolution "$2" --ttl 2 --warmup 0 \
    --steps "$steps" --size 1024x768 --image "$out/octree-$1-$2.png" --report "$report" >/dev/null \
    2>"$out/octree-$1-$2.err"; then
    printf '| %s | %d | failed: %s |\n' "$1" "$2" "$(head -n 1 "$out/octree-$1-$2.err")"
    failed=1
    return
  fi
  awk -v name="$1" -v resolution="$2" -v cells="$(report_value "$report" embedding.cells)" \
    -v surface="$(report_value "$report" embedding.surface_cells)" -v build="$(stage_seconds "$report" embed)" \
    -v step="$(report_value "$report" flow.seconds_per_step.median)" -v bytes="$(report_value "$report" embedding.bytes)" \
    -v render="$(stage_seconds "$report" render)" -v memory="$(report_value "$report" memory.peak_bytes)" 'BEGIN {
      printf "| %s | %d | %d | %d | %.5f | ", name, resolution, cells, surface, 100 * (1 - cells / resolution ^ 3)
      printf "%.2f | %.0f | %.2f | %.0f | ", build, 1e9 * build / cells, step, 1e9 * step / cells
      printf "%.1f | %.2f | %.2f |\n", bytes / cells, render, memory / 1e9
    }'
}

echo "Median of $steps steps, ttl 2; $(machine)"
echo
printf '| data | N | cells | surface cells | sparseness, %% | build, s | build, ns per cell | step, s | step, ns per cell |'
printf ' embedding, bytes per cell | picture 1024x768, s | peak memory, GB |\n'
printf '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n'
for sample in "${samples[@]}"; do
  for resolution in "${resolutions[@]}"; do
    row "$sample" "$resolution"
  done
done
exit $failed
