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
pictures=../docs/pictures
"$nacre" flow --sample train --detail 160 --resolution 384 --steps 4 --size 640x400 --colormap viridis \
  --color-scale log --color-range 1%:99% --color-below '#d0d0d0' --color-above '#ff7f0e' --image "$pictures/colours.png"
torus=(view --offscreen --sample torus --detail 48 --resolution 128 --panel)
"$nacre" "${torus[@]}" --frames-count 2 --set tab=knobs --size 800x420 --image "$pictures/knobs.png"
"$nacre" "${torus[@]}" --frames-count 3 --set panel_side=right --set tab=knobs --set isolines=12 --size 900x650 \
  --set "ruler=1.2 0 0.3;0 1.2 0.3;-1 0 0.3" --set "notes=0.8 -0.8 0.3 stagnation" --image "$pictures/marks.png"
"$nacre" view --offscreen --sample torus --detail 96 --resolution 320 --panel --frames-count 14 --set tab=result \
  --size 1000x600 --set tracks=true --set topology=true --set probe=1.2,0.6,0.3 \
  --set "dye=1.2,0.6,0.3,0.35|0.8,-0.8,0.3,0.3" --image "$pictures/dye.png"
"$nacre" view --offscreen --sample three-sectors --detail 28 --set iterations=20 --panel --set tab=result \
  --set opacity=1:0.4 --set "material_colors=2:#c0392b" --size 1024x600 --image "$pictures/materials.png"
cat >"$frames/paused.json" <<'JSON'
{"sample": "torus", "detail": 48, "knobs": {"resolution": 160, "width": 960, "height": 480},
 "events": [{"time": 0.4, "knobs": {"play": false, "begin_at": 0.2}},
            {"time": 0.44, "screenshot": {"file": "transport.png", "panel": true}}],
 "duration": 0.5}
JSON
"$nacre" view --offscreen --script "$frames/paused.json" --record "$frames/paused"
mv "$frames/transport.png" "$pictures"
# A close-up at 1, 8 and 64 times: above by the texture of the whole, below as it is by default.
views=()
for focus in no-focus focus; do
  for height in 3.2 0.4 0.05; do
    printf '{"eye": [-12, -6, 4], "target": [-4.7, -0.2, 0.9], "up": [0, 0, 1], "height": %s}' "$height" \
      >"$frames/near.json"
    "$nacre" flow --sample train --detail 160 --steps 3 --camera "$frames/near.json" --size 280x210 --color none \
      --no-legend --no-time --$focus --image "$frames/$focus-$height.png"
    views+=(-i "$frames/$focus-$height.png")
  done
done
ffmpeg -v error -y "${views[@]}" -filter_complex \
  "[0][1][2]hstack=3[above];[3][4][5]hstack=3[below];[above][below]vstack,format=gray" "$pictures/close-ups.png"
# docs/pictures/welcome.png is a screenshot of the window that `nacre view` opens at 960x640, and keyframes.png of one at
# 900x720 without panels, in which somebody has made a list.
"$nacre" view --offscreen --script mesh_demo.json --size 360x202 --record "$frames/tour.mp4"
gif -i "$frames/tour.mp4" "fps=8," 96 tour.gif
