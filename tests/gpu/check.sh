#!/usr/bin/env bash
# Nacre: everything that needs a GPU, in one command and under eight minutes.
#   check.sh --pack [DIR]   build for sm_90 into a folder that runs anywhere with a driver (default build/gpu-pack);
#                           with the viewer's libraries it holds the tests of buffers that CUDA shares with OpenGL, too
#   check.sh --run [DIR]    run what is in such a folder: needs bash, awk, tar, gzip and an NVIDIA driver, nothing else
#   check.sh                run the folder; where there is none, build it first
# Results (JSON, logs, pictures, results.txt) go to $OUT, else to build/gpu-results. Status: 0 all well, 1 something
# failed, 77 no CUDA device.
set -euo pipefail

here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd -P)
root=$(cd "$here/../.." && pwd -P)
architecture=${NACRE_GPU_ARCHITECTURE:-90}
march=${NACRE_MARCH:-x86-64-v3}  # the machine with the GPU need not have this one's processor
pack_limit_mib=44
seconds_limit=450

say() { printf 'check: %s\n' "$*"; }
fail() {
  printf 'check: %s\n' "$*" >&2
  exit 1
}

# ---- the half that builds ----

# Copies a program into FOLDER, and the libraries that it needs, those of the C library and the driver excepted.
pack_program() {
  local program=$1 folder=$2 library
  install -m 755 "$program" "$folder/bin/"
  strip "$folder/bin/$(basename "$program")"
  while read -r library; do
    case $(basename "$library") in
      libc.so* | libm.so* | libdl.so* | librt.so* | libpthread.so* | ld-linux* | libcuda.so*) ;;
      *) [[ -e $folder/lib/$(basename "$library") ]] || install -m 644 "$library" "$folder/lib/" ;;
    esac
  done < <(ldd "$program" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }')
  if ldd "$program" | grep -q 'not found'; then
    fail "$(basename "$program") needs a library that is not here"
  fi
}

pack() {
  local pack=$1 build=${NACRE_GPU_BUILD:-$root/build/gpu} name size
  local folder=$build/programs
  local programs=(nacre test_gpu test_bodies_cuda gpu_info gpu_floors)
  command -v cmake >/dev/null || fail "cmake is not installed: nothing to build with; bring a folder made by --pack"
  local options=(-DCMAKE_BUILD_TYPE=Release -DNACRE_CUDA=ON -DNACRE_VTK=OFF -DNACRE_MPI=OFF -DNACRE_TESTS=ON
    "-DNACRE_MARCH=$march"
    -DCMAKE_CXX_FLAGS=-Wno-psabi  # our 64-byte vectors never cross a call
    "-DCMAKE_CUDA_ARCHITECTURES=$architecture" "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=$build/bin")
  if nvcc --help 2>/dev/null | grep -q -- --compress-mode; then
    options+=(-DCMAKE_CUDA_FLAGS=--compress-mode=size)  # a third of the size
  fi
  command -v ninja >/dev/null && options+=(-G Ninja)
  command -v ccache >/dev/null && options+=(-DCMAKE_{CXX,CUDA}_COMPILER_LAUNCHER=ccache)
  cmake -S "$root" -B "$build" "${options[@]}"
  if [[ $(cmake --build "$build" --target help) == *test_interop* ]]; then
    programs+=(test_interop)
  else
    say "without the viewer's libraries: test_interop is left out"
  fi
  cmake --build "$build" --parallel "${NACRE_JOBS:-$(nproc)}" --target "${programs[@]}"
  rm -rf "$pack" "$folder"
  mkdir -p "$pack" "$folder/bin" "$folder/lib"
  for name in "${programs[@]}"; do
    pack_program "$build/bin/$name" "$folder"
  done
  tar -C "$folder" -czf "$pack/programs.tar.gz" bin lib
  install -m 755 "$here/check.sh" "$pack/run.sh"
  install -m 644 "$root/tests/bench/report.sh" "$pack/"
  size=$(du -sm "$pack" | cut -f 1)
  ((size < pack_limit_mib)) || fail "$pack has $size MiB, more than $pack_limit_mib"
  say "packed $size MiB into $pack"
}

# ---- the half that runs ----

failures=()

device_value() { report_value "$out/device.json" "$1"; }

