#!/usr/bin/env bash
# Nacre: a user opens a session that cannot be taken, in a window under Xvfb. Usage: view_refused.sh PROGRAM SESSION
# RECORDING; what the window complains of is on stderr, too. 77: tools are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 640x480 xdotool
program=$1 session=$2 recording=$3

open_window "$program" --sample sphere --detail 24 --resolution 64 --size 640x480 --save-recording "$recording" \
  2> >(tee "$state/said" >&2)
said() { grep -q "$1" "$state/said"; }
refused() {
  xdotool key Escape key ctrl+o
  sleep 0.5
  xdotool key ctrl+a type "$session"
  sleep 0.5
  xdotool key Return
  sleep 1
  said 'larger than'
}
until_true "the complaint" refused
quit_window
