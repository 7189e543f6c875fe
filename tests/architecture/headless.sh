#!/usr/bin/env bash
# Nacre: a headless program links no windows and no OpenGL. Usage: headless.sh PROGRAM; prints what it links, and fails.
set -euo pipefail
program=$1

# Direct and indirect libraries; where the loader cannot run the program, its direct ones.
libraries=$(ldd "$program" 2>/dev/null) || libraries=$(readelf -d "$program" | grep NEEDED)
[[ $libraries == *libc.so* ]] || {
  echo "$program: its libraries could not be listed"
  exit 1
}
if grep -Ei 'lib(GL|GLX|GLdispatch|OpenGL|EGL|GLEW|GLU|OSMesa|glfw|X11|Xext|xcb|wayland|imgui|SDL)[^/ ]*\.so' <<<"$libraries"; then
  echo "$program: links the libraries above, and is meant to run without a display"
  exit 1
fi
