# Nacre: how the bench scripts begin: their options, where reports go, which machine this is. To be sourced.
source "$(dirname "${BASH_SOURCE[0]}")/report.sh"

# begin_bench COMMAND BINARY [OPTIONS of nacre COMMAND...]: sets nacre, options, data and out ($OUT, or a folder that is
# removed at the end), failed=0. Exits 2 where BINARY is no program.
begin_bench() {
  local command=$1
  shift
  (($#)) || { echo "usage: $command.sh BINARY [options of nacre $command]" >&2; exit 2; }
  nacre=$1
  options=("${@:2}")
  [[ -x $nacre ]] || { echo "$command.sh: $nacre is not a program" >&2; exit 2; }
  data=${NACRE_DATA:-$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../../shared/data}
  failed=0
  if [[ -n ${OUT:-} ]]; then
    out=$OUT
    mkdir -p "$out"
  else
    out=$(mktemp -d)
    trap 'rm -rf "$out"' EXIT
  fi
}

# machine: one line.
machine() { echo "$(nproc) processors, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"; }

# main_runs: how large the four main runs are, divided by $NACRE_BENCH_SCALE: cells (flow), heart and torso (detail; the
# heart's own is 268).
main_runs() {
  local scale=${NACRE_BENCH_SCALE:-1}
  cells=$((1024 / scale)) heart=$((268 / scale)) torso=$((96 / scale))
}
