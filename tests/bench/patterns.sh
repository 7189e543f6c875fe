#!/usr/bin/env bash
# Nacre: the table of spots and stripes in docs/performance/flow.md: drivaer and the built-in train, beside streaks.
# Usage: patterns.sh BINARY [nacre flow's options, e.g. --device cuda --threads 2]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_RESOLUTIONS, NACRE_BENCH_STEPS (default 5), NACRE_DATA (folder that holds drivaer.pvd).
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/begin.sh"
begin_bench patterns "$@"
read -ra resolutions <<<"${NACRE_BENCH_RESOLUTIONS:-512 1024}"
steps=${NACRE_BENCH_STEPS:-5}

# row NAME RESOLUTION TEXTURE INPUT...: one run and its line of the table; a run that fails is a line that says so.
row() {
  local name=$1 resolution=$2 texture=$3 made="$out/patterns-$1-$2-$3"
  shift 3
  if ! "$nacre" flow "$@" "${options[@]}" --quiet --texture "$texture" --resolution "$resolution" --steps "$steps" \
    --size 1024x768 --image "$made.png" --report "$made.json" >/dev/null 2>"$made.err"; then
    printf '| %s | %d | %s | failed: %s |\n' "$name" "$resolution" "$texture" "$(head -n 1 "$made.err")"
    failed=1
    return
  fi
  local react=0
  [[ $texture == streaks ]] || react=$(stage_seconds "$made.json" react)
  awk -v name="$name" -v resolution="$resolution" -v texture="$texture" -v steps="$steps" -v react="$react" \
    -v cells="$(report_value "$made.json" embedding.surface_cells)" \
    -v points="$(report_value "$made.json" embedding.closest_point_cells)" \
    -v step="$(report_value "$made.json" flow.seconds_per_step.median)" \
    -v memory="$(report_value "$made.json" memory.peak_bytes)" 'BEGIN {
      first = (react > steps * step) ? react - steps * step : 0
      printf "| %s | %d | %s | %d | %d | %.2f | ", name, resolution, texture, cells, points, first
      printf "%.3f | %.2f |\n", step, memory / 1e9
    }'
}

echo "Median of $steps steps; the first frame: seconds that a pattern takes to form; $(machine)"
echo
printf '| data | resolution | texture | surface cells | closest-point cells | first frame, s | step, s |'
printf ' peak memory, GB |\n|---|---:|---|---:|---:|---:|---:|---:|\n'
drivaer=$({ find "$data" -name drivaer.pvd 2>/dev/null || true; } | sort | head -n 1)  # the folder need not be there
for resolution in "${resolutions[@]}"; do
  for texture in streaks spots stripes; do
    [[ -z $drivaer ]] || row drivaer "$resolution" "$texture" "$drivaer"
    row train "$resolution" "$texture" --sample train
  done
done
[[ -n $drivaer ]] || echo "patterns.sh: drivaer left out: no drivaer.pvd under $data" >&2
exit $failed
