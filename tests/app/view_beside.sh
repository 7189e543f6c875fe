#!/usr/bin/env bash
# Nacre: a user opens a damaged file, and then a whole one, in a window under Xvfb: what was shown stays until there is
# something else to see. Usage: view_beside.sh PROGRAM DAMAGED WHOLE RECORDING; complaints are on stderr. 77: tools are
# missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 640x480 xdotool
program=$1 damaged=$2 whole=$3 recording=$4

open_window "$program" --sample sphere --detail 24 --resolution 64 --size 640x480 --save-recording "$recording" \
  2> >(tee "$state/said" >&2)
until_true "the sphere" titled 'sphere.* - Nacre$'
opens() { # FILE CONDITION...
  xdotool key Escape key ctrl+o
  sleep 0.5
  xdotool key ctrl+a type "$1"
  sleep 0.5
  xdotool key Return
  local k
  for ((k = 0; k < 40; ++k)); do # to read it takes its time
    "${@:2}" && return
    sleep 0.5
  done
  return 1
}
said() { grep -q "$1" "$state/said"; }
until_true "the complaint" opens "$damaged" said 'was not opened'
titled 'sphere.* - Nacre$' || {
  echo "what was shown is gone" >&2
  exit 1
}
xdotool key Escape mousemove 540 200 key e # and goes on
edges() { grep -q '"edges": true' "$recording"; }
until_true "the edges" edges
until_true "the whole file" opens "$whole" titled "$(basename "$whole" .vtp).* - Nacre\$"
whole_shown() { titled "$(basename "$whole" .vtp).* - Nacre\$"; }
xdotool mousemove 540 200 key ctrl+z
until_true "what was there before" titled 'sphere.* - Nacre$'
rm "$whole" # its result is still at hand
xdotool key ctrl+y
until_true "the result of a file that is gone" whole_shown
quit_window
