#!/usr/bin/env bash
# Nacre: shows that the tests on the emulated device notice what they are there for. Each mutation takes a barrier, a
# wait or an update away in a copy of one file, outside of the tree, and the tests that are named with it must fail.
# Usage: mutate.sh [BUILD [NAME]]; BUILD (default build/release) has built test_bodies_emulated; NAME: only mutations
# whose names hold it. Status 0: all were noticed. A quarter of an hour on two cores.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd -P)
build=$(cd "${1:-$root/build/release}" && pwd -P)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$build"

commands=$(ninja -t commands test_bodies_emulated)
link=$(grep -e '-o bin/test_bodies_emulated ' <<<"$commands")
only=${2:-}
missed=0
export NACRE_GRAPHS=strict  # a capture that fails is an error

# compile SOURCE: its command in the build, with the copies in $work/tree found first, into $work/SOURCE.o.
compile() {
  local command
  command=$(grep -e "-c [^ ]*/$1\$" <<<"$commands" | grep -m 1 -e nacre_emulated_runtime -e test_bodies_emulated)
  command=$(sed -E "s@ -o [^ ]+ @ -o $work/${1##*/}.o @; s@ -M[DTF]+( [^ ]+\\.[od])?@@g; s@ -I@ -I$work/tree -I@" \
    <<<"${command#*ccache }")
  eval "$command"
}

# mutant NAME BODY FILTER FILE FROM TO: FILE with FROM replaced by TO, once. BODY: whose tests FILTER must fail then;
# with FILE empty, they must pass.
mutant() {
  local name=$1 body=$2 filter=$3 file=$4 from=$5 to=$6 text objects program="$work/program" seed status=0
  [[ $name == *"$only"* ]] || return 0
  rm -rf "$work/tree" "$program"
  mkdir -p "$work/tree"
  if [[ -n $file ]]; then
    text=$(<"$root/$file")
    [[ $text == *"$from"* ]] || { echo "mutate: $name: $file has changed; say again what to replace" >&2; exit 2; }
    mkdir -p "$work/tree/${file%/*}"
    printf '%s\n' "${text/"$from"/"$to"}" >"$work/tree/$file"
  fi
  compile "bodies/${body}_body.cpp"
  objects=$(tr ' ' '\n' <<<"$link" | grep -e '\.o$' | grep -v /bodies/)
  if [[ $file == *.cpp ]]; then  # in place of the runtime's own
    sed -i "s@#include \"$file\"@@" "$work/tree/$file"
    cp "$work/tree/$file" "$work/${file##*/}"
    compile_copy "$file"
    objects=$(grep -v "/${file##*/}.o\$" <<<"$objects")$'\n'"$work/${file##*/}.o"
  fi
  # shellcheck disable=SC2046
  eval "c++ $(tr ' ' '\n' <<<"$link" | grep -E '^-(fsanitize|g)' | tr '\n' ' ') -o $program $work/${body}_body.cpp.o" \
    $(tr '\n' ' ' <<<"$objects") $(tr ' ' '\n' <<<"$link" | grep -E '\.(a|so[0-9.]*)$|^-l' | tr '\n' ' ')
  for seed in 1 2 3; do
    # In a shell of its own, which says that the program was aborted in the log, not to the user.
    (
      export NACRE_EMULATED_SEED=$seed NACRE_EMULATED_SCREEN=$((seed == 3))  # then launches come in parts
      timeout 900 "$program" "--gtest_filter=$filter"
      exit $?
    ) >"$work/log" 2>&1 || status=$?
    ((status == 0)) || break
  done
  if [[ -z $file ]]; then
    ((status == 0)) && echo "unchanged: passes" || { echo "unchanged: FAILS"; tail -n 5 "$work/log"; missed=1; }
  elif ((status == 0 || status == 124)); then
    echo "$name: MISSED$( ((status == 0)) || echo ', out of time')"
    missed=1
  else
    echo "$name: noticed, seed $seed: $(grep -m 1 -e '^emulated device' -e '^\[  FAILED' -e 'Failure' "$work/log" |
      cut -c 1-100 || echo "status $status")"
  fi
}

