#!/usr/bin/env bash
# Nacre: includes point downwards only. Usage: layers.sh [ROOT]; prints every include that does not, and fails.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

# Top folders, and the folders of compute and of engine/scene, from the highest to the lowest: a file includes its own and
# lower ones.
top_order=(app api engine compute include)
compute_order=(pipeline raycast transport topology flow particles meshing embedding field math device)
scene_order=(session samples volume surface settings)

# FOLDER:WORD... what a folder of the engine may not include, although it stands beside it.
engine_forbidden=(
  system:scene system:io system:picture
  scene:io scene:picture
  picture:io picture:scene
  io:picture
  system:run scene:run picture:run io:run gl:run interop:run render:run
  gl:scene gl:io gl:interop gl:render
  interop:scene interop:io interop:render
  render:scene render:io render:interop
)

# rank NAME ORDER...: the place of a name in an order, from 0; -1 where it is not in it.
rank() {
  local name=$1 place=0 each
  shift
  for each in "$@"; do
    [[ $each == "$name" ]] && echo $place && return
    place=$((place + 1))
  done
  echo -1
}

# order_complaint WHERE FROM TO ORDER...: the same for two folders of WHERE.
order_complaint() {
  local from_rank to_rank
  from_rank=$(rank "$2" "${@:4}")
  to_rank=$(rank "$3" "${@:4}")
  if ((from_rank < 0 || to_rank < 0)); then
    echo "has a folder of $1 without a place in its order (${*:4})"
  elif ((to_rank < from_rank)); then
    echo "points upwards in $1 (${*:4})"
  fi
}

# complaint FROM TO: why a file in folder FROM may not include one in folder TO; nothing where it may.
complaint() {
  local from=$1 to=$2 from_rank to_rank from_sub to_sub
  from_rank=$(rank "${from%%/*}" "${top_order[@]}")
  to_rank=$(rank "${to%%/*}" "${top_order[@]}")
  if ((to_rank < 0)); then
    echo "is not a path from the root of the repository"
  elif ((to_rank < from_rank)); then
    echo "points upwards (${top_order[*]})"
  elif [[ $from == compute/* && $to == compute/* ]]; then
    order_complaint compute "$(cut -d/ -f2 <<<"$from")" "$(cut -d/ -f2 <<<"$to")" "${compute_order[@]}"
  elif [[ $from == engine/scene/* && $to == engine/scene/* ]]; then
    order_complaint engine/scene "$(cut -d/ -f3 <<<"$from")" "$(cut -d/ -f3 <<<"$to")" "${scene_order[@]}"
  elif [[ $from == engine/* && $to == engine/* ]]; then
    from_sub=$(cut -d/ -f2 <<<"$from")
    to_sub=$(cut -d/ -f2 <<<"$to")
    if (($(rank "$from_sub:$to_sub" "${engine_forbidden[@]}") >= 0)); then
      echo "is forbidden: engine/$from_sub does not know engine/$to_sub"
    fi
  fi
}

# Each pair of folders is judged once: FILE:LINE:#include "PATH" becomes "FROM-FOLDER TO-FOLDER FILE PATH".
pairs=$(grep -rnsE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' app api engine compute \
  --include='*.hpp' --include='*.cpp' --include='*.cu' --include='*.cuh' --include='*.in' |
  sed -E 's/^([^:]+):[0-9]+:[^"]*"([^"]+)".*/\1 \2/' |
  awk '{ from = $1; to = $2; sub("/[^/]*$", "", from); if (!sub("/[^/]*$", "", to)) to = "."; print from, to, $1, $2 }') ||
  true

bad=0
declare -A verdict=()
while read -r from to file path; do
  [[ -n $from ]] || continue
  key="$from $to"
  [[ -v verdict[$key] ]] || verdict[$key]=$(complaint "$from" "$to")
  why=${verdict[$key]}
  if [[ -z $why && ! -e $path ]]; then
    why="does not exist"
  fi
  if [[ -n $why ]]; then
    echo "$file: include \"$path\" $why"
    bad=1
  fi
done <<<"$pairs"

# What users include knows nothing but itself and the standard library.
while IFS= read -r line; do
  echo "$line: a public header includes what is not installed"
  bad=1
done < <(grep -rnsE '^[[:space:]]*#[[:space:]]*include[[:space:]]*("[^"]*/|<[a-z]+/)' include || true)
exit $bad
