#!/usr/bin/env bash
# Nacre: the scripts of the flow's tables make a row of the train, at 256 cells, since coarser ones take longer to draw, that of
# the meshes one of the heart, which misses nothing that is asked; those of profiles and bounds look at all four runs, made small.
# Usage: check_tables.sh PROGRAM.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
program=${1:?usage: check_tables.sh PROGRAM}
export NACRE_BENCH_RESOLUTIONS=256 NACRE_BENCH_STEPS=1 NACRE_BENCH_SAMPLES=train
export NACRE_DATA=/nonexistent # the train alone
unset OUT

# check_rows SCRIPT ROW... [-- WORD]: with the word it ends well, and each ROW, a regular expression, is one of its lines.
check_rows() {
  local script=$1 said row rows=()
  shift
  while (($#)) && [[ $1 != -- ]]; do rows+=("$1"); shift; done
  said=$(bash "$here/$script" "$program" "${@:2}" 2>&1) || { echo "$said"; echo "$script failed"; exit 1; }
  for row in "${rows[@]}"; do
    grep -qE "^$row\$" <<<"$said" || { echo "$said"; echo "$script has no such row: $row"; exit 1; }
  done
}

number='[0-9.]+ \|'
check_rows flow.sh "\| train \| 256 \| [1-9][0-9]* \|( $number){6}"
NACRE_BENCH_CASES=table check_rows octree.sh "\| train \| 256 \| [1-9][0-9]* \|( $number){11}"
NACRE_BENCH_CASES=heart check_rows mesh.sh "\| heart \|( $number){2} [1-9][0-9]* \+ [1-9][0-9]* \|( $number){14} yes \| $number"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/ceilings" <<'CEILINGS'
#!/bin/sh
echo '{"copy_bytes_per_second": 1e10, "random_lines_per_second": 1e8, "vector_multiply_adds_per_second": 1e11,'
echo '"whole_additions_per_second": 1e10}'
CEILINGS
chmod +x "$work/ceilings"
export NACRE_BENCH_SCALE=4 NACRE_BENCH_SHARE=0 # small runs spend their time otherwise
check_rows bounds.sh "\| grid \| filter \| $number.* vectors, one by one \|" "\| octree \| filter \| $number.* one by one \|" \
  "\| single \| relax \| $number.* vectors, one by one \|" "\| multi \| relax \| $number.* vectors, one by one \|" \
  -- "$work/ceilings"
share=' *[0-9.]+%  '
check_rows profile.sh "== (grid|octree): nacre flow .*" "${share}advect" "== (single|multi): nacre mesh .*" "${share}relax" \
  "one processor for one cell or particle: [1-9][0-9]* ns \([1-9][0-9]*\) small, [1-9][0-9]* ns \([1-9][0-9]*\) large"
echo "all tables have their row"
