#!/usr/bin/env bash
# Nacre: checks that every link in README and docs leads to a file, and to a heading if it names one. Usage:
# check_links.sh [ROOT]. Lists every broken link; fails if there is one, or no link at all.
set -euo pipefail

root=$(cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}" && pwd)

# text PAGE: the page without its code blocks.
text() { awk '/^```/ { code = !code; next } !code' "$1"; }

# anchors PAGE: the anchor of each heading, as GitHub makes it: lower case, no punctuation, dashes for blanks.
anchors() {
  text "$1" | sed -nE 's/^#+ +(.*)$/\1/p' | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

count=0 bad=0
complain() {
  echo "$1"
  bad=1
}

while read -r page; do
  while read -r link; do
    [[ $link == http* ]] && continue
    count=$((count + 1))
    file=${link%%#*}
    target=$page
    [[ -z $file ]] || target=$(dirname "$page")/$file
    if [[ ! -e $target ]]; then
      complain "${page#"$root/"}: there is no $file"
    elif [[ $link == *#* ]] && ! grep -qxF -- "${link#*#}" <<<"$(anchors "$target")"; then
      complain "${page#"$root/"}: there is no heading for $link"
    fi
  done < <(text "$page" | grep -oE '\]\([^) ]+\)' | sed -E 's/^\]\((.*)\)$/\1/')
done < <(find "$root/README.md" "$root/docs" "$root/tests/peers" -name '*.md' | sort)
((count)) || { echo "no links found"; exit 1; }
((bad == 0)) || exit 1
echo "$count links lead somewhere"
