#!/usr/bin/env bash
# Nacre: the scripts of the flow's tables make a row of the train, at 256 cells, since coarser ones take longer to draw, that of
# the meshes one of the heart, which misses nothing that is asked.
# Usage: check_tables.sh PROGRAM.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=${1:?usage: check_tables.sh PROGRAM}
export NACRE_BENCH_RESOLUTIONS=256 NACRE_BENCH_STEPS=1 NACRE_BENCH_SAMPLES=train
export NACRE_DATA=/nonexistent # the train alone
unset OUT

# check_row SCRIPT ROW: it ends well, and one of its lines is ROW, a regular expression.
check_row() {
  local said
  said=$(bash "$here/$1" "$program" 2>&1) || { echo "$said"; echo "$1 failed"; exit 1; }
  grep -qE "^$2\$" <<<"$said" || { echo "$said"; echo "$1 has no such row: $2"; exit 1; }
}

number='[0-9.]+ \|'
check_row flow.sh "\| train \| 256 \| [1-9][0-9]* \|( $number){6}"
NACRE_BENCH_CASES=table check_row octree.sh "\| train \| 256 \| [1-9][0-9]* \|( $number){11}"
NACRE_BENCH_CASES=heart check_row mesh.sh "\| heart \|( $number){17} yes \| $number"
echo "all tables have their row"
