#!/usr/bin/env bash
# Nacre: the same results on machines that are set up in other ways. Usage: machines.sh BINARY
# A small flow and a small mesh run under other locales (decimal commas, Turkish), with file names in UTF-8 and not, with
# 1 to 64 threads, 2 GB of memory, a home that cannot be written and no folder for temporary files: each has to give the
# bytes of the run on this machine as it is. What this machine does not have is skipped aloud.
set -euo pipefail

program=$(readlink -f "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0

offend() {
  echo "BAD $*"
  bad=1
}

"$program" sample sphere --detail 12 --out "$work/sphere.vtp" >/dev/null
"$program" sample two-spheres --detail 16 --out "$work/spheres.nrrd" >/dev/null
flow=(flow sphere.vtp --vectors @swirl --resolution 32 --steps 2 --size 64x48 --quiet --step-cells 3.5)
mesh=(mesh spheres.nrrd --iterations 3 --quiet --min-size 2.5 --max-size 4.5)
more=()

# make FOLDER [WRAPPER...]: both runs in that folder, the wrapper before the program.
make() {
  local folder=$1
  shift
  mkdir -p "$folder"
  cp "$work"/sphere.vtp "$work"/spheres.nrrd "$folder"
  (cd "$folder" && "$@" "$program" "${flow[@]}" "${more[@]}" --image image.png --out values.vtp >out.txt 2>err.txt) || return
  (cd "$folder" && "$@" "$program" "${mesh[@]}" "${more[@]}" --image mesh.png --out mesh.obj >>out.txt 2>>err.txt)
}

make "$work/usual"

# same LABEL [WRAPPER...]: the two runs give the usual bytes.
same() {
  local label=$1 folder=$work/other file status=0
  shift
  rm -rf "$folder"
  make "$folder" "$@" || status=$?
  if ((status != 0)); then
    offend "$label: status $status: $(tail -n 1 "$folder/err.txt")"
    return
  fi
  for file in image.png values.vtp mesh.png mesh.obj; do
    cmp -s "$work/usual/$file" "$folder/$file" || offend "$label: $file is not the same"
  done
  echo "$label: the same"
}

# Locales are compiled here if the machine has their sources: no change to the machine.
for locale in de_DE.UTF-8 tr_TR.UTF-8 fr_FR.ISO-8859-1; do
  if command -v localedef >/dev/null &&
    localedef -i "${locale%%.*}" -f "${locale#*.}" "$work/locales-$locale" >/dev/null 2>&1; then
    mkdir -p "$work/locpath"
    mv "$work/locales-$locale" "$work/locpath/$locale"
    same "locale $locale" env LOCPATH="$work/locpath" LC_ALL="$locale" LANG="$locale"
  else
    echo "skipped: the sources of the locale $locale are not here"
  fi
done
same "locale C" env LC_ALL=C
same "a locale that does not exist" env LC_ALL=xx_YY.UTF-8

for threads in 1 2 7 64; do
  more=(--threads "$threads")
  same "--threads $threads"
done
more=()

(ulimit -v 2097152 && make "$work/little") || offend "2 GiB of addresses: $(tail -n 1 "$work/little/err.txt")"

# Nobody can write there, not even root.
same "a home that cannot be written" env HOME=/proc XDG_CONFIG_HOME=/proc XDG_CACHE_HOME=/proc
same "no home" env -u HOME
same "no folder for temporary files" env TMPDIR=/nowhere
same "an empty environment" env -i

# File names: UTF-8, Latin-1 (no UTF-8), blanks, quotes, a line break, a hyphen at the front.
for name in $'\u00fcml\u00e4ut \u6df1' $'latin\xe9' ' two  blanks ' "quo'te\"s" $'line\nbreak' '%d {} ${x}'; do
  folder="$work/names/$name"
  mkdir -p "$folder"
  cp "$work/sphere.vtp" "$folder/$name.vtp"
  cp "$work/spheres.nrrd" "$folder/$name.nrrd"
  (cd "$folder" && "$program" flow "$name.vtp" "${flow[@]:2}" --image "$name.png" --out "$name-values.vtp" \
    --report "$name.json" >/dev/null) ||
    offend "the name '$name': flow fails"
  (cd "$folder" && "$program" mesh "$name.nrrd" "${mesh[@]:2}" --out "$name.obj" >/dev/null) ||
    offend "the name '$name': mesh fails"
  [[ -s $folder/$name.png && -s $folder/$name-values.vtp && -s $folder/$name.obj && -s $folder/$name.json ]] ||
    offend "the name '$name': a result is missing"
  grep -v '^#' "$folder/$name.obj" | cmp -s - <(grep -v '^#' "$work/usual/mesh.obj") ||
     offend "the name '$name': another mesh"
done
echo "names: done"
exit $bad
