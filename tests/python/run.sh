#!/usr/bin/env bash
# Nacre: makes an environment, installs the module there with pip, and runs pytest against the program.
# Usage: run.sh NACRE WORK PROGRAM MARCH WERROR [PYTEST ARGUMENTS]. Ends with 77 where PyPI cannot be reached.
set -euo pipefail
nacre=$1 work=$2 program=$3 march=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=${PYTHON:-python3}
skip() {
  echo "skipped: $*"
  exit 77
}

"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' || skip "Python 3.10 or later is needed"
mkdir -p "$work"
[[ -x $work/venv/bin/pip ]] || "$python" -m venv "$work/venv" || skip "no venv; apt-get install python3-venv"
pip=("$work/venv/bin/pip" --disable-pip-version-check -q)
if ! cmp -s "$here/requirements.txt" "$work/installed.txt"; then
  "${pip[@]}" install -r "$here/requirements.txt" || skip "the packages of requirements.txt cannot be had from PyPI"
  cp "$here/requirements.txt" "$work/installed.txt"
fi

if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
export CCACHE_BASEDIR="$work/build"
export CC=${CC:-cc} CXX=${CXX:-c++}  # as CMake calls them by itself: by another name, ccache knows nothing of them
# Compiled for the same processor as the program: only then are results equal to the byte. With the same options, ccache
# need not compile the library again.
PATH="$work/venv/bin:$PATH" "${pip[@]}" install "$nacre" --no-build-isolation --no-deps --force-reinstall \
  -C "build-dir=$work/build" -C "cmake.define.NACRE_MARCH=$march" \
  -C "cmake.define.NACRE_WERROR=$5" -C "cmake.define.NACRE_CUDA=OFF"
cd "$work"
NACRE_PROGRAM="$program" NACRE_FOLDER="$nacre" "$work/venv/bin/python" -m pytest -q "$here" -p no:cacheprovider "${@:6}"
