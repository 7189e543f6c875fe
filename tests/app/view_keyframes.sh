#!/usr/bin/env bash
# Nacre: a user makes a list of keyframes in a window under Xvfb, plays it, saves it and films it. Usage:
# view_keyframes.sh PROGRAM FOLDER; writes FOLDER/list.json, list.mp4 and done.json; 77: tools are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 800x600 xdotool ffmpeg
program=$1
cd "$2"

does() {
  xdotool "$@"
  sleep "$pace"
}
click() { does mousemove "$1" "$2" click 1; }
drag() {
  does mousemove 400 150 mousedown 1
  does mousemove 480 170
  does mouseup 1
}

# The window of the keyframes is at the bottom of the picture, 700 pixels wide.
make_list() {
  does mousemove 400 150 key k
  click 90 385 # add here: the beginning
  drag
  click 160 385                     # add after: 2 s
  does mousemove 400 150 key e      # edges
  click 160 385                     # add after: 4 s
  click 400 470                     # a row: the window has the keys
  does key ctrl+s
  does key ctrl+a type list.json
  does key Return
}
# Three lines have what the list has to hold: a camera that takes 2 s, and edges at 4 s.
made() { [[ -s list.json ]] && grep -q '"over": 2.0' list.json && grep -q '"time": 4.0' list.json; }
play() {
  click 70 421 # to the beginning
  click 94 421 # play
}
played() { grep -c '"eye"' done.json | awk '{ exit !($1 > 6) }'; } # the camera has moved through many places
film() {
  click 72 358  # the menu "List"
  click 80 460  # video
  does key ctrl+a type list.mp4
  does key Return
}
filming() { titled '^film - '; }
filmed() { [[ -s list.mp4 ]] && ! filming; }

# comes CONDITION SECONDS: waits for it.
comes() {
  local end=$((SECONDS + $2))
  until $1; do
    ((SECONDS < end)) || return 1
    sleep 0.2
  done
}

open_window "$program" --sample sphere --detail 24 --resolution 64 --steps 4 --fps 5 --size 800x600 --set panel=false \
  --quiet --save-recording done.json
for pace in 0.4 1 3; do # more slowly at each attempt, where much else runs
  make_list
  if comes made 10; then break; fi
  does key Escape
  quit_window
  [[ $pace != 3 ]] || exit 1
  open_window "$program" --sample sphere --detail 24 --resolution 64 --steps 4 --fps 5 --size 800x600 --set panel=false \
    --quiet --save-recording done.json
done
for pace in 0.4 1 3; do
  play
  if comes played 20; then break; fi
done
for pace in 0.4 1 3; do
  film
  if comes filming 10; then break; fi
  does key Escape
done
until_true "the video" filmed
quit_window
