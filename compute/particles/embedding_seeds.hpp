// Nacre: seeds from the embedding (ch. 4): the closest points of the cells along an interface.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/embedding/build_interface_grid.hpp"
#include "compute/math/morton.hpp"
#include "compute/particles/seed.hpp"

namespace nacre {

/// Cells along the interfaces of one junction order, as a source of seeds. By the coarea formula a cell of edge c whose
/// centre is d < 1 cells away stands for c^2 (1 - d) of a surface's area, or 3 c (1 - d) / pi of a curve's length.
class EmbeddingSeeds {
 public:
  /// `order_of`: per interface, on the device.
  EmbeddingSeeds(const InterfaceGrid& grid, const std::uint8_t* order_of, int order)
      : grid_(grid.view()),
        order_of_(order_of),
        brick_coarse_(grid.brick_coarse.data()),
        sites_(grid.cells()),
        order_(order) {}

  std::int64_t sites() const { return sites_; }
  NACRE_HD int order() const { return order_; }
  NACRE_HD std::uint32_t interface(std::int64_t i) const { return grid_.brick_interface[i / 64]; }
  NACRE_HD std::uint64_t code(std::int64_t i) const { return morton(cell(i)); }

  NACRE_HD float share(std::int64_t i) const {
    if (order_of_[interface(i)] != order_) return 0;
    const Float4 o = store(load(grid_.cell[i])), d = grid_.direction(i);
    if (!(o.w >= 0) || !(d.w > 0)) return 0;
    const Vec3f r(o.x, o.y, o.z);
    const float cell = 1 / grid_.cells_per_voxel;
    const float away = length(r);
    if (!(away < 1)) return 0;
    return order_ == 2 ? cell * cell * (1 - away) * hexagonal_density / (d.w * d.w)
                       : 3 * cell * (1 - away) / (pi * d.w);
  }

  NACRE_HD SeedSite site(std::int64_t i) const {
    const Float4 o = store(load(grid_.cell[i])), d = grid_.direction(i);
    return {cell_centre(cell(i)) + Vec3f(o.x, o.y, o.z), {d.x, d.y, d.z}, d.w, grid_.cells_per_voxel};
  }

 private:
  NACRE_HD Int3 cell(std::int64_t i) const {
    const std::uint32_t c = brick_coarse_[i / 64];
    const int k = int(i % 64);
    const Int3 b{int(c % grid_.coarse.x), int(c / grid_.coarse.x % grid_.coarse.y),
                 int(c / grid_.coarse.x / grid_.coarse.y)};
    return b * Int3(4) + Int3(k % 4, k / 4 % 4, k / 16);
  }

  InterfaceGridView grid_;
  const std::uint8_t* order_of_;
  const std::uint32_t* brick_coarse_;
  std::int64_t sites_;
  int order_;
};

}  // namespace nacre