left() { echo $((seconds_limit - SECONDS)); }

# flow_run NAME WORDS...: one nacre flow with its report NAME.json and picture NAME.png; NAME.log keeps what it said.
flow_run() {
  local name=$1
  shift
  timeout "$(left)" "$pack/bin/nacre" flow "$@" --quiet --size 1024x768 --image "$out/$name.png" \
    --report "$out/$name.json" >"$out/$name.log" 2>&1
}

device_info() {
  local status=0
  "$pack/bin/gpu_info" >"$out/device.json" 2>"$out/device.log" || status=$?
  if ((status == 77)); then
    say "no CUDA device: nothing was tested"
    exit 77
  fi
  ((status == 0)) || { cat "$out/device.log" >&2; fail "the device does not answer"; }
  say "$(device_value name), compute capability $(device_value compute_capability)"
}

# gtest_run PROGRAM NAME: its tests, with NAME.json and NAME.log; says what failed and what was skipped.
gtest_run() {
  local status=0
  timeout "$(left)" "$pack/bin/$1" --gtest_output="json:$out/$2.json" >"$out/$2.log" 2>&1 || status=$?
  grep -E '^CPU|FAILED|SKIPPED|tests ran|Failure' "$out/$2.log" || true
  ((status == 0)) || failures+=("$1 (status $status, see $2.log)")
}

unit_tests() {
  gtest_run test_gpu tests
  gtest_run test_bodies_cuda bodies
}

# Bodies with teams, scans and sorts under the sanitizer's three tools, half a minute each.
sanitizer_tests() {
  local tool status sanitizer filter='Team.*:Executor.*:Contrast.*:Tree.*:RefinedGrid.*:Distance.*'
  local time_up=([0]='' [124]=', then time was up') findings='^========= (Invalid|Error|Barrier|Program hit)'
  sanitizer=$(command -v compute-sanitizer || command -v /usr/local/cuda/bin/compute-sanitizer) || {
    say "compute-sanitizer is not installed: not run"
    return
  }
  for tool in memcheck racecheck synccheck; do
    status=0
    timeout 30 "$sanitizer" --tool "$tool" --error-exitcode 9 "$pack/bin/test_bodies_cuda" "--gtest_filter=$filter" \
      >"$out/$tool.log" 2>&1 || status=$?
    if [[ ! -v time_up[status] ]] || grep -qE "$findings" "$out/$tool.log"; then
      failures+=("$tool (status $status, see $tool.log)")
    else
      say "$tool: nothing found in $(grep -c '^\[       OK' "$out/$tool.log") tests${time_up[status]}"
    fi
  done
}

surface_cells() { report_value "$out/file-$1.json" embedding.surface_cells; }

# The program from file to picture, on both.
program_test() {
  local device data
  data=$(mktemp -d)
  "$pack/bin/nacre" sample torus --detail 70 --out "$data/torus.pvd" >/dev/null || failures+=("nacre sample torus")
  for device in cpu cuda; do
    flow_run "file-$device" "$data/torus.pvd" --device "$device" --resolution 512 --steps 20 ||
      failures+=("nacre flow torus.pvd --device $device: $(head -n 1 "$out/file-$device.log")")
  done
  if [[ $(report_value "$out/file-cuda.json" device.backend 2>/dev/null) != cuda ]]; then
    failures+=("--device cuda did not run on the device")
  elif [[ $(surface_cells cpu) != "$(surface_cells cuda)" ]]; then
    failures+=("torus.pvd has other surface cells on cuda than on cpu")
  fi
  rm -rf "$data"
}

# mesh_alike SAMPLE: the report of its mesh on cuda has as many particles (to 1%) and as good triangles (mean radius ratio
# to 0.005) as that on cpu.
mesh_alike() {
  local device key values=(-v name="$1")
  for device in cpu cuda; do
    for key in particles.final mesh.radius_ratio.mean; do
      values+=(-v "${device}_${key##*.}=$(report_value "$out/mesh-$1-$device.json" "$key")")
    done
  done
  awk "${values[@]}" '
    function size(x) { return x < 0 ? -x : x }
    BEGIN {
      printf "mesh of %s: %d particles and mean ratio %.4f on cpu, %d and %.4f on cuda\n",
        name, cpu_final, cpu_mean, cuda_final, cuda_mean
      exit !(cpu_final > 0 && size(cuda_final / cpu_final - 1) < 0.01 && size(cuda_mean - cpu_mean) < 0.005)
    }'
}

