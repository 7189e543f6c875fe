// Nacre: particles once for each surface that they are on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/star.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// A particle on each of the surfaces that it belongs to, once per surface: an item. Items ascend by surface, then by
/// particle. What the spans show belongs to others.
struct StarItems {
  std::span<const Vec3d> position, normal;  ///< the unit normal towards the lower material
  std::span<const double> size;
  std::span<const std::uint32_t> particle;
  std::span<const std::uint32_t> surface;         ///< number of its surface
  std::span<const std::uint32_t> next, previous;  ///< on a rim: items beside it on the same surface, which lies to the
                                                  ///< left of the rim, seen against the normal; `none` off the rims
  std::vector<MaterialPair> materials;            ///< per surface, ascending
  std::vector<std::uint32_t> first;               ///< per surface and one more: its first item
  std::vector<std::uint32_t> broken;              ///< particles at which a rim begins or ends; ascending

  std::size_t count() const { return position.size(); }
  /// For the host.
  StarItemsView view() const {
    return {position.data(), normal.data(), size.data(),     particle.data(),
            surface.data(),  next.data(),   previous.data(), first.data()};
  }
};

}  // namespace nacre
