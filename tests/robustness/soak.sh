#!/usr/bin/env bash
# Nacre: memory and open files over many steps. Usage: soak.sh BINARY STEPS [CSV]
# Runs `nacre flow` for so many steps on a small sample, and looks twice a second how much memory it has and how many
# files it has open. After the first tenth, memory may grow by 5 % and 8 MiB, and open files not at all. CSV gets
# seconds,KiB,files for a plot.
set -euo pipefail

program=$(readlink -f "$1")
steps=$2
csv=${3:-/dev/null}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$program" flow --sample sphere --detail 16 --resolution 48 --steps "$steps" --quiet --report "$work/report.json" &
child=$!
begun=$SECONDS
while kill -0 "$child" 2>/dev/null; do
  memory=$(awk '/^VmRSS:/ { print $2 }' "/proc/$child/status" 2>/dev/null) || true
  files=$(find "/proc/$child/fd" -mindepth 1 2>/dev/null | wc -l) || true
  [[ -z $memory ]] || echo "$((SECONDS - begun)),$memory,$files" >>"$work/log"
  sleep 0.5
done
wait "$child"
cp "$work/log" "$csv" 2>/dev/null || cat "$work/log" >"$csv"

awk -F , -v steps="$steps" '
  { memory[NR] = $2; files[NR] = $3 }
  END {
    first = int(NR / 10) + 1
    printf "%d steps, %d looks: memory %d KiB after the first tenth, %d KiB at the end; open files %d, then %d\n",
      steps, NR, memory[first], memory[NR], files[first], files[NR]
    exit memory[NR] > memory[first] * 1.05 + 8192 || files[NR] > files[first]
  }' "$work/log"
