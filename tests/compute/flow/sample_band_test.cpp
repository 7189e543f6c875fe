// Nacre: tests of interpolation among the surface cells of a band.
#include "compute/flow/sample_band.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <vector>

namespace nacre {
namespace {

/// A band whose surface cells are a list on the host.
struct ListedBand {
  std::map<std::array<int, 3>, CellIndex> cells;

  void add(const Int3& c) { cells.emplace(std::array{c.x, c.y, c.z}, cells.size()); }

  struct Cursor {
    const ListedBand& band;
    explicit Cursor(const ListedBand& b) : band(b) {}
    unsigned eight_surface(const Int3& first, CellIndex at[8]) const {
      unsigned there = 0;
      for (int k = 0; k < 8; ++k) {
        const auto found = band.cells.find({first.x + (k & 1), first.y + (k >> 1 & 1), first.z + (k >> 2)});
        at[k] = found == band.cells.end() ? no_cell : found->second;
        there |= unsigned(at[k] != no_cell) << k;
      }
      return there;
    }
  };
};

TEST(SampleBand, IsLinearWhereAllEightAreThere) {
  ListedBand band;
  std::vector<float> values;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) {
        band.add({x, y, z});
        values.push_back(float(2 * (x + 0.5) - (y + 0.5) + 3 * (z + 0.5)));
      }
  EXPECT_NEAR(sample_band(band, values.data(), {{1, 1, 0}, {0.2f, 0.8f, 0.9f}}, -9), 2 * 1.2 - 1.8 + 3 * 0.9, 1e-5);
  // The same point told from another cell.
  EXPECT_NEAR(sample_band(band, values.data(), {{2, 0, 1}, {-0.8f, 1.8f, -0.1f}}, -9), 2 * 1.2 - 1.8 + 3 * 0.9, 1e-5);
}

TEST(SampleBand, CellsThatAreNotThereHaveNoWeight) {
  ListedBand band;
  band.add({4, 4, 4});
  band.add({5, 4, 4});
  const float values[] = {10, 20};
  // A quarter of the way from the first centre to the second, and off to a side where there are none.
  EXPECT_NEAR(sample_band(band, values, {{4, 4, 4}, {0.75f, 0.9f, 0.7f}}, -9), 12.5, 1e-5);
  EXPECT_NEAR(sample_band(band, values, {{4, 4, 4}, {0.1f, 0.9f, 0.7f}}, -9), 10, 1e-5);
  EXPECT_EQ(sample_band(band, values, {{4, 7, 4}, {0.5f, 0.5f, 0.5f}}, -9), -9);
}

TEST(SampleBand, IsAsExactFarFromTheOrigin) {
  ListedBand band;
  const int far = (1 << 20) - 3;
  band.add({far, far, far});
  band.add({far + 1, far, far});
  const float values[] = {10, 20};
  EXPECT_NEAR(sample_band(band, values, band_point({far + 0.753, far + 0.5, far + 0.5}), -9), 12.53, 1e-5);
}

}  // namespace
}  // namespace nacre
