// Nacre: an image of wanted sizes in the voxels that fields are computed in.
#include "compute/pipeline/size_wishes.hpp"

#include <algorithm>
#include <string>

#include "compute/device/error.hpp"
#include "compute/pipeline/volume_frame.hpp"

namespace nacre {
namespace {

constexpr double smallest_wish = 0.05, largest_wish = 1000;  // voxels, as those of `max_size`

/// Whether a point of the world is within the volume or at most `beyond` (world units) beside it.
bool near_volume(const MeshVolume& volume, const Vec3d& world, double beyond) {
  const Vec3d index = world_to_index(world, volume.origin, volume.spacing, volume.axes);
  for (int axis = 0; axis < 3; ++axis) {
    const double more = 0.5 + beyond / volume.spacing[axis];
    if (index[axis] < -more || index[axis] > volume.dims[axis] - 1 + more) return false;
  }
  return true;
}

}  // namespace

SizeWishes size_wishes(const MeshVolume& volume) {
  const SizeImage& image = *volume.sizes;
  const VolumeFrame frame(volume);
  SizeWishes wishes;
  wishes.dims = image.dims;
  wishes.origin = Vec3f(frame.to_voxels(image.origin));
  const Vec3d zero = frame.to_world(Vec3d());
  for (int k = 0; k < 3; ++k) {
    Vec3d row;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit;
      unit[axis] = 1;
      row[axis] = dot(frame.to_world(unit) - zero, image.axes[std::size_t(k)]) / image.spacing[k];
    }
    wishes.row[k] = Vec3f(row);
  }
  wishes.size.resize(image.size.size());
  const double beyond = std::max({image.spacing.x, image.spacing.y, image.spacing.z});
  wishes.least = float(largest_wish), wishes.most = 0;
  std::size_t at = 0;
  for (int k = 0; k < image.dims.z; ++k)
    for (int j = 0; j < image.dims.y; ++j)
      for (int i = 0; i < image.dims.x; ++i, ++at) {
        if (!(image.size[at] > 0)) continue;
        const double size = std::min(image.size[at] / frame.unit, largest_wish);
        wishes.size[at] = float(size);
        const Vec3d world = index_to_world(Vec3d(i, j, k), image.origin, image.spacing, image.axes);
        if (!near_volume(volume, world, beyond)) continue;
        if (size < smallest_wish)
          throw Error("the image of sizes asks for " + std::to_string(image.size[at]) + " at voxel " +
                          std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k),
                      "that is less than a twentieth of a voxel of the volume",
                      "its values are lengths in the unit of its spacing");
        wishes.least = std::min(wishes.least, float(size));
        wishes.most = std::max(wishes.most, float(size));
      }
  if (!(wishes.most > 0))
    throw Error("the image of sizes asks for nothing", "it has no value above 0 within the volume that is meshed",
                "both must have the same origin and axes in the world");
  return wishes;
}

}  // namespace nacre
