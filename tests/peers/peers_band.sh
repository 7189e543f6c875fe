# Nacre: the peers that find closest points or distances in a band of cells: OpenVDB, Embree. Sourced by run.sh.

# Both alternate the runs themselves.
peer_openvdb() {
  built peer_openvdb || { skip openvdb "libopenvdb-dev is not installed"; return 0; }
  local mesh resolution result=$out/openvdb.txt work
  for mesh in torus:1 train; do
    for resolution in 512 1024; do
      "${prefix[@]}" "$build/bin/peer_openvdb" "$mesh" "$resolution" 2.24 "$threads" "$runs" >"$result" || { broken "$FUNCNAME $mesh"; continue; }
      work="band of 2.24 cells, $mesh at $resolution"
      version "openvdb: $(value "$result" version), unsigned distances and index grid"
      row openvdb "$work" seconds "$(value "$result" our_seconds)" "$(value "$result" their_seconds)"
      row openvdb "$work" cells "$(value "$result" our_cells)" "$(value "$result" their_cells)"
      row openvdb "$work" "million cells per second" \
        "$(awk "BEGIN { print $(value "$result" our_cells) / $(value "$result" our_seconds) / 1e6 }")" \
        "$(awk "BEGIN { print $(value "$result" their_cells) / $(value "$result" their_seconds) / 1e6 }")"
    done
  done
}

peer_embree() {
  built bench_octree_build || { skip embree "bench_octree_build does not build"; return 0; }
  local mesh resolution result=$out/embree.txt
  for mesh in torus:1 train; do
    for resolution in 512 1024; do
      "${prefix[@]}" "$build/bin/bench_octree_build" "$mesh" resolution="$resolution" radius=2.24 threads="$threads" \
        runs="$runs" >"$result" || { broken "$FUNCNAME $mesh"; continue; }
      grep -q '^  Embree ' "$result" || { skip embree "libembree-dev is not installed"; return 0; }
      row embree "closest points of 2.24 cells, $mesh at $resolution" seconds \
        "$(awk '$1 == "octree" { print $2 }' "$result")" "$(awk '$1 == "Embree" && $3 == "s" { print $2 }' "$result")"
    done
  done
  version "embree: rtcPointQuery over our cells, its tree left out"
}
