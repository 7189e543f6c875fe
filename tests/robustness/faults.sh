#!/usr/bin/env bash
# Nacre: faults in the middle of a run. Usage: faults.sh BINARY PRELOAD [--runs N] [--all] [--jobs N] [--kind KIND]
# A small flow and a small mesh run are repeated, each time with one fault injected by tests/robustness/fault_preload.cpp:
# an allocation that fails, a disk that is full, a signal. N (default 12) calls of each kind are chosen evenly over the
# run; --all takes every one; --jobs of them at a time (1); --kind chooses one kind. Good is: status 0 where nothing
# failed that mattered, 1 with one line that begins "nacre:", or 130/143 after a signal; results that are whole or not
# there; an older result untouched after a failure; nothing else left behind. Then: two programs writing one output,
# ffmpeg that dies, an input replaced while it is read.
set -euo pipefail

program=$(readlink -f "$1")
preload=$(readlink -f "$2")
shift 2
runs=12 jobs=1 chosen=
while (($#)); do
  case $1 in
    --runs) runs=$2; shift 2 ;;
    --all) runs=1000000000; shift ;;
    --jobs) jobs=$2; shift 2 ;;
    --kind) chosen=$2; shift 2 ;;
    *) echo "faults.sh: no such option: $1" >&2; exit 2 ;;
  esac
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
total=0

small=(flow --sample sphere --detail 12 --resolution 32 --steps 2 --size 64x48 --quiet --threads 1)
flow=("${small[@]}" --image image.png --out values.vtp --report report.json)
mesh=(mesh --sample two-spheres --detail 16 --iterations 3 --size 64x48 --quiet --threads 1
  --image image.png --out mesh.vtu --report report.json)

offend() {
  echo "BAD $*" | tee -a "$work/bad"
}

# whole FILE REFERENCE: does the file hold what a good run writes? Reports differ in times: they have to be whole.
whole() {
  case $1 in
    *.json) tail -c 2 "$1" | grep -q '}' ;;
    *) cmp -s "$1" "$2" ;;
  esac
}

# judge LABEL FOLDER REFERENCE STATUS
judge() {
  local label=$1 folder=$2 reference=$3 status=$4 file lines
  lines=$(grep -ac '^nacre:' "$folder/stderr") || true
  # The C library itself ends a program that has no memory for the destructor of a variable of a thread.
  if ((status == 134)) && grep -q '^Fatal glibc error: .*out of memory' "$folder/stderr"; then
    echo "$label: ended by the C library"
  elif ((status != 0 && status != 1 && status != 130 && status != 143)); then
    offend "$label: status $status: $(tail -n 1 "$folder/stderr")"
  elif ((status == 1 && lines != 1)); then
    offend "$label: failed with $lines lines that begin 'nacre:'"
  fi
  for file in "$folder"/out/* "$folder"/out/.[!.]*; do
    [[ -e $file ]] || continue
    if [[ ! -e $reference/${file##*/} ]]; then
      offend "$label: left ${file##*/} behind"
    elif [[ $(head -c 8 "$file") == "an older" ]]; then
      ((status != 0)) || offend "$label: status 0, but ${file##*/} is an older one"
    elif ! whole "$file" "$reference/${file##*/}"; then
      offend "$label: ${file##*/} is not whole"
    fi
  done
  ((status != 0)) || for file in "$reference"/*; do
    [[ -e $folder/out/${file##*/} ]] || offend "$label: status 0 without ${file##*/}"
  done
}

# run_with FAULT REFERENCE ARGUMENTS...: one run in a folder of its own, over older results.
run_with() {
  local fault=$1 reference=$2 folder status=0 file
  shift 2
  folder=$(mktemp -d "$work/run-XXXXXX")
  mkdir "$folder/out" "$folder/tmp"
  for file in "$reference"/*; do echo "an older result" >"$folder/out/${file##*/}"; done
  (cd "$folder/out" && NACRE_FAULT=$fault LD_PRELOAD=$preload TMPDIR=$folder/tmp exec timeout -k 5 120 "$program" "$@") \
    >"$folder/stdout" 2>"$folder/stderr" </dev/null || status=$?
  judge "${arguments[0]} $fault" "$folder" "$reference" "$status"
  [[ -z $(find "$folder/tmp" -mindepth 1) ]] || offend "${arguments[0]} $fault: left something in TMPDIR"
  rm -rf "$folder"
}

