#!/usr/bin/env bash
# Nacre: the launcher of packages starts the program for the highest level of processors that runs here, or the one that is
# asked for. Usage: launcher.sh NACRE WORK CXX
set -euo pipefail
nacre=$1 work=$2 cxx=$3
fail() {
  echo "$*"
  exit 1
}

rm -rf "$work"
mkdir -p "$work/bin"
"$cxx" -std=c++20 -O1 "$nacre/app/package/launcher.cpp" -o "$work/bin/nacre"
# program LEVEL: a program that tells its level and its arguments.
program() {
  mkdir -p "$work/libexec/nacre/$1"
  printf '#!/bin/sh\necho %s "$@"\nexit 7\n' "$1" >"$work/libexec/nacre/$1/nacre"
  chmod +x "$work/libexec/nacre/$1/nacre"
}
expect() {
  local said status=0
  said=$("$work/bin/nacre" a 'b c' 2>&1) || status=$?
  [[ $said == "$2"* && $status == "$1" ]] || fail "status $status: $said; expected $1: $2"
}

expect 1 'nacre: this processor is older'
program x86-64-v2
grep -q '^flags.* sse4_2' /proc/cpuinfo || { echo "skipped: this processor is older than x86-64-v2"; exit 77; }
expect 7 'x86-64-v2 a b c'
program x86-64-v3
if grep -q '^flags.* avx2' /proc/cpuinfo; then
  expect 7 'x86-64-v3 a b c'
  NACRE_LEVEL=x86-64-v2 expect 7 'x86-64-v2 a b c'
  NACRE_LEVEL='' expect 7 'x86-64-v3 a b c'
fi
NACRE_LEVEL=x86-64-v9 expect 1 'nacre: there is no program for NACRE_LEVEL=x86-64-v9'
ln -s "$work/bin/nacre" "$work/link"
[[ $("$work/link" x || true) == x86-64-v* ]] || fail "it is not found through a link"
echo "the launcher takes the right program"
