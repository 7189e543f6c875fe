#!/usr/bin/env bash
# Nacre: the habits a reader counts on, file by file. Usage: habits.sh [ROOT]; prints every breach, and fails.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

max_lines=450    # a file is one idea
max_width=120    # characters of a line of C++ or CUDA
max_cu_lines=15  # a .cu file only instantiates what a header says

bad=0
breach() {
  echo "$*"
  bad=1
}

folders=()
for folder in app api engine compute include examples python tests shaders third_party; do
  [[ -d $folder ]] && folders+=("$folder")
done
mapfile -t files < <(find "${folders[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \
  -o -name '*.sh' -o -name '*.cmake' -o -name CMakeLists.txt \) | sort)

for file in "${files[@]}"; do
  lines=$(wc -l <"$file")
  ((lines <= max_lines)) || breach "$file: $lines lines, more than $max_lines"
  case $file in
    *.cu) ((lines <= max_cu_lines)) || breach "$file: $lines lines, more than $max_cu_lines for a file that instantiates" ;;
  esac
  case $file in
    *.hpp | *.cpp | *.cu | *.cuh)
      IFS= read -r first <"$file" || true
      [[ $first == '// Nacre: '* ]] || breach "$file: the first line does not begin with '// Nacre: '"
      ;;
  esac
  case $file in
    *.hpp | *.cuh) grep -q '^#pragma once' "$file" || breach "$file: no #pragma once" ;;
  esac
  [[ $file =~ ^[A-Za-z0-9_./-]+$ ]] || breach "$file: a name with odd characters"
done

mapfile -t code < <(printf '%s\n' "${files[@]}" | grep -E '\.(hpp|cpp|cu|cuh)$')
while IFS=: read -r file number _; do
  breach "$file:$number: longer than $max_width characters"
done < <(LC_ALL=C.UTF-8 grep -nE "^.{$((max_width + 1)),}" "${code[@]}" /dev/null || true)

# The words are put together here, so that this file does not hold them.
while IFS= read -r line; do
  breach "$line"
done < <(grep -nwE "TO""DO|FIX""ME|XX""X" "${files[@]}" /dev/null || true)
exit $bad
