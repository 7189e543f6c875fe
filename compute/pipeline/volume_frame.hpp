// Nacre: from the voxels that fields and particles are computed in to the world, and back.
#pragma once

#include <algorithm>
#include <array>

#include "compute/field/material_bricks.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// World position of a point of a volume, given by the index of a voxel: whole numbers are centres of voxels, fractions
/// lie between them. `origin` is the centre of voxel (0, 0, 0); `axes` are unit vectors at right angles; `spacing` > 0.
inline Vec3d index_to_world(const Vec3d& index, const Vec3d& origin, const Vec3d& spacing,
                            const std::array<Vec3d, 3>& axes) {
  Vec3d world = origin;
  for (int k = 0; k < 3; ++k) world += axes[std::size_t(k)] * (index[k] * spacing[k]);
  return world;
}

/// The inverse of `index_to_world`.
inline Vec3d world_to_index(const Vec3d& world, const Vec3d& origin, const Vec3d& spacing,
                            const std::array<Vec3d, 3>& axes) {
  const Vec3d r = world - origin;
  Vec3d index;
  for (int k = 0; k < 3; ++k) index[k] = dot(r, axes[std::size_t(k)]) / spacing[k];
  return index;
}

/// The space that fields and particles are computed in: isotropic, in units of the smallest voxel spacing, with
/// `volume_padding` voxels of outside around the volume. Voxel (i, j, k) begins at (i, j, k) + volume_padding.
struct VolumeFrame {
  Vec3d origin, spacing{1, 1, 1};  ///< as in MeshVolume
  std::array<Vec3d, 3> axes{};
  double unit = 1;  ///< world length of a voxel
  Int3 dims{};

  VolumeFrame() = default;
  explicit VolumeFrame(const MeshVolume& v)
      : origin(v.origin),
        spacing(v.spacing),
        axes(v.axes),
        unit(std::min({v.spacing.x, v.spacing.y, v.spacing.z})),
        dims(v.dims) {}

  Vec3d relative_spacing() const { return spacing / unit; }

  Vec3d to_world(const Vec3d& p) const {
    const Vec3d relative = relative_spacing();
    Vec3d index;
    for (int k = 0; k < 3; ++k) index[k] = p[k] / relative[k] - 0.5 - volume_padding;
    return index_to_world(index, origin, spacing, axes);
  }
  Vec3d to_voxels(const Vec3d& world) const {
    const Vec3d relative = relative_spacing(), index = world_to_index(world, origin, spacing, axes);
    Vec3d p;
    for (int k = 0; k < 3; ++k) p[k] = (index[k] + 0.5 + volume_padding) * relative[k];
    return p;
  }
  Vec3f direction_to_world(const Vec3f& d) const {
    Vec3d world;
    for (int k = 0; k < 3; ++k) world += axes[std::size_t(k)] * double(d[k]);
    return Vec3f(world);
  }
  /// `to_world` as a renderer wants it: the image of the zero, and that of each axis.
  VoxelFrame voxel_frame() const {
    VoxelFrame frame{to_world(Vec3d(0, 0, 0)), axes};
    for (Vec3d& axis : frame.axes) axis *= unit;
    return frame;
  }
  /// Longest edge of the padded volume, voxels.
  double extent() const {
    const Vec3d r = relative_spacing();
    double most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, (dims[k] + 2 * volume_padding + block_size) * r[k]);
    return most;
  }
};

}  // namespace nacre
