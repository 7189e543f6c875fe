// Nacre: voxels of labels belong in part to the materials beside them, as the slopes say that staircases stand for.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/field/slopes.hpp"

namespace nacre::detail {

/// The labels of a block and of the voxels next to it; beyond the volume, of the voxels nearest to there.
class LabelTile {
 public:
  static constexpr int width = block_size + 2, size = width * width * width;

  /// `label`: memory for `size` labels.
  NACRE_HD LabelTile(const MaterialBricksView& field, std::uint32_t block, std::uint16_t* label)
      : field_(field), low_(field.block(block) * Int3(block_size) - Int3(1)), label_(label) {}

  /// Is to be filled row by row, 0 .. width * width - 1.
  NACRE_HD void fill_row(int row) const {
    const Int3 last = field_.voxels() - Int3(1);
    const Int3 from = max(Int3(0), min(low_ + Int3(1, row % width, row / width), last));
    std::uint16_t* to = label_ + row * width;
    to[0] = field_.material(max(from - Int3(1, 0, 0), Int3(0)));
    field_.row_of_block(from, to + 1);
    to[width - 1] = field_.material(min(from + Int3(block_size, 0, 0), last));
  }

  NACRE_HD std::uint16_t operator()(const Int3& v) const {
    const Int3 at = v - low_;
    if (is_within(at, Int3(width))) return label_[(at.z * width + at.y) * width + at.x];
    return field_.material(v);
  }

 private:
  const MaterialBricksView& field_;
  Int3 low_;
  std::uint16_t* label_;
};

/// Along slopes a voxel belongs in part to the materials beside it. What it gives away is taken from its own material.
struct ShareAlongSlopes {
  LabelSlopes slopes;
  const std::uint32_t* listed;
  float* value;  ///< all or nothing before

  static constexpr int layer = block_size * block_size, faces = (block_size + 1) * layer;
  static constexpr int lines = faces / block_size;  ///< of eight faces, along the axis after theirs
  static constexpr std::size_t scratch_bytes() {
    return 3 * faces * sizeof(float) + LabelSlopes::ends_of_face * faces * sizeof(LabelSlopes::End) +
           LabelTile::size * sizeof(std::uint16_t) + 3 * lines * sizeof(std::uint8_t);
  }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {  // blocks with a list
    const std::uint32_t block = listed[i];
    const Int3 low = slopes.field.block(block) * Int3(block_size);
    auto* offset = reinterpret_cast<float*>(team.scratch());  // per axis and face, of the layers from the lowest on
    auto* end = reinterpret_cast<LabelSlopes::End*>(offset + 3 * faces);  // per kind of end and face
    auto* label = reinterpret_cast<std::uint16_t*>(end + LabelSlopes::ends_of_face * faces);
    auto* boundary = reinterpret_cast<std::uint8_t*>(label + LabelTile::size);  // per axis and line
    const LabelTile material(slopes.field, block, label);
    team.each(LabelTile::width * LabelTile::width, [&](int row) { material.fill_row(row); });
    team.each(3 * lines, [&](int k) { boundary[k] = boundary_of(material, low, k / lines, k % lines); });
    if (team.sum(3 * lines, 0, [&](int k) { return int(boundary[k]); }) == 0) return;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint8_t* own = boundary + axis * lines;
      team.each(2 * lines, [&](int k) { find_ends(material, own, low, axis, k / lines, k % lines, end); });
      team.each(lines, [&](int line) {
        for (int k = 0; k < block_size; ++k) {
          const int face = line * block_size + k;
          offset[axis * faces + face] = own[line] >> k & 1 ? slopes.offset(end + face, faces, axis) : 0;
        }
      });
    }
    team.each(brick_voxels, [&](int k) { share(material, block, low, offset, k); });
  }

 private:
  /// The lower voxel of a face.
  NACRE_HD static Int3 voxel_below(const Int3& low, int axis, int face) {
    Int3 v = low;
    v[axis] += face / layer - 1;
    v[(axis + 1) % 3] += face % block_size;
    v[(axis + 2) % 3] += face / block_size % block_size;
    return v;
  }

  /// A bit for each face of a line that is between two materials.
  NACRE_HD std::uint8_t boundary_of(const LabelTile& material, const Int3& low, int axis, int line) const {
    Int3 v = voxel_below(low, axis, line * block_size);
    if (v[axis] < 0 || v[axis] + 1 >= slopes.field.voxels()[axis]) return 0;
    Int3 next = v;
    ++next[axis];
    const int along = (axis + 1) % 3;
    unsigned bits = 0;
    for (int k = 0; k < block_size; ++k, ++v[along], ++next[along])
      bits |= unsigned(material(v) != material(next)) << k;
    return std::uint8_t(bits);
  }

  /// Along the first (`across` 0) or the second axis after the faces' one.
  NACRE_HD void find_ends(const LabelTile& material, const std::uint8_t* boundary, const Int3& low, int axis,
                          int across, int line, LabelSlopes::End* end) const {
    const int stride = across == 0 ? 1 : block_size;
    const int face = across == 0 ? line * block_size : line / block_size * layer + line % block_size;
    const unsigned bits =
        across == 0 ? boundary[line] : column(boundary + line / block_size * block_size, line % block_size);
    if (bits == 0) return;
    slopes.find_ends(material, bits, voxel_below(low, axis, face), axis, (axis + 1 + across) % 3, stride,
                     end + across * faces + face, end + (across + 2) * faces + face);
  }

  /// One bit of each of the eight lines of a layer.
  NACRE_HD static unsigned column(const std::uint8_t* boundary, int bit) {
    unsigned bits = 0;
    for (int k = 0; k < block_size; ++k) bits |= unsigned(boundary[k] >> bit & 1) << k;
    return bits;
  }

  NACRE_HD void share(const LabelTile& material, std::uint32_t block, const Int3& low, const float* offset,
                      int position) const {
    const MaterialBricksView& field = slopes.field;
    const Int3 local(position % block_size, position / block_size % block_size, position / layer), v = low + local;
    const std::uint32_t start = field.block_start[block], end = field.block_start[block + 1];
    float* here = value + position;
    float all = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int across = local[(axis + 2) % 3] * block_size + local[(axis + 1) % 3];
      const float* face = offset + axis * faces + local[axis] * layer + across;
      for (const int side : {-1, 1}) {
        const float part = side < 0 ? -face[0] : face[layer];
        if (!(part > 0)) continue;
        Int3 beside = v;
        beside[axis] += side;
        const std::uint32_t other = material(beside);
        all += part;
        for (std::uint32_t k = start; k < end; ++k)
          if (field.brick_material[k] == other) here[std::size_t(k) * brick_voxels] += part;
      }
    }
    if (all == 0) return;
    const std::uint32_t own = material(v);
    const float most = all > 0.5f ? 0.5f / all : 1;
    for (std::uint32_t k = start; k < end; ++k) {
      float& value_here = here[std::size_t(k) * brick_voxels];
      value_here = field.brick_material[k] == own ? std::fma(-all, most, 1.0f) : value_here * most;
    }
  }
};

}  // namespace nacre::detail
