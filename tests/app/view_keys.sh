#!/usr/bin/env bash
# Nacre: a user at the window under Xvfb: keys and mouse. Usage: view_keys.sh PROGRAM RECORDING REPORT PICTURE; 77: tools
# are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 640x480 xdotool
program=$1 recording=$2 report=$3 picture=$4

open_window "$program" --sample sphere --detail 24 --resolution 64 --size 640x480 --quiet \
  --save-recording "$recording" --report "$report" --image "$picture"
xdotool mousemove 480 240
press() {
  xdotool "$@"
  sleep 0.4
}
press type e     # edges
press type t     # light
press key ctrl+z # dark again
press key ctrl+y # light again
press type o     # orthographic
press mousedown 1
press mousemove_relative 40 10
press mouseup 1  # turned
press click 4    # nearer
press key ctrl+o # the dialog: keys are its own now
press key Escape
press type p # no panels
quit_window
