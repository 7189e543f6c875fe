// Nacre: items that a test makes one by one.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/star_items.hpp"

namespace nacre::test {

struct OwnItems {
  std::vector<Vec3d> position, normal;
  std::vector<double> size;
  std::vector<std::uint32_t> particle, surface, next, previous, first;
  std::vector<MaterialPair> materials;

  std::size_t count() const { return position.size(); }
  StarItems items() const { return {position, normal, size, particle, surface, next, previous, materials, first, {}}; }
  StarItemsView view() const {
    return {position.data(), normal.data(), size.data(),     particle.data(),
            surface.data(),  next.data(),   previous.data(), first.data()};
  }
};

}  // namespace nacre::test
