#!/usr/bin/env bash
# Nacre: one type for each name. Usage: one_definition.sh [ROOT]; prints every name that two files define, and fails.
# Two types of one name in one program break C++'s rule of one definition, and no linker says so: it keeps one copy of
# what is inline, such as the growth of a vector, for both. Types in unnamed namespaces and within others are free.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

folders=()
for folder in app api engine compute include python; do
  [[ -d $folder ]] && folders+=("$folder")
done
said=$(find "${folders[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.cu' -o -name '*.cuh' \) -print0 |
  sort -z | xargs -0 awk '
    FNR == 1 { depth = 0 }
    /^namespace [A-Za-z_:]+ \{/ { space[++depth] = $2 "::" }
    /^namespace \{/ { space[++depth] = "unnamed" }
    /^\}  \/\/ namespace/ { --depth }
    /^(template .*> )?(struct|class|enum|enum class|union) / && !/;$/ {
      declared = $0
      sub(/^template .*> /, "", declared)
      sub(/^(struct|class|enum class|enum|union) (alignas\([^)]*\) )?/, "", declared)
      match(declared, /^[A-Za-z_0-9]+/)
      name = substr(declared, 1, RLENGTH)
      if (substr(declared, RLENGTH + 1) !~ /^( final)?( :[^:]| \{|$)/) next
      for (i = depth; i > 0; --i) name = space[i] name
      if (name ~ /unnamed/) next
      if (name in file && file[name] != FILENAME) print name " is defined in " file[name] " and in " FILENAME
      file[name] = FILENAME
    }')
[[ -z $said ]] || {
  echo "$said"
  exit 1
}
