# Nacre: the peers that mesh label images or fill surfaces: Mesh_3, surface nets, TetGen, fTetWild. Sourced by run.sh.

phantoms=${PEERS_PHANTOMS-torso:64 nested-shells:64} # of surfaces
spheres="10,14,18 23.5 23.5 23.5" # of nested-shells: the radii and the centre in the world

# measure LABELS NAME SURFACE RESULT: quality and distances of a surface; distances from spheres where the phantom has them.
measure() {
  local words=()
  [[ $2 != nested-shells ]] || read -ra words <<<"$spheres"
  "$build/bin/peer_measure" "$1" "$3" "${words[@]}" >"$4"
}

# mesh_3_surface NAME LABELS WORK [words of nacre mesh]: rows of the surfaces, without and, where there are any, with
# junction curves protected.
mesh_3_surface() {
  local name=$1 labels=$2 work=$3 our_words=("${@:4}") size target
  sample_ours() { ours "$out/ours.off" "$out/ours.json" "$labels" "${our_words[@]}" && our_seconds "$out/ours.json"; }
  sample_ours >/dev/null
  target=$(report_value "$out/ours.json" mesh.vertices)
  for features in without with; do
    local words=()
    [[ $features == without ]] || words=(features="$out/ours.off")
    mesh_3() { "${prefix[@]}" "$build/bin/peer_mesh_3" "$labels" "$out/theirs.off" threads="$threads" "${words[@]}" "$@"; }
    mesh_3 vertices="$target" >"$out/theirs-size.txt" || { broken "$FUNCNAME"; return 0; }
    size=$(value "$out/theirs-size.txt" size)
    sample_theirs() { mesh_3 size="$size" | tee "$out/theirs-run.txt" | awk '$1 == "seconds" { print $2 }'; }
    pairs sample_ours sample_theirs || return 0
    version "mesh_3: $(value "$out/theirs-run.txt" version), facet size $size for $work, $features junction curves"
    row "mesh_3" "$work, $features curves" seconds "$our_median" "$their_median"
    measure "$labels" "$name" "$out/ours.off" "$out/ours-mesh_3.txt"
    measure "$labels" "$name" "$out/theirs.off" "$out/theirs-mesh_3.txt"
    surface_rows mesh_3 "$work, $features curves"
    [[ $(junctions) -gt 0 ]] || break
  done
}

# junctions: edges of our last mesh where three materials meet.
junctions() { report_value "$out/ours.json" mesh.junction_edges; }

