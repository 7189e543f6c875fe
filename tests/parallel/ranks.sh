#!/usr/bin/env bash
# Nacre: flow on several processes gives the bytes of one; when one of them dies or the user stops them, all end, and
# outputs are whole or absent. Usage: ranks.sh PROGRAM MPIRUN [all|bytes|faults]
set -euo pipefail
program=$(readlink -f "$1")
mpirun=$2
what=${3:-all}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
bad=0
complain() { echo "$*"; bad=1; }
launch() { "$mpirun" --oversubscribe --bind-to none -n "$@"; }

# same NAME "P..." OPTIONS...: picture, values and frames of P processes are those of one without mpirun.
same() {
  local name=$1 processes=$2 p
  shift 2
  local words=(flow --method octree --size 240x180 --quiet "$@")
  "$program" "${words[@]}" --image "$name.png" --out "$name.vtp" --frames "$name" >/dev/null
  for p in $processes; do
    launch "$p" "$program" "${words[@]}" --threads $((1 + p % 2)) --image "$name-$p.png" --out "$name-$p.vtp" \
      --frames "$name-$p" --report "$name-$p.json" >/dev/null || complain "$name on $p processes failed"
    cmp "$name.png" "$name-$p.png" && cmp "$name.vtp" "$name-$p.vtp" && diff -r "$name" "$name-$p" >/dev/null ||
      complain "$name: $p processes give other bytes than one"
    grep -q "\"count\": $p" "$name-$p.json" || complain "$name: the report does not tell of $p processes"
  done
}

# refused STATUS TEXT P WORDS...: all processes end with this status, and one line of ours that has this text.
refused() {
  local wanted=$1 text=$2 status=0
  shift 2
  launch "$@" >refused.out 2>refused.err || status=$?
  [[ $status == "$wanted" ]] || complain "status $status instead of $wanted: $*"
  [[ $(grep -c '^nacre: ' refused.err) == 1 ]] || complain "not one line: $(cat refused.err)"
  grep '^nacre: ' refused.err | grep -q "$text" || complain "no '$text': $(cat refused.err)"
}

if [[ $what != faults ]]; then
  same train "1 2 3 4 7" --sample train --detail 96 --resolution 200 --steps 2
  same vortex "3" --sample delta-wing --detail 200 --resolution 300 --steps 1 --step-cells 12 --streaks 40
  same particles "3" --sample cylinder --detail 140 --resolution 160 --steps 2 --streaks 0 --camera +x
  same few "7" --sample sphere --resolution 20 --steps 1 # some have next to no bricks
fi
[[ $what == bytes ]] && exit $bad

train=(flow --sample train --detail 96 --method octree --resolution 160 --size 160x120 --quiet)
refused 1 'share only an octree' 2 "$program" flow --sample sphere --method grid --resolution 64 --steps 1 --image no.png
refused 2 'no input' 2 "$program" flow --image no.png
refused 2 'only nacre flow works' 2 "$program" mesh --sample nested-shells --out no.vtp
refused 1 'another input' 1 "$program" "${train[@]}" --steps 1 --image no.png : -n 1 "$program" "${train[@]}" --steps 1 \
  --image no.png --seed 5

# ended SIGNAL WHOM: the run ends soon, and leaves neither a picture nor half of one.
ended() {
  local signal=$1 whom=$2 pid victim left=600
  rm -rf run && mkdir run
  "$mpirun" --oversubscribe --bind-to none -n 3 "$program" "${train[@]}" --steps 100000 --video run/flow.mp4 \
    --frames run/frames >run.out 2>run.err &
  pid=$!
  until [[ -e run/frames/frame_0001.png ]]; do
    kill -0 $pid 2>/dev/null || { complain "the run to be ended by $signal failed: $(cat run.err)"; return; }
    sleep 0.1
  done
  mapfile -t processes < <(pgrep -P $pid -x nacre)
  victim=$pid
  [[ $whom == one ]] && victim=${processes[1]}
  kill -"$signal" "$victim"
  while kill -0 $pid 2>/dev/null && ((left-- > 0)); do sleep 0.1; done
  ((left > 0)) || { complain "mpirun still runs a minute after $signal to $whom"; kill -9 $pid; }
  wait $pid && complain "status 0 after $signal to $whom"
  for each in "${processes[@]}"; do
    left=300
    while kill -0 "$each" 2>/dev/null && ((left-- > 0)); do sleep 0.1; done
    ((left > 0)) || complain "process $each lives on after $signal to $whom"
  done
  local rest
  rest=$(find run -type f -not -name 'frame_*.png')
  [[ -z $rest ]] || complain "left behind after $signal to $whom: $rest"
}
ended KILL one
ended INT all
exit $bad
