#!/usr/bin/env bash
# Nacre: a user leaves the window under Xvfb: with something to lose, which is asked about, and by Ctrl-C in the terminal.
# Usage: view_quit.sh PROGRAM FOLDER; writes FOLDER/r.json, p.png and done.json; 77: tools are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 640x480 xdotool
program=$1 folder=$2
words=(--sample sphere --detail 24 --resolution 64 --size 640x480 --quiet)

open_window "$program" "${words[@]}"
xdotool mousemove 540 240 key ctrl+r # what is done is recorded, and has no file
sleep 1
xdotool key ctrl+q
sleep 2
kill -0 "$viewer" || {
  echo "it quits without asking" >&2
  exit 1
}
quit_window

open_window "$program" "${words[@]}" --report "$folder/r.json" --image "$folder/p.png" \
  --save-recording "$folder/done.json"
xdotool mousemove 540 240
edges() {
  xdotool key e
  sleep 1
  grep -q '"edges": true' "$folder/done.json"
}
until_true "the edges" edges
kill -INT "$viewer"
status=0
wait "$viewer" || status=$?
echo "$status"
