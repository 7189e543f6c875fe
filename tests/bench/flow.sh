#!/usr/bin/env bash
# Nacre: the speed table of docs/performance/flow.md: drivaer and the built-in train at 256 to 2048 texture cells.
# Usage: flow.sh BINARY [nacre flow's options, e.g. --device cuda --threads 2]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_RESOLUTIONS, NACRE_BENCH_STEPS (default 10), NACRE_DATA (folder that holds drivaer.pvd).
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/begin.sh"
begin_bench flow "$@"
read -ra resolutions <<<"${NACRE_BENCH_RESOLUTIONS:-256 512 1024 2048}"
steps=${NACRE_BENCH_STEPS:-10}

# row NAME RESOLUTION INPUT...: one run and its line of the table; a run that fails is a line that says so.
row() {
  local name=$1 resolution=$2 report="$out/flow-$1-$2.json"
  shift 2
  if ! "$nacre" flow "$@" "${options[@]}" --quiet --resolution "$resolution" --ttl 2 --steps "$steps" --size 1024x768 \
    --image "$out/flow-$name-$resolution.png" --report "$report" >/dev/null 2>"$out/flow-$name-$resolution.err"; then
    printf '| %s | %d | failed: %s |\n' "$name" "$resolution" "$(head -n 1 "$out/flow-$name-$resolution.err")"
    failed=1
    return
  fi
  awk -v name="$name" -v resolution="$resolution" \
    -v cells="$(report_value "$report" embedding.surface_cells)" -v embed="$(stage_seconds "$report" embed)" \
    -v refine="$(stage_seconds "$report" refine)" -v step="$(report_value "$report" flow.seconds_per_step.median)" \
    -v render="$(stage_seconds "$report" render)" -v memory="$(report_value "$report" memory.peak_bytes)" 'BEGIN {
      printf "| %s | %d | %d | %.3f | %.3f | ", name, resolution, cells, embed, refine
      rate = (step > 0) ? cells / step / 1e6 : 0
      printf "%.3f | %.3f | %.2f | %.2f |\n", step, render, memory / 1e9, rate
    }'
}

echo "Median of $steps steps, ttl 2; $(machine)"
echo
printf '| data | resolution | surface cells | embed, s | refine, s | step, s | picture 1024x768, s | peak memory, GB |'
printf ' million surface cells per second |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|\n'
drivaer=$({ find "$data" -name drivaer.pvd 2>/dev/null || true; } | sort | head -n 1)  # the folder need not be there
for resolution in "${resolutions[@]}"; do
  [[ -z $drivaer ]] || row drivaer "$resolution" "$drivaer"
done
for resolution in "${resolutions[@]}"; do
  row train "$resolution" --sample train
done
[[ -n $drivaer ]] || echo "flow.sh: drivaer left out: no drivaer.pvd under $data" >&2
exit $failed
