#!/usr/bin/env bash
# Nacre: the meshing tables of docs/performance/meshing.md: the phantoms, real volumes where they are, and the three solvers.
# Usage: mesh.sh BINARY [options of nacre mesh, e.g. --device cuda]. Reports go to $OUT where it is set.
# Environment: NACRE_BENCH_CASES (names, default all; `solvers` is the second table, `tetrahedra` the third), NACRE_DATA (folder that holds
# labels/ and scalar/), NACRE_BENCH_PARTICLES and NACRE_BENCH_ITERATIONS (of the second table).
set -euo pipefail
source "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/begin.sh"
begin_bench mesh "$@"

# judge LINE NAME: says what a mesh misses of what is asked of it, and fails the script at its end. Middles of facets that are
# large for their surface (liver-coarse) lie off it however well its corners do.
judge() {
  local misses
  misses=$(awk -F' *[|] *' '{
    mean = $2 ~ /^(torso|heart|lungs|ribcage|head)$/ ? 0.97 : 0.95
    if ($12 < mean) printf " mean ratio under %.2f,", mean
    if ($13 < 0.15) printf " least ratio under 0.15,"
    if ($14 < 0.3) printf " least ratio away from junctions under 0.3,"
    if ($15 > 0.1) printf " angles under 25 degrees in more than 0.1%% of those away,"
    if ($16 > 0.1 && $2 != "liver-coarse") printf " facets more than 0.1 voxel off,"
    if ($17 + $18 + $19 > 0 || $20 != "yes") printf " not sound,"
  }' <<<"$1")
  [[ -n $misses ]] || return 0
  echo "mesh.sh: $2 misses what is asked:${misses%,}" >&2
  failed=1
}

