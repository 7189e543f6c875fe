#!/usr/bin/env bash
# Nacre: the meshing tables of docs/performance.md: the phantoms, real volumes where they are, and the three solvers.
# Usage: mesh.sh BINARY [words of nacre mesh, e.g. --device cuda]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_CASES (names, default all), NACRE_DATA (folder that holds labels/ and scalar/).
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$here/report.sh"

(($#)) || { echo "usage: mesh.sh BINARY [words of nacre mesh]" >&2; exit 2; }
nacre=$1
shift
[[ -x $nacre ]] || { echo "mesh.sh: $nacre is not a program" >&2; exit 2; }
words=("$@")
data=${NACRE_DATA:-$here/../../../shared/data}
if [[ -n ${OUT:-} ]]; then
  out=$OUT
  mkdir -p "$out"
else
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
fi

failed=0
# row NAME INPUT...: one run and its line of the table; a run that fails is a line that says so.
row() {
  local name=$1 report="$out/mesh-$1.json" stage
  shift
  [[ -z ${NACRE_BENCH_CASES:-} || " $NACRE_BENCH_CASES " == *" $name "* ]] || return 0
  if [[ $1 != --sample && ! -e $1 ]]; then
    echo "mesh.sh: $name left out: no $1" >&2
    return 0
  fi
  if ! "$nacre" mesh "$@" "${words[@]}" --quiet --out "$out/mesh-$name.vtp" --report "$report" >/dev/null 2>"$out/mesh-$name.err"; then
    printf '| %s | failed: %s |\n' "$name" "$(head -n 1 "$out/mesh-$name.err")"
    failed=1
    return
  fi
  local values=() total=0
  for stage in read materials tighten distance sizing embed seed relax population triangulate mend quality write; do
    values+=("$stage=$(stage_seconds "$report" "$stage")")
  done
  printf '%s\n' "${values[@]}" | awk -F= -v name="$name" \
    -v particles="$(report_value "$report" particles.final)" -v iterations="$(report_value "$report" particles.iterations)" \
    -v triangles="$(report_value "$report" mesh.triangles)" -v mean="$(report_value "$report" mesh.radius_ratio.mean)" \
    -v least="$(report_value "$report" mesh.radius_ratio.min)" \
    -v away="$(report_value "$report" mesh.away_from_junctions.radius_ratio.min)" \
    -v off="$(report_value "$report" mesh.nonmanifold_edges)" -v memory="$(report_value "$report" memory.peak_bytes)" '
    { s[$1] = $2; total += $2 }
    END {
      fields = s["materials"] + s["tighten"] + s["distance"] + s["sizing"] + s["embed"]
      printf "| %s | %d | %d | %d | %.1f | %.1f | %.1f | %.1f | %.1f | %.2f | %.3f | %.3f | %.3f | %d | %.2f |\n",
        name, particles, triangles, iterations, total, fields, s["relax"] + s["population"] + s["seed"], s["triangulate"],
        s["mend"], particles * iterations / total / 1e6, mean, least, away, off, memory / 1e9
    }'
}

echo "$(nproc) processors, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
echo
printf '| data | particles | triangles | iterations | whole command, s | fields, s | particles, s | triangulate, s | mend, s |'
printf ' million particle-iterations per second of the whole | radius ratio mean | min | min away from junctions |'
printf ' non-manifold edges | peak memory, GB |\n'
printf '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n'
for sample in torso heart lungs ribcage head; do
  row "$sample" --sample "$sample"
done
for solver in tree redblack serial; do
  row "torso-$solver" --sample torso --solver "$solver" --stagnation 0.0015 --mend 0
done
row mickey "$data/labels/cleaver/mickey.nrrd"
row spheres "$data"/labels/cleaver/spheres{1,2,3,4}.nrrd
row liver "$data/labels/junctions/liver.inr.gz"
row liver-coarse "$data/labels/junctions/liver.inr.gz" --min-size 4.3 --max-size 4.3
row frog-coarse "$data/labels/frog/frogtissue.mhd" --min-size 1.9 --max-size 1.9
row colin27 "$data/labels/atlases/colin27.nrrd"
row digimouse "$data/labels/atlases/digimouse.nrrd"
row nested-head "$data/labels/nested-head/standard_seg.nrrd"
row abdomen "$data/labels/abdomen/example_seg_fast_force_split.nii.gz"
row head-probabilities "$data"/labels/head-probabilities/c{1,2,3,4,5,6}_40-44.nrrd
row aneurism "$data/scalar/ct/aneurism.vti" --isovalue 100
row engine "$data/scalar/ct/engine.vti" --isovalue 100
row skull "$data/scalar/skull_2.9.inr" --isovalue 2.9
exit $failed
