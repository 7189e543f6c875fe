#!/usr/bin/env bash
# Nacre: a user films a flow in a window under Xvfb, minimises the window meanwhile and pulls it to another size. Usage:
# view_film.sh PROGRAM VIDEO REPORT SCREEN; SCREEN is a picture of what is seen in the end. 77: tools are missing.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 800x600 xdotool ffmpeg
program=$1 video=$2 report=$3 screen=$4

open_window "$program" --sample sphere --detail 24 --resolution 64 --size 640x480 --quiet --report "$report"
window=$(xdotool search --name 'Nacre$' | head -1)
filming() { titled '^film - '; }
filmed() { [[ -s $video ]] && ! filming; }
film() { # by its key, until WHAT holds; more slowly at each attempt, where much else runs. ffmpeg takes its time to end.
  local what=$1 pace try patience=20
  [[ $what == filming ]] || patience=120
  for pace in 0.5 2 5; do
    xdotool windowfocus "$window" key ctrl+m
    sleep $pace
    [[ $what == filming ]] && xdotool key ctrl+a type "$video" && sleep $pace && xdotool key Return
    for ((try = 0; try < patience; ++try)); do
      $what && return
      sleep 0.5
    done
    xdotool key Escape
  done
  echo "$what did not come" >&2
  return 1
}

xdotool mousemove 500 200
film filming
sleep 1
xdotool windowunmap "$window" # without a window manager that is what minimising does
sleep 2
xdotool windowmap "$window"
sleep 0.5
film filmed
xdotool windowsize "$window" 720 560 windowmove "$window" 0 0
sleep 2
ffmpeg -v error -y -f x11grab -video_size 720x560 -i "$DISPLAY" -frames:v 1 "$screen"
xdotool windowfocus "$window"
quit_window
