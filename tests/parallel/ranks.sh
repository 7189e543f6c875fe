#!/usr/bin/env bash
# Nacre: flow on several processes gives the bytes of one; when one of them dies or the user stops them, all end, and
# outputs are whole or absent. Usage: ranks.sh PROGRAM MPIRUN [all|bytes|faults]
set -euo pipefail
program=$(readlink -f "$1")
mpirun=$2
what=${3:-all}
write_pieces=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/write_pieces.py")
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

# pieces P: a .pvtp has a piece of each process that has cells, and together they hold what a .vtp holds.
pieces() {
  local words=(flow --method octree --sample train --detail 96 --resolution 160 --steps 1 --quiet) p
  "$program" "${words[@]}" --out one.vtp >/dev/null
  for p in "$@"; do
    launch "$p" "$program" "${words[@]}" --out "in-$p.pvtp" >/dev/null || complain "no pieces of $p processes"
    [[ $(ls in-"$p"_*.vtp | wc -l) == "$p" ]] || complain "not $p pieces: $(ls in-"$p"_*)"
    python3 - one.vtp "in-$p.pvtp" <<'PY' || complain "the pieces of $p processes hold other values"
import base64, sys, xml.etree.ElementTree as xml
def arrays(file):
    piece = xml.parse(file).getroot().find("PolyData/Piece")
    read = lambda at: [(a.get("Name"), base64.b64decode(a.text.strip())[8:]) for a in piece.find(at)]
    return read("PointData") + read("Points")
whole = arrays(sys.argv[1])
parts = [arrays(p.get("Source")) for p in xml.parse(sys.argv[2]).getroot().find("PPolyData").findall("Piece")]
for k, (name, data) in enumerate(whole):
    assert all(part[k][0] == name for part in parts) and b"".join(part[k][1] for part in parts) == data, name
PY
  done
}

