// Nacre: a volume that is being meshed, as the viewer shows it: slices, probes, its box. No OpenGL here.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/viewer/scene/clip.hpp"
#include "engine/io/mesh_input.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/image.hpp"
#include "engine/picture/oklab.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// How the values of a scalar volume are spread.
struct ValueSpread {
  double min = 0, max = 1;               ///< of all
  double low = 0, high = 1;              ///< nearly all lie between; what is beyond would cost the rest its contrast
  std::array<float, 96> histogram = {};  ///< from low to high: the root of the number of voxels
};

ValueSpread spread_of(const Volume& volume);

/// Never changes once it is made: threads share it.
struct ViewedVolume {
  MeshInput input;
  std::shared_ptr<const std::vector<Volume>> volumes;  ///< as read
  std::vector<std::uint16_t> material;                 ///< per voxel
  ValueSpread spread;                                  ///< of a scalar volume

  /// World coordinates of a position in voxels: (0, 0, 0) is the first voxel's centre.
  Vec3d to_world(const Vec3d& voxel) const;
  Vec3d to_voxels(const Vec3d& world) const;
  /// What lengths in voxels are multiples of: the smallest spacing, world units.
  double voxel_length() const { return std::min({input.spacing.x, input.spacing.y, input.spacing.z}); }
  /// The index of the voxel that contains a world position; none beyond the volume.
  std::optional<std::size_t> index_at(const Vec3d& world) const { return index_of(to_voxels(world)); }
  /// The same of a position in voxels.
  std::optional<std::size_t> index_of(const Vec3d& voxel) const;
  double value(std::size_t index, std::size_t file = 0) const;
  /// Corners of the box around the voxels that are not outside, world: corner k has the far side of axis a where bit a
  /// is set.
  std::vector<Vec3d> corners() const;
  /// The same of the box around all voxels.
  std::vector<Vec3d> box() const;

 private:
  std::vector<Vec3d> corners_of(const Vec3d& low, const Vec3d& high) const;
};

/// A plane of the volume: a parallelogram in the world.
struct SlicePlane {
  Vec3d corner, across, up;  ///< the two edges from the corner
  Int3 first;                ///< voxel at the corner
  int across_axis, up_axis;  ///< of the volume; -1: in another direction than its axes
  int width, height;         ///< voxels along the edges

  bool is_oblique() const { return across_axis < 0; }

  /// Centres of `columns` x `rows` pixels, row by row from the corner.
  std::vector<Vec3d> positions(int columns, int rows) const;
};

/// The plane across the volume's axis that runs most along the world's `axis` (0..2), at a share of the volume.
SlicePlane slice_plane(const MeshInput& input, int axis, double at);

/// The plane through the centres of the voxels of one layer along an axis of the volume; or between two layers.
SlicePlane layer_plane(const MeshInput& input, int axis, double layer);

/// The rectangle of a plane in any direction that contains all of the plane within the volume; none where the plane
/// misses the volume.
std::optional<SlicePlane> slice_plane(const ViewedVolume& volume, const WorldPlane& plane);

/// That of the knob `slice`, with `clip_planes` for `plane`; none: there is none.
std::optional<SlicePlane> wanted_slice(const ViewedVolume& volume, const ViewSettings& view);

/// A pixel per voxel: materials in the colours of `palette`, or the values of a scalar volume by the map, which runs
/// from `low` to `high`. Row 0 is at the corner. In other directions than the volume's axes, values are interpolated
/// linearly, and pixels beyond the volume are transparent.
Image volume_slice(const ViewedVolume& volume, const SlicePlane& plane, std::span<const Color> palette,
                   const Colormap& map, double low, double high);

/// The same for a plane along the volume's axes, with the materials of a scalar volume instead of its values.
Image material_slice(const ViewedVolume& volume, const SlicePlane& plane, std::span<const Color> palette);

/// Values as colours; what is no number is transparent, infinity has the last colour.
Image colour_values(const std::vector<float>& values, int width, int height, double low, double high,
                    const Colormap& map);
/// Material numbers as colours; what is no number is transparent.
Image colour_materials(const std::vector<float>& materials, int width, int height, std::span<const Color> palette);

}  // namespace nacre