for command in flow mesh; do
  declare -n arguments=$command
  mkdir "$work/$command"
  (cd "$work/$command" && NACRE_FAULT_COUNTS=$work/counts LD_PRELOAD=$preload "$program" "${arguments[@]}" >/dev/null)
  while read -r kind count; do
    [[ $kind != replace && $kind == "${chosen:-$kind}" ]] || continue
    ((count > 0)) || continue
    tried=0
    step=$(((count + runs - 1) / runs))
    for ((n = 1; n <= count; n += step)); do
      while (($(jobs -pr | wc -l) >= jobs)); do wait -n || true; done
      run_with "$kind:$n" "$work/$command" "${arguments[@]}" &
      tried=$((tried + 1))
    done
    wait
    total=$((total + tried))
    echo "$command: $kind, $tried of $count calls"
  done <"$work/counts"
  unset -n arguments
done

# Two programs write one output: whoever is last, it is one of the two.
mkdir "$work/two" "$work/one"
for seed in 1 2; do
  (cd "$work/one" && "$program" "${small[@]}" --image "$seed.png" --out "$seed.vtp" --seed $seed >/dev/null)
done
for round in 1 2 3; do
  for seed in 1 2; do (cd "$work/two" && "$program" "${flow[@]}" --seed $seed >/dev/null) & done
  wait
  for file in image.png values.vtp; do
    cmp -s "$work/two/$file" "$work/one/1.${file##*.}" || cmp -s "$work/two/$file" "$work/one/2.${file##*.}" ||
      offend "two programs: $file is of neither"
  done
  [[ -z $(find "$work/two" -name '.*' -type f) ]] || offend "two programs: something is left behind"
done

# ffmpeg that dies: at once, after some bytes, by a signal, or with a complaint at its end.
mkdir "$work/bin" "$work/video"
for death in 'exit 1' 'head -c 5000 >/dev/null; exit 1' 'kill -KILL $$' 'cat >/dev/null; echo no space left >&2'; do
  printf '#!/bin/sh\n%s\n' "$death" >"$work/bin/ffmpeg"
  chmod +x "$work/bin/ffmpeg"
  status=0
  (cd "$work/video" && PATH=$work/bin:$PATH exec "$program" flow --sample sphere --detail 12 --resolution 32 --steps 3 \
    --size 64x48 --quiet --video v.mp4) >/dev/null 2>"$work/stderr" || status=$?
  ((status == 1)) || offend "ffmpeg '$death': status $status"
  (($(grep -ac '^nacre:' "$work/stderr") == 1)) || offend "ffmpeg '$death': $(<"$work/stderr")"
  [[ -z $(find "$work/video" -mindepth 1) ]] || offend "ffmpeg '$death': left something behind"
done

# An input that another one replaces while it is open: an error, or a result of one of the two.
"$program" sample two-spheres --detail 16 --out "$work/a.nrrd" >/dev/null
"$program" sample two-spheres --detail 20 --out "$work/b.nrrd" >/dev/null
replaced=0
for ((n = 1; n <= 6; ++n)); do
  cp "$work/a.nrrd" "$work/input.nrrd"
  cp "$work/b.nrrd" "$work/other.nrrd"
  status=0
  NACRE_FAULT=replace:$n NACRE_FAULT_FILE=$work/input.nrrd NACRE_FAULT_OTHER=$work/other.nrrd LD_PRELOAD=$preload \
    "$program" mesh "$work/input.nrrd" --iterations 3 --quiet --out "$work/replaced.ply" \
    >/dev/null 2>"$work/stderr" || status=$?
  if [[ ! -e $work/other.nrrd ]] && ((n > 1)); then
    replaced=$((replaced + 1))
    ((status == 1)) || offend "replaced at opening $n: status $status, no error"
  fi
  ((status <= 1)) || offend "replaced at opening $n: status $status"
  rm -f "$work/replaced.ply"
done
((replaced > 0)) || offend "no input was replaced while it was in use"

echo "$total runs with a fault"
[[ ! -e $work/bad ]]
