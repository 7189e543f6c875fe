#!/usr/bin/env bash
# Nacre: the window of the viewer under Xvfb. Usage: view_window.sh PROGRAM PICTURE REPORT; 77: there is no Xvfb.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 1280x1024
"$1" view --sample sphere --detail 24 --resolution 64 --size 400x300 --no-panel --frames-count 40 --image "$2" \
  --report "$3" --quiet
