#!/usr/bin/env bash
# Nacre: the scripts of the flow's tables make a row of the train, at 256 cells, since coarser ones take longer to draw, that of
# the meshes one of the heart, which misses nothing that is asked.
# Usage: check_tables.sh PROGRAM.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=${1:?usage: check_tables.sh PROGRAM}
export NACRE_BENCH_RESOLUTIONS=256 NACRE_BENCH_STEPS=1 NACRE_BENCH_SAMPLES=train NACRE_BENCH_CASES=table
export NACRE_DATA=/nonexistent # the train alone
unset OUT

# check_row SCRIPT NUMBERS: its row of the train has as many numbers behind resolution and a number of cells above 0.
check_row() {
  local said
  said=$(bash "$here/$1" "$program" 2>&1) || { echo "$said"; echo "$1 failed"; exit 1; }
  grep -qE "^\| train \| 256 \| [1-9][0-9]* \|( [0-9.]+ \|){$2}\$" <<<"$said" ||
    { echo "$said"; echo "$1 has no whole row of the train"; exit 1; }
}

check_row flow.sh 6
check_row octree.sh 11
said=$(NACRE_BENCH_CASES=heart bash "$here/mesh.sh" "$program" 2>&1) || { echo "$said"; echo "mesh.sh failed"; exit 1; }
grep -qE '^\| heart \|( [0-9.]+ \|){17} yes \| [0-9.]+ \|$' <<<"$said" || { echo "$said"; echo "mesh.sh has no whole row"; exit 1; }
echo "all tables have their row"
