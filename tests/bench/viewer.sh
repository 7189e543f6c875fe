#!/usr/bin/env bash
# Nacre: what a window costs: a step of the flow beside the command's, by turns; a window at rest; one that is hidden;
# and how long a cancelled computation goes on. Under Xvfb, with software OpenGL.
# Usage: viewer.sh BINARY [options of nacre flow and nacre view, e.g. --threads 2]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_RESOLUTION (default 512), NACRE_BENCH_ROUNDS (default 3), NACRE_BENCH_SECONDS that a window
# steps or rests (default 20), NACRE_DATA (folder that holds drivaer.pvd).
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$here/begin.sh"
source "$here/../app/window.sh"
on_display 1280x1024 xdotool
begin_bench viewer "$@"
trap 'clean_up; [[ -n ${OUT:-} ]] || rm -rf "$out"' EXIT
resolution=${NACRE_BENCH_RESOLUTION:-512} rounds=${NACRE_BENCH_ROUNDS:-3} seconds=${NACRE_BENCH_SECONDS:-20}

# step_seconds REPORT: mean wall time of all that a step does, by its stages.
step_seconds() {
  local stage sum=0 calls
  calls=$(stage_calls "$1" filter)
  for stage in velocity streaks filter advect deposit normalise; do
    sum=$(awk -v a="$sum" -v b="$(stage_seconds "$1" "$stage")" 'BEGIN { print a + b }')
  done
  awk -v sum="$sum" -v calls="${calls:-0}" 'BEGIN { print (calls > 0) ? sum / calls : 0 }'
}

# used PROCESS: processor time so far, in hundredths of a second.
used() { awk '{ sub(/^.*\) /, ""); print $12 + $13 }' "/proc/$1/stat"; }

# share_of_core PROCESS: that it uses in the next `seconds`, in per cent.
share_of_core() {
  local before after
  before=$(used "$1")
  sleep "$seconds"
  after=$(used "$1")
  awk -v used=$((after - before)) -v seconds="$seconds" 'BEGIN { printf "%.1f", used / seconds }'
}

works() { titled '(embed|start|refin|read|opening)'; }
rests() { ! works; }

# compare NAME INPUT...: the median ratio of a step in a window and one of the command, by turns.
compare() {
  local name=$1 round ratios=()
  shift
  for ((round = 0; round < rounds; ++round)); do
    "$nacre" flow "$@" "${options[@]}" --quiet --resolution "$resolution" --steps 10 --image "$out/$name.png" \
      --report "$out/$name-flow-$round.json" >/dev/null
    open_window "$nacre" "$@" "${options[@]}" --quiet --resolution "$resolution" --report "$out/$name-view-$round.json"
    until_true "a step" rests
    sleep "$seconds"
    quit_window || true
    ratios+=("$(awk -v a="$(step_seconds "$out/$name-view-$round.json")" \
      -v b="$(step_seconds "$out/$name-flow-$round.json")" 'BEGIN { printf "%.3f", (b > 0) ? a / b : 0 }')")
  done
  printf '| %s | step: window / command, median of %d | %s | 1.15 |\n' "$name" "$rounds" \
    "$(printf '%s\n' "${ratios[@]}" | sort -n | sed -n "$(((rounds + 1) / 2))p")"
}

echo "$resolution texture cells, $(machine)"
echo
printf '| data | what | measured | at most |\n|---|---|---:|---:|\n'
drivaer=$({ find "$data" -name drivaer.pvd 2>/dev/null || true; } | sort | head -n 1)
if ((rounds > 0)); then
  compare torus --sample torus
  [[ -z $drivaer ]] || compare drivaer "$drivaer"
fi

open_window "$nacre" --sample torus "${options[@]}" --quiet --resolution 64 --set play=false
until_true "a paused flow" rests
sleep 3
printf '| torus, 64 | paused: per cent of a core | %s | 2 |\n' "$(share_of_core "$viewer")"
xdotool windowunmap "$(xdotool search --name 'Nacre$' | head -1)"
sleep 1
printf '| torus, 64 | hidden: per cent of a core | %s | 2 |\n' "$(share_of_core "$viewer")"
kill "$viewer"
wait "$viewer" || true

open_window "$nacre" --sample torus "${options[@]}" --quiet --resolution "$((2 * resolution))"
until_true "an embedding" titled '^(embed|start)'
begin=$(date +%s%N)
xdotool key Escape
while works && kill -0 "$viewer"; do sleep 0.02; done
printf '| torus, %d | cancelled within, s | %s | 0.3 |\n' $((2 * resolution)) \
  "$(awk -v ns=$(($(date +%s%N) - begin)) 'BEGIN { printf "%.2f", ns / 1e9 }')"
kill "$viewer"
wait "$viewer" || true
