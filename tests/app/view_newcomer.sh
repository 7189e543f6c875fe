#!/usr/bin/env bash
# Nacre: a newcomer at the window under Xvfb: opens a flow, changes ttl, films it; opens labels, gets a mesh, exports it.
# Usage: view_newcomer.sh PROGRAM FLOW LABELS FOLDER; writes FOLDER/flow.mp4, labels-mesh.vtp, done.json; 77: tools are missing.
# Each `does` is one action of the user; their number is printed.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 800x600 xdotool ffmpeg
program=$1 flow=$2 labels=$3
cd "$4"

pace=0.4 # seconds that a user takes from one action to the next
actions=0
does() {
  actions=$((actions + 1))
  xdotool "$@"
  sleep $pace
}

# gets WHAT CONDITION ACTION...: acts until the condition holds, more slowly at each attempt, as a user does where much
# else runs and a frame takes longer than a click. Only the first attempt is counted. ffmpeg takes its time to end a video.
gets() {
  local what=$1 condition=$2 before=$actions counted='' pace try patience=20
  [[ $condition != filmed ]] || patience=120
  shift 2
  for pace in 0.4 1 3 6; do
    actions=$before
    "$@"
    counted=${counted:-$actions}
    actions=$counted
    for ((try = 0; try < patience; ++try)); do
      $condition && return
      sleep 0.5
    done
    xdotool key Escape
  done
  echo "$what did not come" >&2
  return 1
}

open_file() {
  does key ctrl+o
  does type "$1"
  does key Return
}
set_ttl() {
  does mousemove 71 75 click 1  # the tab of the knobs
  does mousemove 90 101 click 1 # find a knob
  xdotool key ctrl+a
  does type ttl
  xdotool mousemove 100 146 keydown ctrl # its slider, to type in
  sleep $pace
  does click 1
  xdotool keyup ctrl key ctrl+a
  does type 6
  does key Return
  xdotool mousemove 600 300
}
begin_film() {
  does key ctrl+m
  does key Return # flow.mp4
}
end_film() { does key ctrl+m; }
export_mesh() {
  does key ctrl+e
  does key Return # labels-mesh.vtp
}

flow_shown() { titled "^${flow##*/}: "; }
ttl_set() { grep -q '"ttl": 6' done.json; }
filming() { titled '^film - '; }
filmed() { [[ -s flow.mp4 ]] && ! filming; }
labels_shown() { titled "${labels##*/} - Nacre$"; }
meshed() { titled "^${labels##*/} - Nacre$"; }
exported() { [[ -s labels-mesh.vtp ]]; }

open_window "$program" --size 800x600 --set steps=8 --resolution 64 --set max_size=2 --quiet --save-recording done.json
xdotool mousemove 600 300
gets "the flow" flow_shown open_file "$flow"
before=$actions
gets "ttl" ttl_set set_ttl
for_ttl=$((actions - before))
gets "the film" filming begin_film
sleep 2
gets "the video" filmed end_film
gets "the labels" labels_shown open_file "$labels"
until_true "the mesh" meshed
gets "the file" exported export_mesh
actions=$((actions + 1))
quit_window
echo "$((actions - for_ttl)) actions, and $for_ttl for a knob"
