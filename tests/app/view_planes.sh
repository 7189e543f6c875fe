#!/usr/bin/env bash
# Nacre: a user at the window under Xvfb: a clip plane is added, pushed and turned by its handle; the crosshair is moved
# in a slice. Usage: view_planes.sh PROGRAM RECORDING REPORT CAMERA; 77: tools are missing. There is no RECORDING
# yet. CAMERA looks at the middle of the scene: a new plane's handle is then in the middle of what panels leave.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 1000x700 xdotool
program=$1 recording=$2 report=$3 camera=$4

open_window "$program" --sample two-spheres --detail 20 --set iterations=20 --set remesh=0 --camera "$camera" \
  --size 1000x700 --quiet --save-recording "$recording" --report "$report"
x=689 y=327 # the middle

# written KNOB: how often the recording has it.
written() { echo $(($(grep -c "\"$1\":" "$recording" 2>/dev/null) + 0)); }
# after KNOB WORDS...: does them, and waits until the knob has been changed.
more() { (($(written "$1") > $2)); }
after() {
  local knob=$1 before
  before=$(written "$knob")
  shift
  "$@"
  until_true "a change of $knob" more "$knob" "$before"
}
# drag X Y BY_X BY_Y: in steps, as a hand does. Moving there first lets the window know what lies under the mouse.
drag() {
  local step
  xdotool mousemove "$1" "$2" sleep 0.3 mousedown 1 sleep 0.1
  for step in 1 2 3 4; do xdotool mousemove $(($1 + $3 * step / 4)) $(($2 + $4 * step / 4)) sleep 0.1; done
  xdotool mouseup 1
}
away() { xdotool mousemove 900 60 sleep 0.3; }

away
after clip_planes xdotool type c
sleep 0.5                             # the section opens
after clip_planes drag $x $y 0 -60    # it is seen from the front: away
away
after clip_planes xdotool key ctrl+z  # one step takes back all of the drag
after clip_planes drag $x $((y + 11)) 60 0  # the ring around the handle
away
after layout xdotool type l
after crosshair xdotool mousemove $((x - 200)) $((y - 200)) sleep 0.3 click 1 # across z
after crosshair xdotool mousemove $((x + 100)) $((y + 100)) sleep 0.3 click 4 # across x
quit_window
