#!/usr/bin/env bash
# Nacre: makes the pictures and the moving pictures of the README. Usage: assets/make.sh [PROGRAM]. Takes some minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
nacre=$(readlink -f "${1:-../build/release/bin/nacre}")
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT

# gif INPUT-OPTIONS... FILTER COLOURS FILE: one palette for all frames.
gif() {
  local input=("${@:1:$#-3}") filter=${*: -3:1} colours=${*: -2:1} file=${*: -1}
  ffmpeg -v error -y "${input[@]}" \
    -vf "${filter}split[a][b];[a]palettegen=max_colors=$colours[p];[b][p]paletteuse=dither=none" "$file"
}

"$nacre" flow --sample train --resolution 640 --steps 60 --time 0:0.3 --ttl 6 --step-cells 5 --camera flow_camera.json \
  --size 440x300 --no-legend --no-time --frames "$frames/flow"
gif -framerate 20 -i "$frames/flow/frame_%04d.png" "" 64 flow.gif

"$nacre" flow --sample train --steps 60 --image train.png
"$nacre" mesh --sample torso --cut-away --image torso.png
"$nacre" view --offscreen --sample torso --panel --set tab=result --set clip=y --set clip_at=0.48 --size 1200x760 \
  --image viewer.png
"$nacre" view --offscreen --script mesh_demo.json --size 360x202 --record "$frames/tour.mp4"
gif -i "$frames/tour.mp4" "fps=8," 96 tour.gif
