# Nacre: the peer that draws textures of a flow on a surface: ParaView's Surface LIC. Sourced by run.sh.

# cameras: two orthographic ones, half a degree apart around the train, as CAMERAS.json and camera-K.json.
cameras() {
  local k
  for k in 0 1; do
    awk -v turn="$k" 'BEGIN {
      a = -0.9 + turn * 0.5 * 3.14159265358979 / 180
      printf "{\"eye\":[%.9f,%.9f,8],\"target\":[0,0,0.82],\"up\":[0,0,1],", 18 * cos(a), 18 * sin(a)
      print "\"height\":6.5,\"orthographic\":true}" }' >"$out/camera-$k.json"
  done
  { echo '['; cat "$out/camera-0.json"; echo ','; cat "$out/camera-1.json"; echo ']'; } >"$out/cameras.json"
}

# texture_picture FILE CAMERA [words]: a steady frame of ours; its time is that of one picture, the texture is there.
texture_picture() {
  "${prefix[@]}" "$nacre" flow "$out/train.vtp" --vectors velocity --color none --camera "$2" --size 1024x768 --image "$1" \
    --no-legend --no-time --steps 1 --threads "$threads" --quiet --report "$out/ours.json" "${@:3}" >/dev/null
}

peer_surface_lic() {
  local pvpython=${PVPYTHON:-pvpython} k key
  command -v "$pvpython" >/dev/null || { skip surface_lic "no pvpython (python3-paraview; name ParaView's by PVPYTHON)"; return 0; }
  "$nacre" sample train --out "$out/train.vtp" >/dev/null
  cameras
  for k in 0 1; do
    texture_picture "$out/ours-$k.png" "$out/camera-$k.json"
    texture_picture "$out/ours-$k-plain.png" "$out/camera-$k.json" --contrast 0
  done
  lic_ours() { texture_picture "$out/ours-timed.png" "$out/camera-0.json" && stage_seconds "$out/ours.json" render; }
  lic_theirs() {
    "${prefix[@]}" "$pvpython" "$here/surface_lic.py" "$out/train.vtp" "$out/cameras.json" "$out" 8 2>"$out/pvpython.err" |
      tee "$out/theirs-run.txt" | awk '$1 == "seconds" { print $2 }'
  }
  pairs lic_ours lic_theirs || return 0
  version "surface_lic: $(value "$out/theirs-run.txt" version), Mesa's software OpenGL; ours is the CPU picture, four rays a pixel"
  row surface_lic "steady train 1024x768, the camera turns" "seconds per frame" "$our_median" "$their_median"
  for k in ours theirs; do
    "$pvpython" "$here/texture_on_points.py" "$out/train.vtp" "$out/cameras.json" "$out" "$k" >"$out/$k-texture.txt" \
      2>"$out/pvpython.err" || { broken "$FUNCNAME"; return 0; }
  done
  for key in correlation difference angle; do
    row surface_lic "steady train 1024x768, half a degree" "$key" "$(value "$out/ours-texture.txt" $key)" \
      "$(value "$out/theirs-texture.txt" $key)"
  done
}
