#!/usr/bin/env bash
# Nacre: runs targets of libFuzzer one after the other. Usage: run.sh FOLDER SECONDS [CORPUS [TARGET...]]
# FOLDER has the programs fuzz_*; each runs for so many seconds. CORPUS (default out/fuzz) keeps what was found, so that the
# next run goes on from there; it begins with the small files of seeds.py and with those beside the project, where they
# are. A crash, more than 10 s of processor time for one input, a leak or too much memory ends a target; its input is kept
# in CORPUS/found.
set -euo pipefail

programs=$(readlink -f "$1")
seconds=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
corpus=${3:-$root/out/fuzz}
shift $(($# > 3 ? 3 : $#))
mkdir -p "$corpus/found"
bad=0

python3 "$root/tests/fuzz/seeds.py" "$corpus"
export LSAN_OPTIONS="suppressions=$root/tests/fuzz/lsan.supp:print_suppressions=0"

# Small files of the same extension beside the project.
add_files() {
  local file
  while IFS= read -r -d '' file; do
    cp -n "$file" "$corpus/$1/$(md5sum <"$file" | cut -c 1-16)"
  done < <(find -L "$root/../shared/data" -type f -iname "*.$1" -size -17k -print0 2>/dev/null)
}

(($#)) || set -- $(cd "$programs" && printf '%s\n' fuzz_* | sed 's/^fuzz_//')
for target in "$@"; do
  mkdir -p "$corpus/$target"
  add_files "$target"
  case $target in
    session) cp -n "$root"/assets/*_demo.json "$corpus/session" ;;
    camera) cp -n "$root"/assets/*_camera.json "$corpus/camera" ;;
  esac
  status=0
  "$programs/fuzz_$target" -max_total_time="$seconds" -timeout=600 -max_len=16384 -rss_limit_mb=3000 \
    -print_final_stats=1 -artifact_prefix="$corpus/found/$target-" "$corpus/$target" \
    >"$corpus/$target.log" 2>&1 || status=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$corpus/$target.log")
  echo "$target: ${runs:-no} runs in $seconds s, $(find "$corpus/$target" -type f | wc -l) files in its corpus, status $status"
  if ((status != 0)); then
    bad=1
    grep -aE 'ERROR|SUMMARY|too much memory|too slow|memory was asked|runtime error|Test unit written' "$corpus/$target.log" |
      head -n 5
  fi
done
exit $bad
