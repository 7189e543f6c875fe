#!/usr/bin/env bash
# Nacre: all unit tests under the thread sanitizer, suite by suite. Usage: races.sh BIN TBB [PATTERN]
# BIN has test programs built with the sanitizer, TBB is the folder of instrumented_tbb.sh; PATTERN chooses suites, as in
# --gtest_filter. NACRE_RACES_JOBS suites (as many as processors) run at once, each for NACRE_RACES_SECONDS (900) at most.
# What it said is in BIN/../races. Fails where a suite has a race or a failure; suites that are cut by their time are
# named, and are no failure if nothing was found until then.
set -uo pipefail
bin=$1 tbb=$2 pattern=${3:-*}
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
export out=$bin/../races
mkdir -p "$out"
: >"$out/verdicts"
export LD_LIBRARY_PATH=$tbb/prefix/lib TSAN_OPTIONS="suppressions=$here/tsan.supp exitcode=66"
# Mesa's drivers synchronise by futexes, of which the sanitizer knows nothing; what they read and write by the C library is
# left out. (A suppression by their names would end programs that unload them.)
TSAN_OPTIONS+=" ignore_noninstrumented_modules=1"

# suites: a line for each, the program and the suite.
suites() {
  local program list
  for program in "$bin"/test_*; do
    if list=$("$program" --gtest_list_tests --gtest_filter="$pattern"); then
      sed -n "s|^\([^ ]*\)\.\( .*\)\?\$|$program \1|p" <<<"$list"
    else
      echo "failed $program does not start" >>"$out/verdicts"
    fi
  done
}

# run_suite PROGRAM SUITE: prints a line, and adds one to the verdicts.
run_suite() {
  local name status=0 reports verdict=clean begun=$SECONDS
  name=$(basename "$1").${2//\//_}
  timeout "${NACRE_RACES_SECONDS:-900}" "$1" "--gtest_filter=$2.*" >"$out/$name.log" 2>&1 || status=$?
  reports=$(grep -c '^WARNING: ThreadSanitizer' "$out/$name.log")
  if ((reports > 0 || (status != 0 && status != 124))); then
    verdict=failed
  elif ((status == 124)); then
    verdict=cut
  fi
  printf '%s: %s, status %d, %d reports, %d s\n' "$name" "$verdict" "$status" "$reports" $((SECONDS - begun))
  echo "$verdict $name" >>"$out/verdicts"
}
export -f run_suite

# those VERDICT: names of the suites.
those() { sed -n "s/^$1 //p" "$out/verdicts" | sort | paste -sd, ; }

suites | xargs -P "${NACRE_RACES_JOBS:-$(nproc)}" -L 1 bash -c 'run_suite "$@"' _
cut=$(those cut) failed=$(those failed)
echo "$(wc -l <"$out/verdicts") suites; cut by time: ${cut:-none}; failed: ${failed:-none}"
[[ -s $out/verdicts && -z $failed ]]