# Meshes from the program, on both.
mesh_test() {
  local device sample
  for sample in two-spheres three-sectors torso; do
    for device in cpu cuda; do
      timeout "$(left)" "$pack/bin/nacre" mesh --sample "$sample" --detail 64 --quiet --device "$device" \
        --out "$out/mesh.vtp" --report "$out/mesh-$sample-$device.json" >"$out/mesh-$sample-$device.log" 2>&1 ||
        failures+=("nacre mesh $sample --device $device: $(head -n 1 "$out/mesh-$sample-$device.log")")
    done
    mesh_alike "$sample" || failures+=("the mesh of $sample on cuda is not that on cpu")
  done
  rm -f "$out/mesh.vtp"
}

# Where the driver's OpenGL is there, CUDA must write straight into its buffers.
interop_test() {
  local vendor=/usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json
  if [[ ! -x $pack/bin/test_interop ]]; then
    say "interop: no viewer in this build"
    return
  fi
  if [[ -z ${__EGL_VENDOR_LIBRARY_FILENAMES:-} && -e $vendor ]]; then
    export __EGL_VENDOR_LIBRARY_FILENAMES=$vendor
  fi
  gtest_run test_interop interop
  grep '^drawn by' "$out/interop.log" | sort -u || true
  if [[ -n ${__EGL_VENDOR_LIBRARY_FILENAMES:-} ]] && ! grep -q 'OK .*WritesStraightIntoOpenGl' "$out/interop.log"; then
    failures+=("CUDA did not write straight into OpenGL (see interop.log)")
  fi
}

# bench_line NAME BACKEND RESOLUTION TTL: a line of the table and an element of results.json.
# Bytes: the fewest that a stage must move for each surface cell (each array once, whatever a cache may have to repeat):
# filter 44 (values, neighbour index, result), deposit 54 (sums, neighbour index, axes, value, clearing), advect
# 24 + 16 ttl (the particle's start; one 8-byte deposit a step, read and written).
bench_line() {
  local report="$out/$1.json" stage
  local values=(-v backend="$2" -v resolution="$3" -v ttl="$4" -v json="$out/runs.json"
    -v cells="$(report_value "$report" embedding.surface_cells)" -v copy="$(device_value copy_bytes_per_second)"
    -v step="$(report_value "$report" flow.seconds_per_step.median)"
    -v memory="$(report_value "$report" memory.device_peak_bytes)")
  for stage in embed refine advect deposit filter render; do
    values+=(-v "$stage=$(stage_seconds "$report" "$stage")" -v "${stage}_calls=$(stage_calls "$report" "$stage")")
  done
  awk "${values[@]}" '
    function per_call(seconds, calls) { return calls > 0 ? seconds / calls : 0 }
    function rate(bytes, seconds) { return seconds > 0 ? bytes * cells / seconds : 0 }
    function share(r) { return backend == "cuda" && copy > 0 ? sprintf("%.1f%%", 100 * r / copy) : "-" }
    function number(key, value) { return sprintf(", \"%s\": %.9g", key, value) }
    BEGIN {
      a = per_call(advect, advect_calls); d = per_call(deposit, deposit_calls); f = per_call(filter, filter_calls)
      ra = rate(24 + 16 * ttl, a); rd = rate(54, d); rf = rate(44, f)
      printf "%-6s %5d %3d %10d %8.3f %8.3f %9.2f %9.2f %9.2f %9.2f %8.3f %8.2f %6s %6s %6s\n", backend, resolution,
        ttl, cells, embed, refine, step * 1e3, a * 1e3, d * 1e3, f * 1e3, render, memory / 1e9, share(ra), share(rd),
        share(rf)
      printf "    {\"backend\": \"%s\"", backend >> json
      printf "%s%s%s", number("resolution", resolution), number("ttl", ttl), number("surface_cells", cells) >> json
      printf "%s%s", number("embed_seconds", embed), number("refine_seconds", refine) >> json
      printf "%s%s", number("step_seconds", step), number("render_seconds", render) >> json
      printf "%s%s%s", number("advect_seconds", a), number("deposit_seconds", d), number("filter_seconds", f) >> json
      printf "%s%s", number("advect_bytes_per_second", ra), number("deposit_bytes_per_second", rd) >> json
      printf "%s%s},\n", number("filter_bytes_per_second", rf), number("memory_bytes", memory) >> json
    }' </dev/null
}

