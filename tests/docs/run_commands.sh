#!/usr/bin/env bash
# Nacre: runs every command that the README, the guide, the page of figures and the viewer's page show. Usage: run_commands.sh PROGRAM [ROOT];
# the fenced ```sh blocks of each page run in order, as one script, in an empty folder, where `nacre` is PROGRAM. Blocks
# that begin with ./dev are the repository's own commands and are only checked to exist. Fails at the first command that
# fails, and where a page has no command.
set -euo pipefail

program=$(readlink -f "${1:?usage: run_commands.sh PROGRAM [ROOT]}")
root=$(cd "${2:-$(dirname "${BASH_SOURCE[0]}")/../..}" && pwd)
limit=${NACRE_DOCS_SECONDS:-1800}  # for one page
keep=${NACRE_DOCS_KEEP:-}         # a folder for what the commands write, such as the pictures of the guide
[[ -x $program ]] || { echo "no program at $program"; exit 1; }
[[ -z $keep ]] || keep=$(realpath -m "$keep")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$program" "$work/bin/nacre"

# commands PAGE: the lines of its ```sh blocks.
commands() { awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$1"; }

# Files that the commands of SCRIPT name with --image, --out and the like: they must be there afterwards.
expected_files() {
  grep -oE -- '--(image|video|out|report|frames|record|save-session|save-recording) [^ ]+' "$1" | cut -d' ' -f2 | sort -u || true
}

run_page() {
  local page=$1 folder script word
  folder="$work/$(basename "$page" .md)"
  script="$folder.sh"
  mkdir "$folder"
  for word in $(commands "$page" | sed -nE 's|^\./dev ([a-z]+).*|\1|p'); do
    grep -qE "^ *($word|.*\| $word)\)|^ *$word \|" "$root/dev" || { echo "$page: ./dev has no command $word"; return 1; }
  done
  commands "$page" | grep -v '^\./dev ' >"$script" || true
  if ! command -v ffmpeg >/dev/null && grep -q -- '--video' "$script"; then
    echo "$page: commands with --video are skipped, there is no ffmpeg"
    sed -i '/--video/d' "$script"
  fi
  [[ -n $(commands "$page") ]] || { echo "$page: no commands"; return 1; }
  (cd "$folder" && PATH="$work/bin:$PATH" timeout "$limit" bash -exo pipefail "$script") || {
    echo "$page: a command failed; the last line with + is the one"
    return 1
  }
  while read -r file; do
    [[ -z $file || -s $folder/$file ]] || { echo "$page: $file was not written"; return 1; }
  done < <(expected_files "$script")
}

pages=("$root/README.md" "$root/docs/guide.md" "$root/docs/performance.md")
if "$program" view --offscreen --sample sphere --detail 24 --resolution 32 --frames-count 1 --quiet 2>/dev/null; then
  pages+=("$root/docs/viewer.md")
else
  echo "docs/viewer.md is skipped: the viewer does not run here"
fi
for page in "${pages[@]}"; do
  echo "== ${page#"$root/"}"
  run_page "$page"
done
if [[ -n $keep ]]; then
  mkdir -p "$keep"
  cp -r "$work/README" "$work/guide" "$keep"
fi
echo "all commands ran"
