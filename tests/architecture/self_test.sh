#!/usr/bin/env bash
# Nacre: the architecture checks themselves: silent on a good tree, and each breach is named.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

plant() { # plant FILE LINE...
  mkdir -p "$tree/$(dirname "$1")"
  printf '%s\n' '// Nacre: a plant.' '#pragma once' "${@:2}" >"$tree/$1"
}

# expect SCRIPT WORDS: the script fails on the tree, and says so in these words.
expect() {
  local said
  if said=$(bash "$here/$1" "$tree"); then
    echo "$1 found nothing, and should have said: $2"
    exit 1
  fi
  [[ $said == *"$2"* ]] || {
    printf '%s said:\n%s\nand not: %s\n' "$1" "$said" "$2"
    exit 1
  }
}

expect_silence() {
  bash "$here/$1" "$tree" || {
    echo "$1 complained about a good tree"
    exit 1
  }
}

good_tree() {
  rm -rf "${tree:?}"/*
  plant compute/device/a.hpp '#include <vector>'
  plant compute/math/b.hpp '#include "compute/device/a.hpp"'
  plant engine/scene/c.hpp '#include "compute/math/b.hpp"'
  plant engine/io/d.cpp '#include "engine/scene/c.hpp"'
  plant app/main.cpp '#include "engine/io/e.hpp"' '#include "compute/math/b.hpp"'
  plant engine/io/e.hpp
}

good_tree
expect_silence layers.sh
expect_silence habits.sh
plant engine/io/one.hpp 'namespace nacre {' 'struct Segment {' '};' 'class Other;' 'class Other::Part : Base {' '};' '}  // namespace nacre'
plant engine/io/own.cpp 'namespace nacre {' 'namespace {' 'struct Segment {' '};' '}  // namespace' '}  // namespace nacre'
plant engine/io/apart.hpp 'namespace nacre::dicom {' 'struct Segment {' '};' '}  // namespace nacre::dicom'
expect_silence one_definition.sh
plant compute/math/two.hpp 'namespace nacre {' 'template <class T> struct Segment : Base {' '};' '}  // namespace nacre'
expect one_definition.sh 'nacre::Segment is defined in compute/math/two.hpp and in engine/io/one.hpp'
good_tree

plant compute/math/up.hpp '#include "engine/scene/c.hpp"'
expect layers.sh 'compute/math/up.hpp: include "engine/scene/c.hpp" points upwards'
good_tree
plant compute/device/up.hpp '  #  include "compute/math/b.hpp"'
expect layers.sh 'points upwards in compute'
good_tree
plant engine/scene/samples/f.hpp
plant engine/scene/settings/up.hpp '#include "engine/scene/samples/f.hpp"'
expect layers.sh 'points upwards in engine/scene'
good_tree
plant engine/picture/side.hpp '#include "engine/scene/c.hpp"'
expect layers.sh 'engine/picture does not know engine/scene'
good_tree
plant engine/system/up.hpp '#include "engine/io/e.hpp"'
expect layers.sh 'engine/system does not know engine/io'
good_tree
plant engine/scene/relative.hpp '#include "c.hpp"'
expect layers.sh 'is not a path from the root'
good_tree
plant app/lost.cpp '#include "engine/io/lost.hpp"'
expect layers.sh 'does not exist'
good_tree
plant api/g.hpp '#include "engine/io/e.hpp"'
expect_silence layers.sh
plant engine/io/up.hpp '#include "api/g.hpp"'
expect layers.sh 'engine/io/up.hpp: include "api/g.hpp" points upwards'
good_tree
plant include/nacre/h.hpp '#include "compute/math/b.hpp"'
expect layers.sh 'a public header includes what is not installed'
good_tree
plant compute/other/new.hpp '#include "compute/device/a.hpp"'
expect layers.sh 'without a place in its order'

good_tree
plant compute/math/long.cu {1..20}
expect habits.sh 'compute/math/long.cu: 22 lines'
good_tree
plant compute/math/long.hpp {1..500}
expect habits.sh 'compute/math/long.hpp: 502 lines'
good_tree
plant compute/math/wide.hpp "// $(printf 'é%.0s' {1..117})" "// $(printf 'é%.0s' {1..118})"
expect habits.sh 'compute/math/wide.hpp:4: longer than 120 characters'
if bash "$here/habits.sh" "$tree" | grep -q 'wide.hpp:3'; then
  echo "habits.sh takes bytes for characters"
  exit 1
fi
good_tree
plant app/later.cpp "// TO""DO: everything"
expect habits.sh 'app/later.cpp:3'
good_tree
echo 'int x;' >"$tree/app/bare.hpp"
expect habits.sh 'app/bare.hpp: the first line'
expect habits.sh 'app/bare.hpp: no #pragma once'
