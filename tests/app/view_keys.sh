#!/usr/bin/env bash
# Nacre: a user at the window under Xvfb: keys and mouse. Usage: view_keys.sh PROGRAM RECORDING REPORT PICTURE; 77: tools are
# missing. Waits for what it sees, not for times.
set -euo pipefail
program=$1 recording=$2 report=$3 picture=$4
for tool in xvfb-run xdotool; do
  command -v $tool >/dev/null || {
    echo "no $tool here" >&2
    exit 77
  }
done
here=$(dirname "${BASH_SOURCE[0]}")
export XDG_STATE_HOME here program recording report picture
XDG_STATE_HOME=$(mktemp -d)
trap 'rm -rf "$XDG_STATE_HOME"' EXIT

xvfb-run -a -n $((100 + $$ % 20000)) -s "-screen 0 640x480x24" bash -euo pipefail -c '
  source "$here/window.sh"
  open_window --sample sphere --detail 24 --resolution 64 --size 640x480 --quiet --save-recording "$recording" \
    --report "$report" --image "$picture"
  xdotool mousemove 540 240
  press() { xdotool "$@"; sleep 0.4; }
  press type e             # edges
  press type t             # light
  press key ctrl+z         # dark again
  press key ctrl+y         # light again
  press type o             # orthographic
  press mousedown 1
  press mousemove_relative 40 10
  press mouseup 1          # turned
  press click 4            # nearer
  press key ctrl+o         # the dialog: keys are its own now
  press key Escape
  press type p             # no panels
  press key ctrl+q
  for try in {1..100}; do
    kill -0 $viewer 2>/dev/null || break
    sleep 0.1
  done
  wait $viewer
'
