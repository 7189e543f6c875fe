#!/usr/bin/env bash
# Nacre: memory and open files over many steps. Usage: soak.sh KIND PROGRAM COUNT [CSV]
#   flow     `nacre flow` for COUNT steps on a small sample
#   view     the viewer offscreen for COUNT frames: 50 files one after the other, knobs, close-ups, meshes, pictures
#   python   COUNT flows and meshes in one process; PROGRAM is a python that has the module
# It looks every half second how much memory the process has and how many files it has open. Once a tenth is done, the
# second half may need 5 % and 8 MiB more memory than the first at most, and no more open files. CSV gets
# seconds,KiB,files for a plot.
set -euo pipefail

kind=$1 program=$(command -v "$2") count=$3 csv=${4:-/dev/null}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# fifty_files: small surfaces with vectors, and every fifth a volume of labels.
fifty_files() {
  local k
  for ((k = 0; k < 50; ++k)); do
    if ((k % 5 == 4)); then
      "$program" sample two-spheres --detail $((16 + k % 7)) --out "$work/$k.nrrd"
    else
      "$program" sample "$( ((k % 2)) && echo torus || echo sphere)" --detail $((10 + k % 9)) --out "$work/$k.pvd"
    fi
  done >/dev/null
}

# view_script FRAMES: every 40 frames another file; within them knobs change, the camera goes near and back, and every
# tenth file has a picture.
view_script() {
  awk -v frames="$1" 'BEGIN {
    fps = 25; each = 40 / fps
    printf "{\"nacre\": \"session 1\", \"inputs\": [\"0.pvd\"], \"knobs\": {\"resolution\": 48, \"width\": 160, "
    printf "\"height\": 120, \"fps\": %d, \"max_size\": 3, \"iterations\": 10, \"panel\": false},\n\"events\": [\n", fps
    files = int(frames / 40)
    for (n = 1; n < files; ++n) {
      k = n % 50; t = n * each; volume = k % 5 == 4
      printf "%s{\"time\": %.2f, \"inputs\": [\"%d.%s\"]}", (n > 1 ? ",\n" : ""), t, k, volume ? "nrrd" : "pvd"
      if (volume) printf ",\n{\"time\": %.2f, \"knobs\": {\"max_size\": %.1f}}", t + 0.6, 2 + k % 3
      else printf ",\n{\"time\": %.2f, \"knobs\": {\"ttl\": %d, \"resolution\": %d}}", t + 0.4, 4 + k % 6, 40 + k
      printf ",\n{\"time\": %.2f, \"over\": 0.2, \"camera\": {\"eye\": [3, 2, 1], \"target\": [0, 0, 0], \"height\": %.2f}}",
        t + 0.8, 0.2 + k / 20
      if (n % 10 == 0) printf ",\n{\"time\": %.2f, \"screenshot\": {\"file\": \"shot.png\"}}", t + 1.2
    }
    printf "],\n\"duration\": %.2f}\n", frames / fps
  }'
}

case $kind in
  flow) words=(flow --sample sphere --detail 16 --resolution 48 --steps "$count" --quiet --report "$work/report.json") ;;
  view)
    fifty_files
    view_script "$count" >"$work/soak.json"
    words=(view --offscreen --quiet --script "$work/soak.json" --image "$work/last.png")
    ;;
  python)
    words=(-c "
import numpy as np, nacre
z, y, x = np.mgrid[:16, :16, :16] - 7.6
ball = (x * x + y * y + z * z < 30).astype(np.uint8)
mesh = nacre.mesh(ball)
for _ in range($count):
    mesh = nacre.mesh(ball, max_size=2)
    for frame in nacre.flow(mesh.points, mesh.triangles, mesh.points[:, [1, 2, 0]], resolution=32, steps=2, width=80, height=60):
        frame.image
")
    ;;
  *) echo "soak.sh: no kind '$kind'; choose flow, view or python" >&2; exit 2 ;;
esac

"$program" "${words[@]}" >/dev/null &
child=$!
begun=$SECONDS
while kill -0 "$child" 2>/dev/null; do
  memory=$(awk '/^VmRSS:/ { print $2 }' "/proc/$child/status" 2>/dev/null) || true
  files=$(find "/proc/$child/fd" -mindepth 1 2>/dev/null | wc -l) || true
  [[ -z $memory ]] || echo "$((SECONDS - begun)),$memory,$files" >>"$work/log"
  sleep 0.5
done
wait "$child"
cat "$work/log" >"$csv"

awk -F , -v kind="$kind" -v count="$count" '
  function larger(a, b) { return a > b ? a : b }
  { memory[NR] = $2; files[NR] = $3; seconds = $1 }
  END {
    for (i = int(NR / 10) + 1; i <= NR; ++i) {
      half = (2 * i > NR)
      most[half] = larger(most[half], memory[i])
      held[half] = larger(held[half], files[i])
    }
    printf "%s, %d, %d s, %d samples: at most %d KiB from the first tenth to the middle, %d KiB after it; ", kind, count,
      seconds, NR, most[0], most[1]
    printf "open files %d, then %d\n", held[0], held[1]
    exit NR < 20 || most[1] > most[0] * 1.05 + 8192 || held[1] > held[0]
  }' "$work/log"
