// Nacre: from the voxels that fields and particles are computed in to the world, and back.
#pragma once

#include <algorithm>

#include "compute/field/material_bricks.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// Work space: isotropic, in edges of the smallest voxel spacing, with `volume_padding` voxels of outside around the volume.
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
    Vec3d world = origin;
    for (int k = 0; k < 3; ++k) world += axes[k] * ((p[k] / relative[k] - 0.5 - volume_padding) * spacing[k]);
    return world;
  }
  Vec3d to_voxels(const Vec3d& world) const {
    const Vec3d r = world - origin, relative = relative_spacing();
    Vec3d p;
    for (int k = 0; k < 3; ++k) p[k] = (dot(r, axes[k]) / spacing[k] + 0.5 + volume_padding) * relative[k];
    return p;
  }
  Vec3f direction_to_world(const Vec3f& d) const {
    Vec3d world;
    for (int k = 0; k < 3; ++k) world += axes[k] * double(d[k]);
    return Vec3f(world);
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