# row NAME INPUT...: one run and its line of the table; a run that fails is a line that says so.
row() {
  local name=$1 report="$out/mesh-$1.json" stage sound=no
  shift
  [[ -z ${NACRE_BENCH_CASES:-} || " $NACRE_BENCH_CASES " == *" $name "* ]] || return 0
  if [[ $1 != --sample && ! -e $1 ]]; then
    echo "mesh.sh: $name left out: no $1" >&2
    return 0
  fi
  if ! "$nacre" mesh "$@" "${options[@]}" --quiet --out "$out/mesh-$name.vtp" --report "$report" >/dev/null 2>"$out/mesh-$name.err"; then
    printf '| %s | failed: %s |\n' "$name" "$(head -n 1 "$out/mesh-$name.err")"
    failed=1
    return
  fi
  local values=()
  for stage in materials tighten distance sizing embed seed relax population triangulate smooth remesh; do
    values+=("$stage=$(stage_seconds "$report" "$stage")")
  done
  [[ $(report_value "$report" mesh.sound) != true ]] || sound=yes
  local line
  line=$(printf '%s\n' "${values[@]}" | awk -F= -v name="$name" -v total="$(report_value "$report" seconds)" \
    -v particles="$(report_value "$report" particles.final)" -v iterations="$(report_value "$report" particles.iterations)" \
    -v coarse="$(report_value "$report" particles.coarse_iterations)" \
    -v triangles="$(report_value "$report" mesh.triangles)" -v mean="$(report_value "$report" mesh.radius_ratio.mean)" \
    -v least="$(report_value "$report" mesh.radius_ratio.min)" \
    -v away="$(report_value "$report" mesh.away_from_junctions.radius_ratio.min)" \
    -v under="$(report_value "$report" mesh.away_from_junctions.share_under_25_degrees)" \
    -v facets="$(report_value "$report" mesh.surface_distance_voxels.facet_mean)" \
    -v off="$(report_value "$report" mesh.nonmanifold_edges)" -v open="$(report_value "$report" mesh.boundary_edges)" \
    -v lost="$(report_list "$report" mesh.lost_labels | wc -l)" -v sound="$sound" \
    -v memory="$(report_value "$report" memory.peak_bytes)" '
    { s[$1] = $2 }
    END {
      fields = s["materials"] + s["tighten"] + s["distance"] + s["sizing"] + s["embed"]
      printf "| %s | %d | %d | %d + %d | %.1f | %.1f | %.1f | %.1f | %.1f | %.2f | %.3f | %.3f | %.3f | %.5f | %.3f | %d | %d | %d | %s | %.2f |\n",
        name, particles, triangles, coarse, iterations - coarse, total, fields, s["relax"] + s["population"] + s["seed"], s["triangulate"],
        s["smooth"] + s["remesh"], particles * (iterations - 0.75 * coarse) / total / 1e6, mean, least, away, 100 * under, facets, off, open,
        lost, sound, memory / 1e9
    }')
  echo "$line"
  judge "$line" "$name"
}

machine
echo
printf '| data | particles | triangles | iterations of a quarter + of all | whole command, s | fields, s | particles, s | triangulate, s | smooth and remesh, s |'
printf ' million particle-iterations per second of the whole | radius ratio mean | min | min away from junctions |'
printf ' under 25 degrees away from junctions, %% | facet centres off the interface, voxels | non-manifold edges |'
printf ' boundary edges | lost labels | sound | peak memory, GB |\n'
printf '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|---:|\n'
for sample in torso heart lungs ribcage head; do
  row "$sample" --sample "$sample"
done
row mickey "$data/labels/cleaver/mickey.nrrd"
row spheres "$data"/labels/cleaver/spheres{1,2,3,4}.nrrd
row liver "$data/labels/junctions/liver.inr.gz"
row liver-coarse "$data/labels/junctions/liver.inr.gz" --min-size 4.1 --max-size 4.1
row frog-coarse "$data/labels/frog/frogtissue.mhd" --min-size 1.9 --max-size 1.9
row frog "$data/labels/frog/frogtissue.mhd" --min-size 1.48 --max-size 1.48
row colin27 "$data/labels/atlases/colin27.nrrd"
row usc195 "$data/labels/atlases/usc195.nrrd"
row digimouse "$data/labels/atlases/digimouse.nrrd"
row brainweb "$data/labels/nested-head/brainweb.nrrd"
row nested-head "$data/labels/nested-head/standard_seg.nrrd"
row abdomen "$data/labels/abdomen/example_seg_fast_force_split.nii.gz"
row head-probabilities "$data"/labels/head-probabilities/c{1,2,3,4,5,6}_40-44.nrrd
row aneurism "$data/scalar/ct/aneurism.vti" --isovalue 100
row engine "$data/scalar/ct/engine.vti" --isovalue 100
row skull "$data/scalar/skull_2.9.inr" --isovalue 2.9

# solver_run SOLVER ITERATIONS REPORT: the same seeds for all, none added or deleted, nothing smoothed or remeshed, no
# end before the last iteration. Fails where the run does.
solver_run() {
  "$nacre" mesh --sample torso "${options[@]}" --quiet --solver "$1" --iterations "$2" --stagnation 0 --smooth 0 --remesh 0 \
    --control-every 100 --set seeds=embedding --particles "${NACRE_BENCH_PARTICLES:-300000}" --report "$3" \
    >/dev/null 2>"$out/mesh-solver.err"
}

# solver_row SOLVER: the first iteration of three in a row that change the energy by less than 0.0015 of it, and what a
# run of so many iterations gives; then what all iterations give. Energies of the ends are measured alike for all.
solver_row() {
  local report="$out/mesh-solver-$1.json" short="$out/mesh-solver-$1-short.json" settled=0 seconds=0
  read -r settled seconds < <(paste <(report_list "$report" particles.energy) <(report_list "$report" particles.seconds) | awk '
    { change = (NR > 1) ? (before - $1) / $1 : 1; before = $1
      run = (change < 0.0015 && change > -0.0015) ? run + 1 : 0
      if (run == 3) { print NR, $2; found = 1; exit } }
    END { if (!found) print NR, $2 }')
  solver_run "$1" "$settled" "$short" || return 1
  printf '| %s | %d | %d | %.1f | %.4f | %.3f | %.1f | %.4f | %.3f |\n' "$1" "$(report_value "$report" particles.final)" \
    "$settled" "$seconds" "$(report_value "$short" particles.final_energy)" \
    "$(report_value "$short" mesh.radius_ratio.mean)" "$(report_list "$report" particles.seconds | tail -n 1)" \
    "$(report_value "$report" particles.final_energy)" "$(report_value "$report" mesh.radius_ratio.mean)"
}

if [[ -z ${NACRE_BENCH_CASES:-} || " $NACRE_BENCH_CASES " == *" solvers "* ]]; then
  iterations=${NACRE_BENCH_ITERATIONS:-60}
  for solver in serial redblack tree; do
    solver_run "$solver" "$iterations" "$out/mesh-solver-$solver.json" ||
      { echo "mesh.sh: the $solver solver failed: $(head -n 1 "$out/mesh-solver.err")" >&2; exit 1; }
  done
  printf '\n| solver | particles | settled at iteration | s | energy then | radius ratio mean then |'
  printf ' s for %d iterations | energy then | radius ratio mean then |\n' "$iterations"
  printf '|---|---:|---:|---:|---:|---:|---:|---:|---:|\n'
  for solver in serial redblack tree; do solver_row "$solver" || failed=1; done
fi

# fill_row NAME INPUT...: tetrahedra of one input.
fill_row() {
  local name=$1 report="$out/mesh-fill-$1.json"
  shift
  if [[ $1 != --sample && ! -e $1 ]]; then
    echo "mesh.sh: tetrahedra of $name left out: no $1" >&2
    return 0
  fi
  if ! "$nacre" mesh "$@" "${options[@]}" --quiet --out "$out/mesh-$name.vtu" --report "$report" >/dev/null 2>"$out/mesh-fill.err"; then
    printf '| %s | failed: %s |\n' "$name" "$(head -n 1 "$out/mesh-fill.err")"
    failed=1
    return
  fi
  awk -v name="$name" -v triangles="$(report_value "$report" mesh.triangles)" -v cells="$(report_value "$report" tetrahedra.cells)" \
    -v inverted="$(report_value "$report" tetrahedra.inverted)" -v seconds="$(stage_seconds "$report" tetrahedra)" \
    -v least="$(report_value "$report" tetrahedra.dihedral_degrees.min)" \
    -v most="$(report_value "$report" tetrahedra.dihedral_degrees.max)" \
    -v within="$(report_value "$report" tetrahedra.share_within_10_160_degrees)" 'BEGIN {
      printf "| %s | %d | %d | %d | %.1f | %.1f | %.1f | %.5f |\n", name, triangles, cells, inverted, seconds, least, most, 100 * within }'
}

if [[ -z ${NACRE_BENCH_CASES:-} || " $NACRE_BENCH_CASES " == *" tetrahedra "* ]]; then
  printf '\n| data | triangles | tetrahedra | inverted | s | least dihedral angle, degrees | largest | within 10 to 160 degrees, %% |\n'
  printf '|---|---:|---:|---:|---:|---:|---:|---:|\n'
  fill_row torso-96 --sample torso --detail 96
  fill_row mickey "$data/labels/cleaver/mickey.nrrd"
  fill_row liver-coarse "$data/labels/junctions/liver.inr.gz" --min-size 4.1 --max-size 4.1
  fill_row frog-coarse "$data/labels/frog/frogtissue.mhd" --min-size 1.9 --max-size 1.9
  fill_row abdomen "$data/labels/abdomen/example_seg_fast_force_split.nii.gz"
  fill_row nested-head "$data/labels/nested-head/standard_seg.nrrd" --min-size 2 --max-size 2
fi
exit $failed
