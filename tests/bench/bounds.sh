#!/usr/bin/env bash
# Nacre: what bounds the stages of the four main runs. Usage: bounds.sh NACRE CEILINGS
# CEILINGS is the program bench_ceilings (cmake --build ... --target bench_ceilings). Prints a row for each stage that takes
# 4% of its run or more: how long it took, what it works on, what it must move and compute, and which share that is of what
# the machine does at most. To try the script, NACRE_BENCH_SCALE divides the runs' resolutions, and NACRE_BENCH_SHARE takes
# the place of 4. Needs no hardware counters: how many elements there are is read from the reports, what one of them takes
# stands in the table below.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
begin_bench bounds "$@"
main_runs
((${#options[@]} == 1)) || { echo "usage: bounds.sh NACRE CEILINGS" >&2; exit 2; }

# The stages. Run, stage, how often it goes over its elements (a number, `calls` or `launches` of the stage, or a value of
# the report), the elements, then for one time: the bytes of all arrays that are read or written, each once, by what they
# belong to; and for one element: cache lines at places that nothing foretells, arithmetic in vectors, instructions; last,
# what bounds it.
#
# - Bytes are from the structures: a place, a direction or a displacement 16 (Float4), a sum of deposits 8, a number or an
#   index 4, a cell of the octree's band 12 (CellPoint), of an embedding of interfaces 16 (EmbeddedCell), a node of the
#   particles' tree 80, a triangle 84 (indices, normals, half a point) and while it is embedded 250.
# - Arithmetic in vectors is counted in the kernels' source, in lanes: a multiply-add, an addition, a division, a root, a
#   comparison are one each. A projection by WENO4 is 2776 (84 lanes of 30, 256 to make places of offsets; 3400 where cells
#   are packed, with what is interpolated at the result), a velocity 56 (120 between two times; on the octree 56 a time), a
#   pair of particles 57, a material's function 190 (250 for the difference of two, 130 without gradient).
#   How often: counted once with counters in the kernels, but for advection: there two velocities and four cells of lines
#   stand for a path (the midpoint rule), and a projection for every tenth. A particle of `relax` has 108 pairs (heart) or
#   142 (torso) and one projection an iteration.
# - Instructions, all of them, are what valgrind counted in the stage's kernels (--tool=callgrind, one thread, built with
#   NACRE_MARCH=haswell since it knows no AVX-512; flow of 256 cells, the small meshes of profile.sh). 0: not counted, where
#   such runs are unlike the large ones (few cells for a triangle, few voxels far from all boundaries). Of advection, and of
#   filtering on the grid: the count of an older program by the ratio of both programs' times. Lines of the Delaunay
#   triangulation are those of the 65 cells or so that an insertion looks at or makes.
table() {
  cat <<'TABLE'
run    stage       times      elements  bytes                                 lines lanes instructions, bound
grid   read        24         points    220*points                            0   0     2770  one by one
grid   embed       1          coarse    66*coarse,250*triangles               0   0     0     one by one
grid   refine      1          cells     24*cells,48*surface,64*coarse         0   0     0     one by one
grid   velocity    calls      coarse    36*coarse,84*triangles                0   0     190   one by one
grid   advect      calls      surface   80*surface,68*coarse,4*cells          0   750   1200  vectors, one by one
grid   filter      calls      surface   64*surface,68*coarse,4*cells          0   60    650   vectors, one by one
octree read        24         points    220*points                            0   0     2770  one by one
octree velocity    calls      cells     16*cells,84*triangles                 0   0     300   one by one (divisions)
octree advect      calls      surface   72*surface,12*cells,1*structure       0   350   2900  one by one
octree extend      calls      surface   56*surface,2*structure                0   0     2460  one by one
octree filter      calls      surface   56*surface,12*cells,3*structure       0   0     2150  one by one
octree render      1          pixels    4*pixels                              0   0     0     one by one
single read        1          voxels    4*voxels                              0   0     0     one by one
single distance    1          voxels    36*voxels                             0   0     0     one by one
single embed       1          cells     19*cells,1*fields                     0   260   5150  one by one
single relax       iterations particles 212*particles,16*cells                0   9530  7630  vectors, one by one
single triangulate calls      particles 1400*particles                        130 0     37800 random lines, one by one
single smooth      launches   particles 100*particles                         0   250   2510  one by one
multi  embed       1          cells     19*cells,1*fields                     0   1620  10000 one by one
multi  relax       iterations particles 212*particles,16*cells                0   11600 7150  vectors, one by one
multi  triangulate calls      particles 1400*particles                        130 0     37800 random lines, one by one
multi  smooth      launches   particles 100*particles                         0   505   2510  one by one
TABLE
}

# values REPORT: what the table asks for, and each stage's seconds, calls and launches, NAME VALUE.
values() {
  local name
  for name in cells=embedding.cells surface=embedding.surface_cells coarse=embedding.closest_point_cells \
    embedding=embedding.bytes fields=fields.bytes points=input.points triangles=input.triangles \
    particles=particles.final; do
    echo "${name%=*} $(report_value "$1" "${name#*=}")"
  done
  awk -v all="$(report_value "$1" particles.iterations)" -v coarse="$(report_value "$1" particles.coarse_iterations)" \
    'BEGIN { print "iterations", all - 0.75 * coarse }'  # coarse ones move a quarter of the particles
  report_list "$1" fields.blocks | awk 'BEGIN { n = 512 } { n *= $1 } END { print "voxels", n }'
  awk '/^ *"(calls|launches)": / { key = $1; gsub(/[":]/, "", key); last[key] = $2 + 0 }
       /^ *"name": / { stage = $2; gsub(/[",]/, "", stage) }
       /^ *"seconds": [0-9]/ && stage != "" {
         print "seconds." stage, $2 + 0
         for (key in last) print key "." stage, last[key]
         stage = ""
       }' "$1"
}

# rows RUN OPTIONS...: runs it; its rows.
rows() {
  local output=(--out "$out/mesh.vtp")
  [[ $2 != flow ]] || output=(--image "$out/picture.png" --size 640x480)
  "$nacre" "${@:2}" "${output[@]}" --quiet --report "$out/$1.json" >"$out/log"
  { cat "$out/ceilings"; values "$out/$1.json"; echo "pixels $((640 * 480))"; echo "table"; table; } | awk -v run="$1" -v least="${NACRE_BENCH_SHARE:-4}" '
    !rows && $1 == "table" { v["structure"] = v["embedding"] - 12 * v["cells"]; rows = 1; next }
    !rows { v[$1] = $2; if ($1 ~ /^seconds/) all += $2; next }
    function share(amount, ceiling) { return 100 * amount / s / v[ceiling] }
    $1 == run && (s = v["seconds." $2]) >= least / 100 * all && s > 0 {
      times = $3 in v ? v[$3] : ($3 "." $2) in v ? v[$3 "." $2] : $3
      n = times * v[$4]
      bytes = 0
      terms = split($5, term, ",")
      for (i = 1; i <= terms; ++i) { split(term[i], factor, "*"); bytes += times * factor[1] * v[factor[2]] }
      bound = $9
      for (i = 10; i <= NF; ++i) bound = bound " " $i
      printf "| %s | %s | %.2f | %.3g million %s | %.2f | %.1f | %s | %s | %s | %s | %s |\n", run, $2, s, n / 1e6, $4,
        bytes / 1e9, share(bytes, "copy_bytes_per_second"), $6 ? sprintf("%.0f", share(n * $6, "random_lines_per_second")) : "-",
        $7 ? sprintf("%.1f", share(n * $7, "vector_multiply_adds_per_second")) : "-",
        $8 ? $8 : "-", $8 ? sprintf("%.0f", share(n * $8, "whole_additions_per_second")) : "-", bound
    }'
}

"${options[0]}" | tr -d '{}",:' >"$out/ceilings"
echo "$(machine), $(date -u +%F); at most, a second:"
cat "$out/ceilings"
echo
echo "| run | stage | seconds | works on | GB at least | of copies, % | of random lines, % | of arithmetic in vectors, % |" \
  "instructions an element | of additions, % | bound by |"
echo "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---|"
rows grid flow --sample train --resolution "$cells" --steps 6
rows octree flow --method octree --sample train --resolution "$cells" --steps 4
rows single mesh --sample heart --detail "$heart"
rows multi mesh --sample torso --detail "$torso"
