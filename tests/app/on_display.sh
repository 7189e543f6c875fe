#!/usr/bin/env bash
# Nacre: a command on a display of its own (Xvfb). Usage: on_display.sh WORDS...; 77: there is no Xvfb.
set -euo pipefail
source "$(dirname "$0")/window.sh"
on_display 1280x1024
"$@"
