#!/usr/bin/env bash
# Nacre: a newcomer at the window under Xvfb: opens a flow, changes ttl, films it; opens labels, gets a mesh, exports it.
# Usage: view_newcomer.sh PROGRAM FLOW LABELS FOLDER; writes FOLDER/film.mp4, mesh.ply, done.json; 77: tools are missing.
# Each `does` is one action of the user; their number is printed.
set -euo pipefail
export program=$1 flow=$2 labels=$3 folder=$4
for tool in xvfb-run xdotool ffmpeg; do
  command -v $tool >/dev/null || {
    echo "no $tool here" >&2
    exit 77
  }
done
export XDG_STATE_HOME=$folder/state here
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

xvfb-run -a -n $((100 + $$ % 20000)) -s "-screen 0 800x600x24" bash -euo pipefail -c '
  cd "$folder"
  source "$here/window.sh"
  open_window --size 800x600 --set steps=8 --resolution 64 --set max_size=2 --quiet --save-recording done.json
  xdotool mousemove 600 300
  actions=0
  does() { actions=$((actions + 1)); xdotool "$@"; sleep 0.5; }
  waits_for() {  # a file that is whole
    for try in {1..300}; do
      [[ -s $1 ]] && return
      sleep 0.2
    done
    echo "$1 did not come" >&2
    return 1
  }
  does key ctrl+o
  does type "$flow"
  does key Return
  sleep 4
  does mousemove 71 75 click 1                # the tab of the knobs
  does mousemove 90 101 click 1               # find a knob
  does type ttl
  does mousemove 100 146 keydown ctrl click 1 keyup ctrl  # its slider, to type in
  xdotool key ctrl+a
  does type 6
  does key Return
  xdotool mousemove 600 300
  does key ctrl+m
  does key Return                             # video.mp4
  sleep 3
  does key ctrl+m                             # the end of it
  waits_for video.mp4
  does key ctrl+o
  does type "$labels"
  does key Return
  sleep 15
  does key ctrl+e
  xdotool key ctrl+a
  does type mesh.ply
  does key Return
  waits_for mesh.ply
  does key ctrl+q
  wait $viewer
  echo "$actions actions"
'