# bench BACKEND STEPS RESOLUTION TTL
bench() {
  local name="train-$1-$3-ttl$4"
  if (($(left) < 20)); then
    say "$name left out: out of time"
  elif flow_run "$name" --sample train --device "$1" --resolution "$3" --ttl "$4" --steps "$2"; then
    bench_line "$name" "$1" "$3" "$4"
  elif [[ $1 == cpu ]] && (($(left) < 20)); then
    say "$name stopped: out of time"
  else
    failures+=("$name: $(head -n 1 "$out/$name.log")")
  fi
}

benchmarks() {
  local resolution ttl
  : >"$out/runs.json"
  echo "flow on the train: embed, refine, render in s; step and its parts in ms; memory in GB; the last three: the"
  echo "fewest bytes that advect, deposit and filter can move, over their time, as a share of this device's copy rate"
  printf '%-6s %5s %3s %10s %8s %8s %9s %9s %9s %9s %8s %8s %6s %6s %6s\n' device res ttl cells embed refine step \
    advect deposit filter render memory adv dep fil
  for resolution in 1024 2048 4096; do
    for ttl in 2 4; do bench cuda 10 "$resolution" "$ttl"; done
  done
  for resolution in 1024 2048 4096; do
    for ttl in 2 4; do bench cpu 3 "$resolution" "$ttl"; done
  done
}

# octree_bench BACKEND STEPS RESOLUTION: a line of the octree's table. Bytes: the fewest that a stage must move: embed 12
# for each cell written; velocity 16 for each cell; advect 16 + 16 ttl and filter 36 for each surface cell.
octree_bench() {
  local name="octree-$1-$3" report="$out/octree-$1-$3.json"
  if (($(left) < 20)); then
    say "$name left out: out of time"
  elif ! flow_run "$name" --sample train --method octree --device "$1" --resolution "$3" --ttl 2 --warmup 0 --steps "$2"; then
    failures+=("$name: $(head -n 1 "$out/$name.log")")
  else
    local stage values=(-v backend="$1" -v n="$3" -v copy="$(device_value copy_bytes_per_second)"
      -v cells="$(report_value "$report" embedding.cells)" -v surface="$(report_value "$report" embedding.surface_cells)"
      -v step="$(report_value "$report" flow.seconds_per_step.median)"
      -v memory="$(report_value "$report" memory.device_peak_bytes)")
    for stage in embed velocity advect filter; do
      values+=(-v "$stage=$(stage_seconds "$report" "$stage")" -v "${stage}_calls=$(stage_calls "$report" "$stage")")
    done
    awk "${values[@]}" '
      function share(bytes, seconds, calls) {
        return backend == "cuda" && copy > 0 && seconds > 0 ? sprintf("%.1f%%", 100 * bytes * calls / seconds / copy) : "-"
      }
      BEGIN {
        printf "%-6s %6d %11d %11d %9.3f %9.2f %8.2f %6s %6s %6s %6s\n", backend, n, cells, surface, embed, step * 1e3,
          memory / 1e9, share(12 * cells, embed, 1), share(16 * cells, velocity, velocity_calls),
          share(48 * surface, advect, advect_calls), share(36 * surface, filter, filter_calls)
      }' </dev/null
  fi
}

octree_benchmarks() {
  local resolution
  echo "octree flow on the train, ttl 2: build in s, step in ms, memory in GB; the last four: the fewest bytes that build,"
  echo "velocity, advect and filter can move, over their time, as a share of this device's copy rate"
  printf '%-6s %6s %11s %11s %9s %9s %8s %6s %6s %6s %6s\n' device N cells surface build step memory bld vel adv fil
  for resolution in 1024 2048 4096 8192; do octree_bench cuda 5 "$resolution"; done
  for resolution in 1024 2048; do octree_bench cpu 2 "$resolution"; done
  flow_run octree-largest --sample train --method octree --device cuda --resolution 1048576 || true
  say "largest N on this device: $(sed -n 's/.*use --resolution \([0-9]*\).*/\1/p' "$out/octree-largest.log")"
}

