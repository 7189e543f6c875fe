#!/usr/bin/env bash
# Nacre: a sphere that grows by 5 texture cells a frame and has other triangles each time: what embedding and carrying cost.
# Usage: moving.sh BINARY [options of nacre flow, e.g. --method octree]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_RESOLUTION (default 1024), NACRE_BENCH_STEPS (default 5).
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/begin.sh"
begin_bench moving "$@"
resolution=${NACRE_BENCH_RESOLUTION:-1024}
steps=${NACRE_BENCH_STEPS:-5}

# sphere FILE RADIUS RINGS: an OBJ file of a sphere of RINGS by 2 RINGS quadrilaterals, each cut in two.
sphere() {
  awk -v radius="$2" -v rings="$3" 'BEGIN {
    pi = atan2(0, -1); turns = 2 * rings
    print "v 0 0", radius
    for (i = 1; i < rings; ++i) for (j = 0; j < turns; ++j) {
      a = pi * i / rings; b = pi * j / rings
      printf "v %.9f %.9f %.9f\n", radius * sin(a) * cos(b), radius * sin(a) * sin(b), radius * cos(a)
    }
    print "v 0 0", -radius
    last = 2 + (rings - 1) * turns
    for (j = 0; j < turns; ++j) {
      k = (j + 1) % turns
      print "f", 1, 2 + j, 2 + k
      for (i = 0; i < rings - 2; ++i) {
        p = 2 + i * turns
        print "f", p + j, p + turns + j, p + turns + k
        print "f", p + j, p + turns + k, p + k
      }
      print "f", last, last - turns + k, last - turns + j
    }
  }' >"$1"
}

spheres=()
for ((k = 0; k <= steps; ++k)); do
  radius=$(awk -v k="$k" -v n="$resolution" 'BEGIN { print 1 + 10.0 * k / n }')  # a cell is 2 / n wide
  sphere "$out/sphere_$k.obj" "$radius" $((120 + k))
  spheres+=("$out/sphere_$k.obj")
done
"$nacre" flow "${spheres[@]}" --vectors @swirl --quiet --resolution "$resolution" --steps "$steps" --warmup 0 \
  --image "$out/moving.png" --report "$out/moving.json" "${options[@]}"
awk -v cells="$(report_value "$out/moving.json" embedding.surface_cells)" \
  -v frame="$(report_value "$out/moving.json" flow.seconds_per_step.median)" -v frames="$steps" \
  -v rebuild="$(stage_seconds "$out/moving.json" rebuild)" -v carry="$(stage_seconds "$out/moving.json" carry)" 'BEGIN {
    rebuild /= frames; carry /= frames; step = frame - rebuild - carry
    printf "%d surface cells; a frame of %.2f s: rebuild %.2f s, carry %.2f s, the step itself %.2f s; ", cells, frame,
      rebuild, carry, step
    printf "rebuild %.2f + carry %.2f = %.2f steps\n", rebuild / step, carry / step, (rebuild + carry) / step
  }'
