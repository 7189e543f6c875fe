#!/usr/bin/env bash
# Nacre: builds the library without the program, installs it into an empty folder, builds examples/ against it by
# find_package (or with Nacre as a subfolder), and runs them.
# Usage: run.sh static|shared|subfolder NACRE WORK CMAKE GENERATOR OPTION...
# With the options of the program's build, and files named relative to the build, ccache need not compile the library again.
set -euo pipefail
kind=$1 nacre=$2 work=$3 cmake=$4 generator=$5
options=(-G "$generator" -DCMAKE_BUILD_TYPE=Release -DNACRE_PROGRAM=OFF -DNACRE_TESTS=OFF -DNACRE_CUDA=OFF "${@:6}")
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
fail() {
  echo "$*"
  exit 1
}

[[ $kind == subfolder ]] && build=examples || build=build
export CCACHE_BASEDIR="$work/$build"
mkdir -p "$work"
rm -rf "$work/prefix" "$work/examples/CMakeCache.txt" "$work/out"
mkdir -p "$work/out"
if [[ $kind == subfolder ]]; then
  "$cmake" -S "$nacre/examples" -B "$work/examples" "${options[@]}" "-DNACRE_FOLDER=$nacre" \
    >"$work/configure.log"
  # Nothing that only the program needs may be asked for.
  if grep -E 'CLI11|pugixml|teem|nifti|tinyobj|ffmpeg|GLFW|GLEW|VTK' "$work/configure.log"; then
    fail "the library asks for the packages above, which only the program needs"
  fi
else
  [[ $kind == shared ]] && shared=ON || shared=OFF
  "$cmake" -S "$nacre" -B "$work/build" "${options[@]}" -DBUILD_SHARED_LIBS=$shared
  "$cmake" --build "$work/build" -j "$(nproc)" --target nacre_installed
  "$cmake" --install "$work/build" --prefix "$work/prefix" --component library
  "$cmake" -S "$nacre/examples" -B "$work/examples" -G "$generator" -DCMAKE_BUILD_TYPE=Release \
    "-DCMAKE_PREFIX_PATH=$work/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
fi
"$cmake" --build "$work/examples" -j "$(nproc)"

if [[ $kind == shared ]]; then  # only what include/nacre declares
  library=$(echo "$work"/prefix/lib*/*/libnacre.so "$work"/prefix/lib*/libnacre.so | tr ' ' '\n' | grep -v '\*' | head -1)
  shown=$(nm -DC --defined-only "$library" | grep -c ' T nacre::') || true
  ((shown > 20)) || fail "$library shows $shown functions of the library"
  if nm -DC --defined-only "$library" | grep -E ' T nacre::(make_mesh_pipeline|set_knob|write_vtp)'; then
    fail "$library shows the functions above, which are its own"
  fi
fi

cd "$work/out"
"$work/examples/labels_to_mesh" balls.vtp balls.vtu | tee said
grep -q ' sound$' said || fail "the mesh of labels_to_mesh is not sound"
"$work/examples/flow_to_pictures" torus | tee said
[[ $(ls torus*.png | wc -l) == 4 ]] || fail "flow_to_pictures made other pictures"
if [[ -x $work/examples/flow_by_mpi ]] && command -v mpirun >/dev/null; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  for n in 1 3; do
    mpirun --oversubscribe -n $n "$work/examples/flow_by_mpi" "sheet-$n-" || fail "flow_by_mpi on $n processes"
  done
  cmp sheet-1-3.png sheet-3-3.png || fail "flow_by_mpi draws another picture on 3 processes"
fi
"$work/examples/heat_in_labels" || fail "heat_in_labels is off"
