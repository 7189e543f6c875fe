# Nacre: the rows of the table of peers: collected, printed for people and as JSON. To be sourced; uses $out and $runs.

# value FILE KEY: what follows the word KEY at the start of a line, or nothing.
value() { awk -v key="$2" '$1 == key { sub(/^[^ ]+ /, ""); print; exit }' "$1"; }

# middle: the median of the numbers on stdin.
middle() { sort -g | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

# version NAME...: remembers a line about a peer.
version() { grep -qxF "$*" "$out/versions.txt" || echo "$*" >>"$out/versions.txt"; }

# row PEER WORK MEASURE OURS THEIRS: one line of the table.
row() {
  awk -v peer="$1" -v work="$2" -v measure="$3" -v a="$4" -v b="$5" 'BEGIN {
    ratio = (a == 0 || a == "" || b == "") ? "-" : sprintf("%.3g", b / a)
    printf "%s\t%s\t%s\t%.9g\t%.9g\t%s\n", peer, work, measure, a, b, ratio }' >>"$out/rows.tsv"
}

# print_table: everything so far. The ratio is theirs / ours. Shares get more digits: what matters is how far off 1 they are.
print_table() {
  echo "$(machine); medians of $runs pairs"
  sed 's/^/- /' "$out/versions.txt"
  echo
  echo '| peer | same work | measure | ours | theirs | theirs / ours |'
  echo '|---|---|---|---:|---:|---:|'
  awk -F'\t' '{
    format = ($3 ~ /^share/ && ($4 > 0.5 || $5 > 0.5)) ? "%.7g" : "%.4g"
    printf "| %s | %s | %s | " format " | " format " | %s |\n", $1, $2, $3, $4, $5, $6 }' "$out/rows.tsv"
}

# write_json: the same for programs.
write_json() {
  awk -F'\t' -v machine="$(machine)" -v date="$(date +%F)" -v runs="$runs" -v versions="$out/versions.txt" '
    BEGIN {
      printf "{\n  \"date\": \"%s\",\n  \"machine\": \"%s\",\n  \"pairs\": %d,\n  \"versions\": [", date, machine, runs
      while ((getline line < versions) > 0) printf "%s\"%s\"", (n++ ? ", " : ""), line
      printf "],\n  \"rows\": ["
    }
    { ratio = ($6 == "-") ? "null" : $6
      printf "%s\n    {\"peer\": \"%s\", \"work\": \"%s\", \"measure\": \"%s\", \"ours\": %s, \"theirs\": %s, \"ratio\": %s}",
        (NR > 1 ? "," : ""), $1, $2, $3, $4, $5, ratio }
    END { print "\n  ]\n}" }' "$out/rows.tsv"
}
