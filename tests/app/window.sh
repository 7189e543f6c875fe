# Nacre: a viewer in a window, for scripts that play its user; to be sourced. They wait for what they see, not for times.

# on_display SCREEN TOOLS...: brings up an Xvfb with a screen of that size, which dies with the script; ends with 77 where
# it or a tool is missing. The server picks its number itself, as others may be starting. It does not start over when its
# last client goes: meanwhile it would refuse the next.
on_display() {
  local screen=$1 tool number
  shift
  for tool in Xvfb "$@"; do
    command -v "$tool" >/dev/null || {
      echo "no $tool here" >&2
      exit 77
    }
  done
  exec {numbers}< <(exec Xvfb -displayfd 1 -noreset -screen 0 "${screen}x24" 2>/dev/null)
  display=$!
  state=$(mktemp -d)  # recent files are the user's own
  export XDG_STATE_HOME=$state
  export LSAN_OPTIONS=detect_leaks=0  # of drivers that are unloaded by then; offscreen they are looked for
  trap clean_up EXIT
  read -r number <&"$numbers"
  export DISPLAY=:$number
}

clean_up() {
  kill ${viewer:-} "$display" 2>/dev/null || true
  rm -rf "$state"
}

# open_window PROGRAM WORDS...: starts it with them and focuses its window once that shows something; sets `viewer` to its
# process, which dies with the script.
open_window() {
  "$1" view "${@:2}" &
  viewer=$!
  until_true "the window" titled ' - Nacre$'
  xdotool windowfocus "$(xdotool search --name 'Nacre$' | head -1)"
}

# quit_window: quits as a user does, once more where it asks whether to; gives the viewer's status.
quit_window() {
  local end=$((SECONDS + 120))
  while kill -0 "$viewer" 2>/dev/null && ((SECONDS < end)); do
    xdotool key ctrl+q 2>/dev/null || true
    sleep 0.5
  done
  wait "$viewer"
}

# titled PATTERN: does the window's title match? It says how far the work is and what is open: "relax 40% - a.nrrd - Nacre".
titled() { [[ -n $(xdotool search --name "$1" 2>/dev/null) ]]; }

# until_true WHAT WORDS...: waits until the words succeed, two minutes at most; then says that WHAT did not come.
until_true() {
  local what=$1 end=$((SECONDS + 120))
  shift
  until "$@"; do
    kill -0 "$viewer" 2>/dev/null && ((SECONDS < end)) || {
      echo "$what did not come" >&2
      return 1
    }
    sleep 0.2
  done
}
