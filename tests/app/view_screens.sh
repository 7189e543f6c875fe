#!/usr/bin/env bash
# Nacre: a window under Xvfb that acts as on a screen of twice the density, is clicked on, pulled to all sizes, hidden and
# shown again. Usage: view_screens.sh PROGRAM RECORDING REPORT; 77: tools are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 1000x800 xdotool
program=$1 recording=$2 report=$3

NACRE_FAULTS=other-screen@1 open_window "$program" --sample sphere --detail 24 --resolution 64 --size 800x600 --quiet \
  --save-recording "$recording" --report "$report"
window=$(xdotool search --name 'Nacre$' | head -1)
chosen() { grep -q "\"tab\": \"$1\"" "$recording"; }

xdotool mousemove 71 75 click 1 # the tab of the knobs, in the desktop's units
until_true "the knobs" chosen knobs
for size in 300x200 1x1 40x700 990x30 2x2 900x700 640x480; do
  xdotool windowsize "$window" "${size%x*}" "${size#*x}" windowmove "$window" $((RANDOM % 300)) $((RANDOM % 300))
  sleep 0.1
done
xdotool windowunmap "$window"
sleep 0.5
xdotool windowmap "$window" windowmove "$window" 0 0
sleep 0.5
xdotool windowfocus "$window"
quit_window
