#!/usr/bin/env bash
# Nacre: registers, stack, spills and shared memory of every kernel of ours, as the table in docs/cuda-kernels.md.
# Usage: kernel_resources.sh [ARCH] prints it (default sm_90); needs nvcc and c++filt, no GPU, no build.
set -euo pipefail
arch=${1:-sm_90}
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."

nvcc=${CUDACXX:-$(command -v nvcc || echo "${CUDA_HOME:-/usr/local/cuda}/bin/nvcc")}
command -v "$nvcc" >/dev/null || { echo "kernel_resources: no nvcc; set CUDACXX" >&2; exit 1; }
toolkit=$(dirname "$(dirname "$(readlink -f "$(command -v "$nvcc")")")")
command=(-I. -isystem="$toolkit/include" -DNACRE_HAS_CUDA=1 -DNDEBUG -O3 -std=c++20 -arch="$arch" -Xptxas -v -cubin)
log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT

mapfile -t sources < <(find compute -name '*_cuda.cu' | sort)
for source in "${sources[@]}"; do
  "$nvcc" "${command[@]}" "$source" -o "$log/out.cubin" 2>"$log/says" || { cat "$log/says" >&2; exit 1; }
  c++filt <"$log/says" >>"$log/all"
done

printf 'Compiler: %s. ' "$("$nvcc" --version | sed -n 's/.*release \([0-9.]*\), V\(.*\)/nvcc \2/p')"
printf 'Command: `nvcc %s`, once for each `*_cuda.cu` of `compute/`.\n\n' "${command[*]/$toolkit/<toolkit>}"
echo '| kernel | registers | stack, bytes | spill stores, bytes | spill loads, bytes | shared, bytes |'
echo '|---|---:|---:|---:|---:|---:|'
# ptxas says three lines for a kernel: its name, its stack and spills, its registers and shared memory.
awk '
  /Compiling entry function/ {
    name = ""
    if (match($0, /for_each(_team)?_kernel<.*>\(nacre::Elements/)) {
      name = substr($0, RSTART, RLENGTH - 17)
      sub(/^for_each(_team)?_kernel</, "", name)
      gsub(/nacre::|detail::/, "", name)
      gsub(/ +>/, ">", name)
      sub(/ +$/, "", name)
    }
  }
  match($0, /[0-9]+ bytes stack.*/) {
    split(substr($0, RSTART), word, " ")
    stack = word[1]
    stores = word[5]
    loads = word[9]
  }
  /Used [0-9]+ registers/ && name != "" {
    match($0, /Used [0-9]+/)
    registers = substr($0, RSTART + 5, RLENGTH - 5)
    shared = match($0, /[0-9]+ bytes smem/) ? substr($0, RSTART, RLENGTH - 11) : 0
    printf "| %s | %d | %d | %d | %d | %d |\n", name, registers, stack, stores, loads, shared
  }' "$log/all" | sort -u
