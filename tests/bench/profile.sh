#!/usr/bin/env bash
# Nacre: where the time of the four main runs goes, and what bounds it. Usage: profile.sh NACRE [CEILINGS]
# CEILINGS is the program bench_ceilings (cmake --build ... --target bench_ceilings). Prints, for flow on the grid and on
# the octree and for meshing one and several materials: the stages' shares; nanoseconds of one processor for a cell (a
# particle) in data that fits the caches and in data that does not, which are alike where memory is not the bound; and,
# where perf is installed, the functions that most time is spent in.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
begin_bench profile "${@:1:1}"
threads=$(nproc)
echo "$(machine), $(date -u +%F)"
[[ -z ${2:-} ]] || "$2"

declare -A large small
large[grid]="flow --sample train --resolution 1024 --steps 6"
small[grid]="flow --sample train --resolution 160 --steps 60"
large[octree]="flow --method octree --sample train --resolution 1024 --steps 4"
small[octree]="flow --method octree --sample train --resolution 160 --steps 40"
large[single]="mesh --sample heart"
small[single]="mesh --sample heart --detail 40"
large[multi]="mesh --sample torso --detail 96"
small[multi]="mesh --sample torso --detail 24"

# run NAME SIZE WORDS...: a report in $out.
run() {
  local output=(--out "$out/mesh.vtp")
  [[ $3 != flow ]] || output=(--image "$out/picture.png" --size 640x480)
  "$nacre" "${@:3}" "${output[@]}" --quiet --threads "$threads" --report "$out/$1.$2.json" >"$out/log"
}

# shares REPORT: stages above one in a hundred.
shares() {
  awk '/^ *"name": / { name = $2; gsub(/[",]/, "", name) }
       /^ *"seconds": [0-9]/ && name != "" { sub(/,/, ""); seconds[name] += $2; sum += $2; name = "" }
       END { for (n in seconds) if (seconds[n] > 0.01 * sum) printf "%5.1f%%  %s\n", 100 * seconds[n] / sum, n }' "$1" | sort -rn
}

# element_time REPORT: nanoseconds of one processor for a cell of a step, or a particle of an iteration.
element_time() {
  local cells iterations seconds
  cells=$(report_value "$1" embedding.surface_cells)
  if [[ -n $cells ]]; then
    seconds=$(report_value "$1" flow.seconds_per_step.median)
    iterations=1
  else
    cells=$(report_value "$1" particles.final)
    iterations=$(report_value "$1" particles.iterations)
    seconds=$(stage_seconds "$1" relax)
  fi
  awk -v s="$seconds" -v n="$cells" -v i="$iterations" -v t="$threads" 'BEGIN { printf "%.0f ns (%d)\n", 1e9 * s * t / n / i, n }'
}

for name in grid octree single multi; do
  read -ra words_large <<<"${large[$name]}"
  read -ra words_small <<<"${small[$name]}"
  run $name small "${words_small[@]}"
  if command -v perf >/dev/null; then
    perf record -q -e cpu-clock -F 499 -o "$out/$name.perf" true 2>/dev/null && sampled=1 || sampled=
  fi
  run $name large "${words_large[@]}"
  echo
  echo "== $name: nacre ${large[$name]}"
  shares "$out/$name.large.json"
  echo "one processor for one cell or particle: $(element_time "$out/$name.small.json") small, $(element_time "$out/$name.large.json") large"
  if [[ -n ${sampled:-} ]]; then
    perf record -q -e cpu-clock -F 499 -o "$out/$name.perf" "$nacre" "${words_large[@]}" --quiet --threads "$threads" \
      --report "$out/log" --out "$out/$name.vtp" >/dev/null 2>&1 || true
    perf report -i "$out/$name.perf" --percent-limit 2 2>/dev/null | grep -v '^#' | grep . | cut -c1-110 | head -n 12
  fi
done
