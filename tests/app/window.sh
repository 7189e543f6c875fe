# Nacre: a viewer in a window, for scripts that play its user; to be sourced.

# open_window WORDS...: starts $program with them and focuses its window; sets `viewer` to its process, which dies with
# the script.
open_window() {
  local try window=
  "$program" view "$@" &
  viewer=$!
  trap 'kill $viewer 2>/dev/null || true' EXIT
  for try in {1..100}; do
    window=$(xdotool search --name '^Nacre$' 2>/dev/null | head -1) && [[ -n $window ]] && break
    sleep 0.1
  done
  [[ -n $window ]] || return 1
  sleep 2 # for the first texture
  xdotool windowfocus "$window"
}