# The command of a source of the device, for its copy.
compile_copy() {
  local command
  command=$(grep -e "-c [^ ]*/$1\$" <<<"$commands" | grep -m 1 -e nacre_emulated_runtime)
  command=$(sed -E \
    -e "s@ -o [^ ]+ @ -o $work/${1##*/}.o @; s@ -M[DTF]+( [^ ]+\\.[od])?@@g; s@ -c [^ ]+@ -c $work/tree/$1@" \
    <<<"${command#*ccache }")
  eval "$command"
}

few='Redblack.EnergyFalls*:Redblack.AFixedRim*:Redblack.CurvesAre*'  # others take longer and show no more
launch=compute/device/cuda_lanes.cuh team=compute/device/team.hpp
mutant unchanged team '*' '' '' ''
mutant "no barrier after Team::each" team '*' $team \
  $'body(k);\n    __syncthreads();' 'body(k);'
mutant "no barrier before the sums of Team::sum" team '*' $team \
  $'partial[threadIdx.x] = mine;\n    __syncthreads();' 'partial[threadIdx.x] = mine;'
mutant "no barrier between the sums of Team::sum" team '*' $team \
  $'partial[threadIdx.x + half];\n      __syncthreads();' 'partial[threadIdx.x + half];'
mutant "a barrier for half of the team" team '*' $launch \
  '__syncthreads();  // the next' 'if (threadIdx.x < 32) __syncthreads();  // the next'
mutant "no barrier between the votes of two warps" redblack "$few" compute/particles/neighbourhoods.hpp \
  $'both[lane / 32] = votes;\n  __syncthreads();' 'both[lane / 32] = votes;'
mutant "a download that does not wait" executor '*' compute/device/cuda_device.cpp \
  'cuda_check(cudaStreamSynchronize(stream_), "copy from the device");' ''
mutant "a graph with the pointers of the call before" executor '*' compute/device/cuda_graph.hpp \
  'const cudaError_t status = cudaGraphExecUpdate(executable_, graph, &info);' \
  'const cudaError_t status = executable_ && graph && !info.result ? cudaSuccess : cudaErrorGraphExecUpdateFailure;'
mutant "a wait inside of a capture" executor '*' compute/device/executor_cuda.cuh \
  'launch_elements(blocks, threads, stream_, {first, end}, kernel);' \
  'launch_elements(blocks, threads, stream_, {first, end}, kernel); cudaStreamSynchronize(stream_);'
mutant "a launch in parts that begins at 0 each time" executor '*' $launch \
  'i = all.first + std::int64_t(blockIdx.x) * blockDim.x' 'i = std::int64_t(blockIdx.x) * blockDim.x'
# $loose: Team::each without its barrier.
loose='const auto loose = [](int n, const auto& body) { for (int k = threadIdx.x; k < n; k += Team::lanes) body(k); };'
mutant "no barrier before local moments are used" contrast '*' compute/flow/filter.hpp \
  'team.each(27, [&](int k) { near[k]' "$loose loose(27, [&](int k) { near[k]"
mutant "streaks of values that neighbours write" streaks '*' compute/flow/streaks.hpp \
  'const StreakCells<Wide> cell = load_streak_cells(cells, at, line.runs);' \
  'const_cast<StreakCell*>(cells)[at].value += 1; const StreakCells<Wide> cell = load_streak_cells(cells, at, line.runs);'
mutant "bounds of distances used before all lanes have lowered them" brick_octree '*' \
  compute/embedding/closest_in_brick.hpp \
  $'    team.each(count, [&](int k) {\n      Eight squared;\n      const auto slack' \
  "$loose"$'    loose(count, [&](int k) {\n      Eight squared;\n      const auto slack'
mutant "no barrier behind a candidate of the tree" tree '*' compute/particles/tree_forces.hpp \
  $'++count;\n          team.wait();' '++count;'
mutant "no barrier between two axes of a Gaussian" tighten '*' compute/field/tighten.hpp \
  $'team.each(wide * wide, [&](int line) {\n        const float* from' \
  "$loose"$'loose(wide * wide, [&](int line) {\n        const float* from'
mutant "no barrier behind the move of a particle" redblack "$few" compute/particles/redblack.hpp \
  $'    team.wait();\n  }\n};\n\n}  // namespace detail\n\n/// One turn' \
  $'  }\n};\n\n}  // namespace detail\n\n/// One turn'
mutant "no barrier behind sizes beside a tile" sizing '*' compute/field/size_slope.hpp \
  'team.each(6 * n * n, [&](int i) {' "$loose"'loose(6 * n * n, [&](int i) {'
exit $missed