# bounded P: of a surface in pieces no process has more than 1.3 times its part and what touches that, by its own count.
bounded() {
  local p
  mkdir -p many && python3 "$write_pieces" many/s 11 1 100
  for p in 1 "$1"; do
    launch "$p" "$program" flow many/s.pvd --method octree --resolution 500 --steps 1 --warmup 0 --streaks 0 --quiet \
      --report "many/$p.json" >/dev/null || complain "no run of $p processes on many pieces"
  done
  python3 - "$1" many/1.json "many/$1.json" <<'PY' || complain "a process has more than its part of the surface"
import json, sys
whole, parts = ([e["share"] for e in json.load(open(f))["processes"]["each"]] for f in sys.argv[2:])
for own in parts:
    bound = 1.3 * (whole[0]["peak_bytes"] / int(sys.argv[1]) + own["halo_bytes"])
    assert own["peak_bytes"] <= bound, (own, bound)
    assert own["near_bricks_bytes"] < 0.8 * whole[0]["near_bricks_bytes"], own
assert sum(own["triangles"] for own in parts) == whole[0]["triangles"]
PY
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

# resumed NAME OPTIONS...: a run that is stopped in the warm-up and later, each time on another number of processes,
# ends with the results of one that is not; its checkpoint does not tell how many there were.
resumed() {
  local name=$1 p
  shift
  local words=(flow --method octree --size 240x180 --quiet "$@")
  "$program" "${words[@]}" --image "$name.png" --out "$name.vtp" --frames "$name" >/dev/null
  words+=(--image "$name-r.png" --out "$name-r.vtp" --frames "$name-r" --checkpoint "$name.state")
  local stops=(2 1 3) # the warm-up has two steps
  for p in 2 1 3; do
    local status=0
    NACRE_FAULTS=stop@${stops[0]} launch "$p" "$program" "${words[@]}" >/dev/null 2>resumed.err || status=$?
    [[ $status == 130 && -e $name.state ]] || complain "$name on $p processes did not stop: $(cat resumed.err)"
    stops=("${stops[@]:1}")
  done
  launch 2 "$program" "${words[@]}" >/dev/null || complain "$name does not go on"
  cmp "$name.png" "$name-r.png" && cmp "$name.vtp" "$name-r.vtp" && diff -r "$name" "$name-r" >/dev/null ||
    complain "$name: a run that was stopped gives other bytes"
  [[ ! -e $name.state ]] || complain "$name: the checkpoint is still there"
  for p in 1 3; do # the state itself; what comes before it has the memory that was free, and a checksum ends it
    NACRE_FAULTS=stop@4 launch "$p" "$program" "${words[@]}" >/dev/null 2>&1 || true
    tail -c 100000 "$name.state" | head -c -4 >"$name.state-$p"
    rm "$name.state"
  done
  cmp "$name.state-1" "$name.state-3" || complain "$name: a checkpoint depends on the number of processes"
}

if [[ $what != faults ]]; then
  cat >near.json <<'JSON'
{"eye": [6, -8, 5], "target": [2.2, 0, 0], "up": [0, 0, 1], "height": 0.8}
JSON
  pieces 1 3
  resumed stopped --sample train --detail 96 --resolution 160 --steps 5 --warmup 2
  same train "1 2 3 4 7" --sample train --detail 96 --resolution 200 --steps 2
  same vortex "3" --sample delta-wing --detail 200 --resolution 300 --steps 1 --step-cells 12 --streaks 40
  same particles "3" --sample cylinder --detail 140 --resolution 160 --steps 2 --streaks 0 --camera +x
  same few "7" --sample sphere --resolution 20 --steps 1 # some have next to no bricks
  mkdir in && python3 "$write_pieces" in/s 5 3 && python3 "$write_pieces" in/lone 1 2 12
  same split "1 2 3 4 7" in/s.pvd --resolution 200 --steps 3 --color pressure --color-range 2%:98% # triangles of 50 cells
  same cells "3" in/s.pvd --resolution 160 --steps 1 --color density --camera=-y # means of cells at borders of pieces
  same swirl "4" in/s_0.pvtp --resolution 160 --steps 2 --vectors @swirl
  same lone "3" in/lone_0.pvtp in/lone_1.pvtp --resolution 100 --steps 2
  same near "2" in/s.pvd --resolution 60 --steps 1 --camera near.json # a close-up: each has the whole surface
  same lines "2" in/s.pvd --resolution 100 --steps 1 --topology # the same
  bounded 4
fi
[[ $what == bytes ]] && exit $bad

# Pieces that are not there, that cannot be read, or that differ.
mkdir gone && python3 "$write_pieces" gone/s && rm gone/s_1_3.vtp
mkdir cut && python3 "$write_pieces" cut/s && truncate -s 3000 cut/s_0_4.vtp
mkdir a b && python3 "$write_pieces" a/s && python3 "$write_pieces" b/s 5 3 26
split=(flow s.pvd --method octree --resolution 100 --steps 1 --image no.png --quiet)
refused 1 's_1_3.vtp cannot be opened' 3 -wdir gone "$program" "${split[@]}"
refused 1 's_0_4.vtp' 3 -wdir cut "$program" "${split[@]}"
refused 1 'another input' 1 -wdir a "$program" "${split[@]}" : -n 1 -wdir b "$program" "${split[@]}"

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
# A signal that mpirun passes on: all end after the step, and the checkpoint is there.
with_checkpoint() {
  rm -rf run && mkdir run
  "$mpirun" --oversubscribe --bind-to none -n 2 "$program" "${train[@]}" --steps 100000 --frames run/frames \
    --checkpoint run/state >run.out 2>run.err &
  local pid=$! status=0
  until [[ -e run/frames/frame_0001.png ]]; do
    kill -0 $pid 2>/dev/null || { complain "the run with a checkpoint failed: $(cat run.err)"; return; }
    sleep 0.1
  done
  kill -USR1 $pid
  wait $pid || status=$?
  [[ $status == 130 ]] || complain "status $status after USR1: $(cat run.err)"
  [[ -e run/state ]] || complain "no checkpoint after USR1"
  local next
  next=$(grep -ao '"next_step":[0-9]*' run/state | cut -d: -f2)
  [[ -e run/frames/frame_$(printf %04d $((next - 1))).png ]] || complain "the checkpoint is ahead of the frames"
  printf x | dd of=run/state bs=1 seek=300 conv=notrunc 2>/dev/null
  refused 1 'damaged' 2 "$program" "${train[@]}" --steps 100000 --frames run/frames --checkpoint run/state
}
with_checkpoint
# A process that cannot write its piece: no piece appears, not even that of the others.
mkdir full && mkdir full/in_1.vtp
refused 1 'in_1.vtp' 2 "$program" "${train[@]}" --steps 1 --out full/in.pvtp
[[ $(ls -A full) == in_1.vtp ]] || complain "left beside a piece that failed: $(ls -A full)"
ended KILL one
ended INT all
exit $bad
