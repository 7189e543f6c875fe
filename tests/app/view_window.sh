#!/usr/bin/env bash
# Nacre: the window of the viewer under Xvfb. Usage: view_window.sh PROGRAM PICTURE REPORT; 77: there is no Xvfb.
# Displays are numbered by the process: of two runs that begin at once, -a alone can give both the same.
set -euo pipefail
program=$1 picture=$2 report=$3
command -v xvfb-run >/dev/null || {
  echo "no xvfb-run here" >&2
  exit 77
}
xvfb-run -a -n $((100 + $$ % 20000)) -s "-screen 0 1280x1024x24" "$program" view --sample sphere --detail 24 --resolution 64 \
  --size 400x300 --no-panel --frames-count 40 --image "$picture" --report "$report" --quiet
