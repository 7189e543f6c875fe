# Nacre: numbers out of the JSON reports of nacre, for scripts that have awk and nothing else. To be sourced.

# report_value FILE KEY.KEY..: the value at a path of objects (indented JSON, as nacre writes it), or nothing.
report_value() {
  awk -v path="$2" '
    BEGIN { depth = split(path, key, "."); at = 0 }
    match($0, /^ *"[^"]*": /) {
      level = (match($0, /"/) - 1) / 2
      name = substr($0, RSTART + 1); sub(/".*/, "", name)
      if (level <= at) at = level - 1
      if (level == at + 1 && name == key[level]) {
        at = level
        if (at == depth) { sub(/^[^:]*: /, ""); sub(/,$/, ""); gsub(/"/, ""); print; exit }
      }
    }' "$1"
}

# stage_seconds FILE STAGE: wall time of a stage, or nothing.
stage_seconds() {
  awk -v stage="\"$2\"" '
    /{ *$/ { name = ""; seconds = "" }
    /^ *"name": / { name = $2; sub(/,$/, "", name) }
    /^ *"seconds": / { seconds = $2; sub(/,$/, "", seconds) }
    name == stage && seconds != "" { print seconds; exit }' "$1"
}

# stage_calls FILE STAGE: how often it ran, or nothing.
stage_calls() {
  awk -v stage="\"$2\"" '
    /{ *$/ { name = ""; calls = "" }
    /^ *"name": / { name = $2; sub(/,$/, "", name) }
    /^ *"calls": / { calls = $2; sub(/,$/, "", calls) }
    name == stage && calls != "" { print calls; exit }' "$1"
}

# report_list FILE KEY.KEY..: the numbers of a list, one per line.
report_list() {
  awk -v path="$2" '
    BEGIN { depth = split(path, key, "."); at = 0 }
    within { if (/]/) exit; gsub(/[ ,]/, ""); print; next }
    match($0, /^ *"[^"]*": /) {
      level = (match($0, /"/) - 1) / 2
      name = substr($0, RSTART + 1); sub(/".*/, "", name)
      if (level <= at) at = level - 1
      if (level == at + 1 && name == key[level]) {
        at = level
        if (at == depth) { if (/\[ *$/) within = 1; else exit }
      }
    }' "$1"
}