# floor NAME TARGET SECONDS: a line of the table and an element of results.json.
floor() {
  awk -v name="$1" -v target="$2" -v seconds="$3" -v json="$out/floors.json" '
    BEGIN {
      if (seconds == "" || seconds <= 0) {
        printf "%-38s %9.1f %9s %s\n", name, target * 1e3, "-", "not measured"
        exit
      }
      printf "%-38s %9.1f %9.3f %s\n", name, target * 1e3, seconds * 1e3,
        seconds <= target ? "reached" : sprintf("%.2f times the floor", seconds / target)
      printf "    {\"name\": \"%s\", \"target_seconds\": %.9g, \"seconds\": %.9g},\n", name, target, seconds >> json
    }' </dev/null
}

# What is to be aimed at on an H200. The band: the train at the resolution that gives it 66 million cells.
floors() {
  local resolution=6035 band="$out/octree-cuda-6035.json" times="$out/floor-times.json" build energy embed step
  timeout "$(left)" "$pack/bin/gpu_floors" cuda 2000000 >"$times" 2>"$out/floor-times.log" ||
    failures+=("gpu_floors: $(head -n 1 "$out/floor-times.log")")
  build=$(report_value "$times" tree_build_seconds)
  energy=$(report_value "$times" energy_pass_seconds)
  octree_bench cuda 5 "$resolution" >"$out/floor-band.log"
  if [[ -s $band ]]; then
    embed=$(stage_seconds "$band" embed)
    step=$(report_value "$band" flow.seconds_per_step.median)
    say "the band of the floors has $(report_value "$band" embedding.cells) cells"
  fi
  : >"$out/floors.json"
  printf '%-38s %9s %9s\n' 'floor (ms)' target value
  floor 'tree build of 2M particles' 0.0005 "$build"
  floor 'energy pass of 2M particles' 0.001 "$energy"
  floor 'band of 66M cells' 0.025 "${embed:-}"
  floor 'UFLIC step over that band' 0.025 "${step:-}"
}

# results.json: the device, the runs and what failed; the tests' own numbers are in tests.json.
write_results() {
  {
    printf '{\n  "device": '
    sed '2,$s/^/  /' "$out/device.json"
    printf '  ,\n  "runs": [\n'
    sed '$s/,$//' "$out/runs.json"
    printf '  ],\n  "floors": [\n'
    sed '$s/,$//' "$out/floors.json"
    printf '  ],\n  "failures": %d,\n  "seconds": %d\n}\n' "${#failures[@]}" "$SECONDS"
  } >"$out/results.json"
  rm "$out/runs.json" "$out/floors.json"
}

run() {
  [[ -s $1/programs.tar.gz ]] || fail "$1 holds no programs: make it with check.sh --pack"
  pack=$(mktemp -d)
  trap 'rm -rf "$pack"' EXIT
  tar -C "$pack" -xzf "$1/programs.tar.gz"
  out=${OUT:-$root/build/gpu-results}
  mkdir -p "$out"
  LD_LIBRARY_PATH=$pack/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  [[ -d /usr/local/nvidia/lib64 ]] && LD_LIBRARY_PATH+=:/usr/local/nvidia/lib64  # where containers find the driver
  export LD_LIBRARY_PATH
  source "$1/report.sh"
  exec > >(tee "$out/results.txt")
  device_info
  unit_tests
  program_test
  mesh_test
  interop_test
  sanitizer_tests
  floors
  benchmarks
  octree_benchmarks
  write_results
  local failure
  for failure in ${failures[@]+"${failures[@]}"}; do
    say "FAILED: $failure"
  done
  ((${#failures[@]} == 0)) || exit 1
  say "all good in $SECONDS s; results in $out"
}

[[ -s $here/programs.tar.gz ]] && root=$here && default=$here || default=$root/build/gpu-pack
case ${1:-} in
  --pack) pack "${2:-$root/build/gpu-pack}" ;;
  --run) run "${2:-$default}" ;;
  '')
    [[ -s $default/programs.tar.gz ]] || pack "$default"
    run "$default"
    ;;
  *) fail "no such option: $1 (--pack or --run)" ;;
esac
