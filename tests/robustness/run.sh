#!/usr/bin/env bash
# Nacre: malformed and odd files through the program. Usage: run.sh BINARY [--fraction N] [--jobs N]
# Every file (or every Nth) goes through `nacre info` and `nacre flow`, and the malformed and the small ones (where one mesh
# takes a moment) through `nacre mesh`. Good is: status 0, 1 or 2; where it is not 0 exactly one line that begins "nacre:";
# no sanitizer report; no file left behind, and a picture or mesh only where all went well. Prints a table of counts and
# every offender; fails if there is one.
set -euo pipefail

fail() {
  echo "run.sh: $*" >&2
  exit 2
}

(($#)) || fail "usage: run.sh BINARY [--fraction N] [--jobs N]"
program=$(readlink -f "$1") || fail "no such program: $1"
[[ -x $program ]] || fail "no such program: $1"
shift
fraction=1
jobs=$(nproc)
while (($#)); do
  case $1 in
    --fraction) fraction=${2:-} ;;
    --jobs) jobs=${2:-} ;;
    *) fail "no such option: $1" ;;
  esac
  [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || fail "$1 takes a number above 0"
  shift 2
done

data=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/../shared/data
files=()
for folder in malformed meshes labels scalar; do
  if [[ -d $data/$folder ]]; then
    mapfile -d '' -t -O "${#files[@]}" files < <(find -L "$data/$folder" -type f -print0 | sort -z)
  else
    echo "run.sh: skipped $folder: there is no $data/$folder"
  fi
done
chosen=()
for ((i = 0; i < ${#files[@]}; i += fraction)); do chosen+=("${files[i]}"); done
((${#chosen[@]})) || exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# judge STATUS ERRORS FOLDER RESULT: why this result is not good; nothing where it is. RESULT: the file that success writes.
judge() {
  local status=$1 errors=$2 folder=$3 result=$4 lines left
  lines=$(grep -ac '^nacre:' "$errors") || true
  left=$(find "$folder" -mindepth 1 ! -name "$result" | head -n 1)
  if grep -aqE 'Sanitizer|runtime error:' "$errors"; then
    grep -aE 'SUMMARY|runtime error:' "$errors" | head -n 1
  elif ((status == 124 || status == 137 || status == 152)); then  # 152: SIGXCPU
    echo "did not end in time, or was killed"
  elif ((status > 2)); then
    echo "ended with status $status: $(tail -n 1 "$errors")"
  elif ((status > 0 && lines != 1)); then
    echo "failed with $lines lines that begin 'nacre:'"
  elif ((status > 0)) && [[ $result != none && -e $folder/$result ]]; then
    echo "failed and left $result"
  elif ((status == 0)) && [[ $result != none && ! -s $folder/$result ]]; then
    echo "succeeded without $result"
  elif [[ -n $left ]]; then
    echo "left ${left##*/} behind"
  fi
}

# one COMMAND FILE: runs it and prints COMMAND, STATUS, FILE and why it is not good, separated by tabs.
one() {
  local command=$1 file=$2 folder status=0 result=none words
  folder=$(mktemp -d "$work/run-XXXXXX")
  mkdir "$folder/out" "$folder/tmp"
  words=(info "$file")
  if [[ $command == flow ]]; then
    words=(flow "$file" --vectors @swirl --resolution 48 --steps 1 --size 96x72 --image "$folder/out/picture.png" --quiet)
    result=picture.png
  elif [[ $command == mesh ]]; then
    words=(mesh "$file" --min-size 3 --max-size 3 --iterations 3 --set smooth=1 --set remesh=1 --out "$folder/out/mesh.ply" --quiet)
    result=mesh.ply
  fi
  (
    ulimit -t 120  # processor seconds: a busy machine makes nothing fail
    TMPDIR=$folder/tmp exec timeout -k 5 900 "$program" "${words[@]}" >"$folder/stdout" 2>"$folder/stderr" </dev/null
  ) || status=$?
  printf '%s\t%s\t%s\t%s\n' "$command" "$status" "$file" "$(judge "$status" "$folder/stderr" "$folder/out" $result | tr '\t' ' ')"
  rm -rf "$folder"
}
export -f one judge
export program work

for file in "${chosen[@]}"; do
  printf 'info\0%s\0flow\0%s\0' "$file" "$file"
  # Atlases would take longer than all the rest; the data of some are in a file beside.
  [[ $file != */malformed/* && -n $(find -L "${file%.*}".* -maxdepth 0 -size +99k) ]] || printf 'mesh\0%s\0' "$file"
done >"$work/runs"
xargs -0 -n 2 -P "$jobs" bash -c 'one "$@"' _ <"$work/runs" >"$work/results"

awk -F '\t' -v files="${#chosen[@]}" '
  { runs[$1]++; if ($4 != "") bad[$1]++; else good[$1, $2]++ }
  END {
    printf "%d files\n%-8s %6s %6s %6s %6s %6s\n", files, "", "runs", "done", "failed", "words", "BAD"
    for (c = 1; c <= 3; c++) {
      name = c == 1 ? "info" : c == 2 ? "flow" : "mesh"
      printf "%-8s %6d %6d %6d %6d %6d\n", name, runs[name], good[name, 0], good[name, 1], good[name, 2], bad[name]
    }
  }' "$work/results"
awk -F '\t' '$4 != "" { printf "BAD %s %s: %s\n", $1, $3, $4; bad = 1 } END { exit bad }' "$work/results"
expected=$(tr -dc '\0' <"$work/runs" | wc -c)
expected=$((expected / 2))
(($(wc -l <"$work/results") == expected)) || fail "fewer results than runs"
