#!/usr/bin/env bash
# Nacre: checks the words of every `nacre` command in README and docs, also of those that are too long to run in a test
# (indented, or within a line): command, options and knobs of --set must be there, and scripts of tests/ that are named.
# Usage: check_options.sh PROGRAM [ROOT]. Lists every offender; fails where there is one, or no command at all.
set -euo pipefail

program=$(readlink -f "${1:?usage: check_options.sh PROGRAM [ROOT]}")
root=$(cd "${2:-$(dirname "${BASH_SOURCE[0]}")/../..}" && pwd)
[[ -x $program ]] || { echo "no program at $program"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" --help >"$work/help"
"$program" --knobs | awk 'NR > 1 { print $1 }' >"$work/knobs"

# commands PAGE: one a line: lines that begin with nacre (fenced or indented, with the lines that they go on in), and
# what stands in backquotes. Comments are left out.
commands() {
  sed -e ':a' -e '/\\$/N; s/\\\n */ /; ta' "$1" | sed -nE 's/^ *(PATH=[^ ]+ )?(nacre [a-z].*)$/\2/p' | sed 's/ #.*//'
  grep -oE '`nacre [a-z][^`]*`' "$1" | tr -d '`'
}

# options COMMAND: what its help lists, one a line; nothing where there is no such command.
options() {
  grep -qE "^ +$1 " "$work/help" || return 0
  [[ -e $work/$1.options ]] ||
    "$program" "$1" --help | sed -nE 's/^ +(-[^ ]*).*/\1/p' | grep -oE -- '--?[a-z][a-z0-9-]*' >"$work/$1.options"
  cat "$work/$1.options"
}

bad=0
complain() {
  echo "$1"
  bad=1
}

# check_line PAGE LINE...: the words of one command.
check_line() {
  local page=$1 command=$3 line="${*:2}" word before=
  if [[ -z $(options "$command") ]]; then
    [[ $command == view ]] && return  # a build without the viewer
    complain "$page: there is no command: $line"
    return
  fi
  for word in "${@:4}"; do
    if [[ $word =~ ^--?[a-z] ]]; then
      options "$command" | grep -qxF -- "${word%%=*}" || complain "$page: nacre $command has no ${word%%=*}: $line"
    elif [[ $before == --set ]]; then
      word=${word//-/_}
      grep -qxF -- "${word%%=*}" "$work/knobs" || complain "$page: there is no knob ${word%%=*}: $line"
    fi
    before=$word
  done
}

count=0
for page in "$root/README.md" "$root"/docs/*.md "$root"/docs/method/*.md "$root"/docs/performance/*.md; do
  while read -r line; do
    read -ra words <<<"$line"
    check_line "${page#"$root/"}" "${words[@]}"
    count=$((count + 1))
  done < <(commands "$page")
  while read -r script; do
    [[ -f $root/$script ]] || complain "${page#"$root/"}: there is no $script"
  done < <(grep -oE '\btests/[a-z_/]+\.(sh|py)\b' "$page" | sort -u)
done
((count)) || { echo "no commands found"; exit 1; }
((bad == 0)) || exit 1
echo "$count commands: every option is there"
