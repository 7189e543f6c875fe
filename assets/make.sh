#!/usr/bin/env bash
# Nacre: makes the pictures and the clip of the README anew, by the program itself. Usage: assets/make.sh [PROGRAM]; a minute.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
nacre=${1:-../build/release/bin/nacre}
"$nacre" flow --sample train --steps 60 --image train.png
"$nacre" mesh --sample torso --cut-away --image torso.png
"$nacre" view --offscreen --sample torso --panel --set tab=result --set clip=y --set clip_at=0.48 --size 1200x760 \
  --image viewer.png
"$nacre" view --offscreen --script mesh_demo.json --size 360x202 --record tour.mp4
ffmpeg -v error -y -i tour.mp4 -vf "fps=8,split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=none" tour.gif
rm tour.mp4
