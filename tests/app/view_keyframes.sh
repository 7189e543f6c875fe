#!/usr/bin/env bash
# Nacre: a user makes a list of keyframes in a window under Xvfb, plays it, saves it and films it. Usage:
# view_keyframes.sh PROGRAM FOLDER; writes FOLDER/list.json, list.mp4 and done.json; 77: tools are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 1200x800 xdotool ffmpeg
program=$1
cd "$2"

does() {
  xdotool "$@"
  sleep "$pace"
}
click() { does mousemove "$1" "$2" click 1; }
drag() {
  does mousemove 800 250 mousedown 1
  does mousemove 880 270
  does mouseup 1
}

# The window of the keyframes is at the bottom of the picture, which is beside the panel.
make_list() {
  rm -f list.json
  does mousemove 800 150 key k
  click 477 519 # add here: the beginning
  does mousemove 800 150 key e
  click 550 519 # add after: edges at 2 s
  drag
  click 550 519 # add after: a camera at 4 s
  does key ctrl+s
  does key ctrl+a type list.json
  does key Return
}
made() { [[ -s list.json ]] && grep -q '"over": 2.0' list.json && grep -q '"duration": 4.0' list.json; }
play() {
  click 460 555 # to the beginning
  click 484 555 # play
}
played() { grep -c '"eye"' done.json | awk '{ exit !($1 > 6) }'; } # the camera has moved through many places
film() {
  click 461 491 # the menu "List"
  click 480 592 # video
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

words=(--sample sphere --detail 24 --resolution 64 --steps 4 --fps 5 --size 1200x800 --quiet
  --save-recording done.json)
for pace in 0.4 1 3; do # more slowly at each attempt, where much else runs
  open_window "$program" "${words[@]}"
  make_list
  if comes made 10; then break; fi
  does key Escape
  quit_window
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
