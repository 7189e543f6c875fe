#!/usr/bin/env bash
# Nacre: where the time of the four main runs goes; what bounds it: bounds.sh. Usage: profile.sh NACRE [CEILINGS]
# CEILINGS is the program bench_ceilings (cmake --build ... --target bench_ceilings). Prints, for flow on the grid and on
# the octree and for meshing one and several materials: the stages' shares; nanoseconds of one processor for a cell (a
# particle) in data that fits the caches and in data that does not, which are alike where memory is not the bound; and,
# where perf is installed, the functions that most time is spent in. NACRE_BENCH_SCALE divides the large runs' resolutions.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
begin_bench profile "$@"
main_runs
threads=$(nproc)
echo "$(machine), $(date -u +%F)"
((${#options[@]} == 0)) || "${options[0]}"

# run REPORT OPTIONS...: what it makes lies in $out.
run() {
  local output=(--out "$out/mesh.vtp")
  [[ $2 != flow ]] || output=(--image "$out/picture.png" --size 640x480)
  "${sampler[@]}" "$nacre" "${@:2}" "${output[@]}" --quiet --threads "$threads" --report "$1" >"$out/log"
}

# shares REPORT: stages above one in a hundred.
shares() {
  awk '/^ *"name": / { name = $2; gsub(/[",]/, "", name) }
       /^ *"seconds": [0-9]/ && name != "" { sub(/,/, ""); seconds[name] += $2; sum += $2; name = "" }
       END { for (n in seconds) if (seconds[n] > 0.01 * sum) printf "%5.1f%%  %s\n", 100 * seconds[n] / sum, n }' "$1" | sort -rn
}

# element_time REPORT: nanoseconds of one processor for a cell of a step, or a particle of an iteration; how many there are.
element_time() {
  local elements iterations=1 seconds
  elements=$(report_value "$1" embedding.surface_cells)
  seconds=$(report_value "$1" flow.seconds_per_step.median)
  if [[ -z $elements ]]; then
    elements=$(report_value "$1" particles.final)
    iterations=$(awk -v all="$(report_value "$1" particles.iterations)" \
      -v coarse="$(report_value "$1" particles.coarse_iterations)" 'BEGIN { print all - 0.75 * coarse }')
    seconds=$(stage_seconds "$1" relax)
  fi
  awk -v s="$seconds" -v n="$elements" -v i="$iterations" -v t="$threads" \
    'BEGIN { printf "%.0f ns (%d)\n", 1e9 * s * t / n / i, n }'
}

# profile NAME SMALL LARGE: two runs, by their options.
profile() {
  local sampler=() small large
  read -ra small <<<"$2"
  read -ra large <<<"$3"
  run "$out/small.json" "${small[@]}"
  ! command -v perf >/dev/null || sampler=(perf record -q -e cpu-clock -F 499 -o "$out/perf.data")
  run "$out/large.json" "${large[@]}"
  printf '\n== %s: nacre %s\n' "$1" "$3"
  shares "$out/large.json"
  echo "one processor for one cell or particle: $(element_time "$out/small.json") small, $(element_time "$out/large.json") large"
  ((${#sampler[@]} == 0)) || perf report -i "$out/perf.data" --percent-limit 2 2>/dev/null |
    awk '!/^#/ && NF && n++ < 12' | cut -c1-110
}

profile grid "flow --sample train --resolution 160 --steps 60" "flow --sample train --resolution $cells --steps 6"
profile octree "flow --method octree --sample train --resolution 160 --steps 40" \
  "flow --method octree --sample train --resolution $cells --steps 4"
profile single "mesh --sample heart --detail 40" "mesh --sample heart --detail $heart"
profile multi "mesh --sample torso --detail 24" "mesh --sample torso --detail $torso"