# cell_rows PEER WORK THEIRS: rows of tetrahedra: ours of the last report, theirs of a result.
cell_rows() {
  local key
  for key in cells:tetrahedra.cells cell_vertices:tetrahedra.vertices dihedral_min:tetrahedra.dihedral_degrees.min \
    dihedral_max:tetrahedra.dihedral_degrees.max share_within_10_160:tetrahedra.share_within_10_160_degrees; do
    row "$1" "$2" "${key%%:*}" "$(report_value "$out/ours.json" "${key#*:}")" "$(value "$3" "${key%%:*}")"
  done
}

# mesh_3_cells PHANTOM DETAIL: surface and tetrahedra at once, perturbed and exuded as by default.
mesh_3_cells() {
  local labels=$out/$1-$2.nrrd work="tetrahedra of $1 $2" size
  cells_ours() {
    ours "$out/ours.vtu" "$out/ours.json" "$labels"
    our_seconds "$out/ours.json" materials tighten distance sizing embed seed relax population triangulate smooth remesh tetrahedra
  }
  cells_ours >/dev/null
  mesh_3() { "${prefix[@]}" "$build/bin/peer_mesh_3" "$labels" "$out/theirs.off" threads="$threads" work=cells "$@"; }
  mesh_3 vertices="$(report_value "$out/ours.json" mesh.vertices)" >"$out/theirs-size.txt" || { broken "$FUNCNAME"; return 0; }
  size=$(value "$out/theirs-size.txt" size)
  cells_theirs() { mesh_3 size="$size" | tee "$out/theirs-run.txt" | awk '$1 == "seconds" { print $2 }'; }
  pairs cells_ours cells_theirs || return 0
  version "mesh_3: $(value "$out/theirs-run.txt" version), facet size $size for $work"
  row mesh_3 "$work" seconds "$our_median" "$their_median"
  cell_rows mesh_3 "$work" "$out/theirs-run.txt"
}

peer_mesh_3() {
  built peer_measure && built peer_mesh_3 || { skip mesh_3 "it wants CGAL and zlib (libcgal-dev, zlib1g-dev)"; return 0; }
  local one
  for one in $phantoms; do
    sample "${one%:*}" "${one#*:}"
    mesh_3_surface "${one%:*}" "$out/${one%:*}-${one#*:}.nrrd" "surface of ${one%:*} ${one#*:}"
  done
  for one in ${PEERS_LABELS:-}; do # NAME=FILE:SIZE
    local file=${one#*=}
    mesh_3_surface "${one%%=*}" "${file%:*}" "surface of ${one%%=*}" --min-size "${file##*:}" --max-size "${file##*:}"
  done
  sample torso 64
  mesh_3_cells torso 64
}

# surface_nets_pair PHANTOM DETAIL. Vertices of surface nets are given by the voxels: the size of ours is sought that gives as many.
surface_nets_pair() {
  local name=$1 labels=$out/$1-$2.nrrd work="surface of $1 $2" size=1 k vertices target
  nets() {
    "${prefix[@]}" "$python" "$here/surface_nets.py" "$labels" "$out/theirs.off" "$threads" | tee "$out/theirs-run.txt" |
      awk '$1 == "seconds" { print $2 }'
  }
  nets >/dev/null
  measure "$labels" "$name" "$out/theirs.off" "$out/theirs-surface_nets.txt"
  target=$(value "$out/theirs-surface_nets.txt" vertices)
  nets_ours() {
    ours "$out/ours.off" "$out/ours.json" "$labels" --min-size "$size" --max-size "$size" && our_seconds "$out/ours.json"
  }
  for ((k = 0; k < 4; ++k)); do
    nets_ours >/dev/null
    vertices=$(report_value "$out/ours.json" mesh.vertices)
    awk "BEGIN { r = $vertices / $target; exit !(r > 0.98 && r < 1.02) }" && break
    size=$(awk "BEGIN { print $size * sqrt($vertices / $target) }")
  done
  pairs nets_ours nets || return 0
  measure "$labels" "$name" "$out/ours.off" "$out/ours-surface_nets.txt"
  version "surface_nets: $(value "$out/theirs-run.txt" version), their smoothing; ours with one size $size for $work"
  row surface_nets "$work" seconds "$our_median" "$their_median"
  surface_rows surface_nets "$work"
}

peer_surface_nets() {
  local python=${PEERS_PYTHON:-python3} one
  "$python" -c 'import vtk; vtk.vtkSurfaceNets3D' 2>/dev/null ||
    { skip surface_nets "no python with VTK 9.3 or later (the wheel vtk; name the python by PEERS_PYTHON)"; return 0; }
  built peer_measure || { skip surface_nets "peer_measure does not build"; return 0; }
  for one in $phantoms; do
    sample "${one%:*}" "${one#*:}"
    surface_nets_pair "${one%:*}" "${one#*:}"
  done
}

# Fills our surface; without q it adds hardly a point, with q it aims at good cells, as ours does.
peer_tetgen() {
  built peer_tetgen || { skip tetgen "libtet1.5-dev is not installed"; return 0; }
  local labels=$out/torso-48.nrrd switches
  sample torso 48
  ours "$out/ours.off" "$out/ours.json" "$labels"
  tetgen_ours() { ours "$out/ours.vtu" "$out/ours.json" "$labels" && our_seconds "$out/ours.json" tetrahedra; }
  for switches in pYAQ pq1.414YAQ; do
    tetgen_theirs() {
      "${prefix[@]}" "$build/bin/peer_tetgen" "$out/ours.off" "$switches" | tee "$out/theirs-run.txt" |
        awk '$1 == "seconds" { print $2 }'
    }
    pairs tetgen_ours tetgen_theirs || return 0
    version "tetgen: $(value "$out/theirs-run.txt" version)"
    row tetgen "our surface of torso 48 filled, -$switches" seconds "$our_median" "$their_median"
    cell_rows tetgen "our surface of torso 48 filled, -$switches" "$out/theirs-run.txt"
  done
}

# Fills our surface; its cells keep near the surface, and need not keep its triangles. A small one: the torso of 48 voxels
# takes longer than five minutes.
peer_ftetwild() {
  local python=${PEERS_PYTHON:-python3} labels=$out/nested-shells-20.nrrd work="our surface of nested-shells 20 filled, near it"
  "$python" -c 'import pytetwild' 2>/dev/null ||
    { skip ftetwild "no python with the wheel pytetwild (and pyvista; name the python by PEERS_PYTHON)"; return 0; }
  sample nested-shells 20
  ours "$out/ours.off" "$out/ours.json" "$labels"
  ftetwild_ours() { ours "$out/ours.vtu" "$out/ours.json" "$labels" && our_seconds "$out/ours.json" tetrahedra; }
  ftetwild_theirs() {
    "${prefix[@]}" "$python" "$here/ftetwild.py" "$out/ours.off" "$threads" | tee "$out/theirs-run.txt" |
      awk '$1 == "seconds" { print $2 }'
  }
  pairs ftetwild_ours ftetwild_theirs || return 0
  version "ftetwild: $(value "$out/theirs-run.txt" version)"
  row ftetwild "$work" seconds "$our_median" "$their_median"
  cell_rows ftetwild "$work" "$out/theirs-run.txt"
}
