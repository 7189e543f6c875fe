#!/usr/bin/env bash
# Nacre: all unit tests under the thread sanitizer, suite by suite. Usage: races.sh BIN TBB [PATTERN]
# BIN has test programs built with the sanitizer, TBB is the folder of instrumented_tbb.sh; PATTERN chooses suites, as in
# --gtest_filter. A suite has NACRE_RACES_SECONDS (900). What it said is in BIN/../races. Fails where a suite has a race
# or a failure; suites that are cut by their time are named, and are no failure if nothing was found until then.
set -uo pipefail
bin=$1 tbb=$2 pattern=${3:-*}
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
out=$bin/../races
mkdir -p "$out"
export LD_LIBRARY_PATH=$tbb/prefix/lib TSAN_OPTIONS="suppressions=$here/tsan.supp exitcode=66"
suites=0 cut=() failed=()
for program in "$bin"/test_*; do
  list=$("$program" --gtest_list_tests --gtest_filter="$pattern") || { failed+=("$program does not start"); continue; }
  for suite in $(sed -n 's/^\([^ ]*\)\.\( .*\)\?$/\1/p' <<<"$list"); do
    name=$(basename "$program").${suite//\//_}
    begun=$SECONDS status=0
    timeout "${NACRE_RACES_SECONDS:-900}" "$program" "--gtest_filter=$suite.*" >"$out/$name.log" 2>&1 || status=$?
    races=$(grep -c '^WARNING: ThreadSanitizer' "$out/$name.log")
    printf '%s: status %d, %d reports, %d s\n' "$name" "$status" "$races" $((SECONDS - begun))
    ((++suites))
    if ((races > 0 || (status != 0 && status != 124))); then
      failed+=("$name")
    elif ((status == 124)); then
      cut+=("$name")
    fi
  done
done
echo "$suites suites; cut by time: ${cut[*]:-none}; failed: ${failed[*]:-none}"
((suites > 0 && ${#failed[@]} == 0))
