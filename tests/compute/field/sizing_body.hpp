// Nacre: test bodies for the sizing field: slope, medial balls, clamps, counts.
#pragma once

#include "compute/particles/embedding_seeds.hpp"
#include "tests/compute/field/all_cells.hpp"
#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

/// All fields of a volume, and its embedding.
struct Fields {
  MaterialBricks bricks;
  DistanceField distance;
  SizingField size;
};

template <class Backend>
Fields fields_of(Executor<Backend>& exec, const MeshVolume& volume, const SizingRule& rule) {
  Fields f;
  f.bricks = bricks_of(exec, volume);
  f.distance = distance_field(exec, f.bricks, 0.5f * rule.min_size, std::min(rule.reach() + 2, 64.0f));
  f.size = sizing_field(exec, f.distance, rule);
  return f;
}

inline SizingRule sizing_rule(float epsilon, float delta, float low, float high, bool curvature = false) {
  SizingRule rule;
  rule.epsilon = epsilon, rule.delta = delta, rule.min_size = low, rule.max_size = high, rule.curvature = curvature;
  return rule;
}

struct ReadSize {
  SizingFieldView size;
  const Vec3f* point;
  float* h;
  NACRE_HD void operator()(std::int64_t i) const { h[i] = size(point[i]); }
};

template <class Backend>
std::vector<float> sizes_at(Executor<Backend>& exec, const SizingField& size, const std::vector<Vec3f>& points) {
  Arena::Scope scope(exec.arena());
  Array<Vec3f> in = exec.arena().template temporary<Vec3f>(points.size());
  in.upload(points);
  Array<float> out = exec.arena().template temporary<float>(points.size());
  exec.for_each(std::int64_t(points.size()), ReadSize{size.view(), in.data(), out.data()});
  return out.download();
}

/// Two balls of different size, close to each other, and a plate.
inline MeshVolume uneven_volume() {
  return label_volume({40, 28, 26}, 4, [](const Vec3d& p) {
    return length(p - Vec3d(12, 13, 13)) < 9     ? 1
           : length(p - Vec3d(26.5, 13, 12)) < 4 ? 2
           : p.x > 33 && p.x < 36                ? 3
                                                 : 0;
  });
}

template <class Backend>
void TheSlopeIsBounded(Executor<Backend>& exec) {
  for (const float delta : {0.2f, 0.5f}) {
    const std::size_t mark = exec.arena().mark();
    const Fields f = fields_of(exec, uneven_volume(), sizing_rule(0.5f, delta, 0.4f, 6));
    const std::vector<float> h = sizes_of_cells(exec, f.size);
    const Lattice& l = f.size.lattice();
    const std::int64_t step[3] = {1, l.cells.x, std::int64_t(l.cells.x) * l.cells.y};
    float least = 1e9f, most = 0;
    for (std::int64_t i = 0; i < l.count(); ++i) {
      least = std::min(least, h[i]), most = std::max(most, h[i]);
      for (int axis = 0; axis < 3; ++axis)
        if (l.cell(i)[axis] + 1 < l.cells[axis]) {
          ASSERT_LE(std::fabs(h[i] - h[i + step[axis]]), delta * l.spacing[axis] * 1.005f + 2e-3f) << i;
        }
    }
    EXPECT_GT(most, 3 * least);  // there was something to limit
    exec.arena().rewind(mark);
  }
}

/// What a cell may have at most beside neighbours that have these values, by bisection.
inline double limited_by(const std::vector<double>& low, const Vec3f& spacing, double delta) {
  double below = std::min({low[0], low[1], low[2]}), above = below + delta * 10;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (below + above);
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) square += std::pow(std::max(x - low[axis], 0.0) / spacing[axis], 2);
    (square < delta * delta ? below : above) = x;
  }
  return below;
}

/// Every cell has as much as the slope allows beside its neighbours, looked at one after the other until none changes;
/// where cells are not stored, as if they had more.
template <class Backend>
void SizesGrowAsFastAsTheyMay(Executor<Backend>& exec) {
  const std::size_t mark = exec.arena().mark();
  const Lattice lattice{{29, 20, 18}, {1, 1.5f, 2}};
  const float delta = 0.3f, far = 20;
  std::vector<std::uint32_t> stored(lattice.tile_count(), 1);
  stored[lattice.tile_number({1, 0, 0})] = stored[lattice.tile_number({1, 1, 1})] = 0;
  const LatticeTiles tiles = detail::store_tiles(exec, lattice, [&](std::uint32_t* marks) {
    exec.device().copy_to_device(marks, stored.data(), stored.size() * 4);
  });
  std::vector<float> start(tiles.slots(), far);
  std::vector<double> expected(lattice.count(), far);
  const std::vector<std::uint32_t> slot_of = tiles.stored.download();
  const auto tile_of = [&](const Int3& c) { return slot_of[lattice.tile_number({c.x / 8, c.y / 8, c.z / 8})]; };
  const auto slot = [&](const Int3& c) {
    return std::size_t(tile_of(c)) * Lattice::tile_cells + Lattice::place(c.x % 8, c.y % 8, c.z % 8);
  };
  for (const Int3& c : {Int3(2, 3, 4), Int3(27, 18, 1), Int3(20, 2, 16), Int3(3, 4, 4)}) {
    const float h = 0.5f + 0.25f * float(c.x % 3);
    start[slot(c)] = h;
    expected[lattice.number(c.x, c.y, c.z)] = h;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::int64_t i = 0; i < lattice.count(); ++i) {
      const Int3 c = lattice.cell(i);
      if (tile_of(c) == none) continue;
      std::vector<double> low(3, 1e9);
      for (int k = 0; k < 6; ++k) {
        Int3 next = c;
        next[k / 2] += k % 2 ? 1 : -1;
        if (lattice.holds(next) && tile_of(next) != none)
          low[k / 2] = std::min(low[k / 2], expected[lattice.number(next.x, next.y, next.z)]);
      }
      const double h = limited_by(low, lattice.spacing, delta);
      if (h > expected[i] - 1e-9) continue;
      expected[i] = h;
      changed = true;
    }
  }
  Array<float> h = exec.arena().template permanent<float>(start.size());
  h.upload(start);
  EXPECT_FALSE(limit_slope(exec, tiles, delta, far, h));  // cells beside those that are not stored became smaller
  const std::vector<float> limited = h.download();
  double most = 0;
  for (std::int64_t i = 0; i < lattice.count(); ++i) {
    const Int3 c = lattice.cell(i);
    if (tile_of(c) == none) continue;
    EXPECT_NEAR(limited[slot(c)], expected[i], 0.01) << i;
    most = std::max(most, expected[i]);
  }
  EXPECT_GT(most, 5);
  EXPECT_LT(most, far);  // every cell was limited
  exec.arena().rewind(mark);
}

/// h on the surface of a sphere of radius R inside of a large volume: epsilon R, whichever side is looked at.
template <class Backend>
void AMedialBallFillsASphere(Executor<Backend>& exec) {
  const Vec3d c(13.2, 12.7, 13.1);
  for (const double radius : {5.2, 8.3}) {
    const std::size_t mark = exec.arena().mark();
    const Fields f = fields_of(exec, scalar_volume({27, 26, 27}, ball(c, radius)), sizing_rule(0.3f, 0.05f, 0.4f, 8));
    std::vector<Vec3f> points;
    for (const Vec3d& n : even_directions(200)) points.push_back(in_fields(c + n * radius));
    const std::vector<float> h = sizes_at(exec, f.size, points);
    EXPECT_NEAR(median_of(h), 0.3 * radius, 0.05 * 0.3 * radius);
    EXPECT_GT(*std::min_element(h.begin(), h.end()), 0.85 * 0.3 * radius);
    EXPECT_LT(*std::max_element(h.begin(), h.end()), 1.1 * 0.3 * radius);
    exec.arena().rewind(mark);
  }
}

template <class Backend>
void AMedialBallFillsHalfASlab(Executor<Backend>& exec) {
  for (const double thickness : {3.0, 6.4}) {
    const std::size_t mark = exec.arena().mark();
    const auto slab = [&](const Vec3d& p) { return 0.5 * thickness - std::fabs(p.z - 14.1); };
    const Fields f = fields_of(exec, scalar_volume({44, 44, 29}, slab), sizing_rule(0.5f, 0.3f, 0.4f, 8));
    std::vector<Vec3f> points;
    for (int k = 0; k < 100; ++k)
      points.push_back(in_fields({18 + 8 * uniform_random(1, k, 0), 18 + 8 * uniform_random(1, k, 1),
                                  14.1 + (k % 2 ? 0.5 : -0.5) * thickness}));
    for (const float h : sizes_at(exec, f.size, points)) {
      EXPECT_GE(h, 0.95 * 0.25 * thickness);
      EXPECT_LE(h, 1.05 * 0.25 * thickness + 0.5 * 0.3);  // known at centres of voxels, up to half a voxel off
    }
    exec.arena().rewind(mark);
  }
}

/// The field reaches 64 voxels, and the largest ball that would count 80: a thin slab is seen all the same.
template <class Backend>
void AThinSlabInAWideVolumeIsThin(Executor<Backend>& exec) {
  const auto slab = [&](const Vec3d& p) { return 1.5 - std::fabs(p.z - 6.1); };
  const Fields f = fields_of(exec, scalar_volume({12, 12, 170}, slab), sizing_rule(0.1f, 0.3f, 0.4f, 8));
  const std::vector<float> h = sizes_at(exec, f.size, {in_fields({6, 6, 4.6}), in_fields({6, 6, 7.6})});
  for (const float size : h) EXPECT_LT(size, 0.7f);  // 0.4, and what the lattice makes of it
}

/// Particles farther apart than the volume is wide: one cell of the lattice would not do for interpolation.
template <class Backend>
void SizesBeyondTheVolumeAreHeld(Executor<Backend>& exec) {
  const Vec3d c(13.2, 12.7, 3.5);
  const Fields f = fields_of(exec, scalar_volume({27, 26, 8}, ball(c, 3.1)), sizing_rule(0.5f, 0.4f, 60, 60));
  std::vector<Vec3f> points;
  for (const Vec3d& n : even_directions(20)) points.push_back(in_fields(c + n * 3.1));
  for (const float h : sizes_at(exec, f.size, points)) EXPECT_NEAR(h, 60, 1e-3);
}

template <class Backend>
void SizesAreClamped(Executor<Backend>& exec) {
  const Vec3d c(13.2, 12.7, 13.1);
  const MeshVolume volume = scalar_volume({27, 26, 27}, ball(c, 8.3));
  std::vector<Vec3f> points;
  for (const Vec3d& n : even_directions(100)) points.push_back(in_fields(c + n * 8.3));
  for (const float h : sizes_at(exec, fields_of(exec, volume, sizing_rule(0.5f, 0.4f, 0.5f, 1.25f)).size, points))
    EXPECT_NEAR(h, 1.25f, 1e-4f);
  for (const float h : sizes_at(exec, fields_of(exec, volume, sizing_rule(0.1f, 0.4f, 2, 4)).size, points))
    EXPECT_NEAR(h, 2.1f, 0.11f);  // known at centres of voxels, up to half a voxel off
  // Where things are thin, the smallest size gives way, or nothing would stand on them.
  const MeshVolume dot = label_volume({17, 17, 17}, 2, [](const Vec3d& p) { return p == Vec3d(8, 8, 8); });
  const std::vector<float> small =
      sizes_at(exec, fields_of(exec, dot, sizing_rule(0.5f, 0.4f, 2, 4)).size, {in_fields({8, 8, 8})});
  EXPECT_LT(small[0], 1);
  EXPECT_GE(small[0], SizingRule::smallest);
}

template <class Backend>
void CurvatureAddsABound(Executor<Backend>& exec) {                                       // on the crests of a wave
  const auto wave = [&](const Vec3d& p) { return 9 + 0.8 * std::sin(0.9 * p.x) - p.z; };  // no medial ball is as small
  const MeshVolume volume = scalar_volume({30, 12, 20}, wave);
  std::vector<Vec3f> crests;
  for (int k = 1; k <= 3; ++k) crests.push_back(in_fields({(k + 0.5) * M_PI / 0.9, 6, 9 + 0.8 * (k % 2 ? -1 : 1)}));
  const double bend = 0.8 * 0.9 * 0.9;  // largest second derivative
  for (const float h : sizes_at(exec, fields_of(exec, volume, sizing_rule(0.5f, 0.4f, 0.3f, 5, true)).size, crests)) {
    EXPECT_GE(h, 0.8 * 0.5 / bend);
    EXPECT_LE(h, 1.3 * 0.5 / bend);
  }
}

template <class Backend>
double expected_of(Executor<Backend>& exec, const MeshVolume& volume, const SizingRule& rule) {
  const std::size_t mark = exec.arena().mark();
  const Fields f = fields_of(exec, volume, rule);
  const InterfaceGrid grid = embed_interfaces(exec, f.bricks, f.distance, f.size, 2);
  std::vector<std::uint8_t> order;
  for (const Junction& j : grid.junctions) order.push_back(std::uint8_t(j.order()));
  const Array<std::uint8_t> orders = exec.arena().template permanent_copy<std::uint8_t>(order);
  const double expected = expected_particles(exec, EmbeddingSeeds(grid, orders.data(), 2));
  exec.arena().rewind(mark);
  return expected;
}

/// A row of Table 3.4 in kind: smaller epsilon and delta ask for more particles.
template <class Backend>
void SmallerEpsilonAndDeltaMeanMoreParticles(Executor<Backend>& exec) {
  const MeshVolume volume = uneven_volume();
  double before = 0;
  for (const float epsilon : {0.8f, 0.5f, 0.3f}) {
    const double n = expected_of(exec, volume, sizing_rule(epsilon, 0.4f, 0.3f, 4));
    EXPECT_GT(n, 1.1 * before) << epsilon;
    before = n;
  }
  before = 0;
  for (const float delta : {0.8f, 0.4f, 0.15f}) {
    const double n = expected_of(exec, volume, sizing_rule(0.5f, delta, 0.3f, 4));
    EXPECT_GT(n, 1.02 * before) << delta;
    before = n;
  }
}

template <class Backend>
void ExpectedParticlesAreAreaOverSize(Executor<Backend>& exec) {
  const double radius = 8.3, h = 0.8;
  const double n = expected_of(exec, scalar_volume({27, 26, 27}, ball({13.2, 12.7, 13.1}, radius)),
                               sizing_rule(0.5f, 0.4f, float(h), float(h)));
  const double ideal = 4 * M_PI * radius * radius / (0.8660254 * h * h);
  EXPECT_NEAR(n, ideal, 0.02 * ideal);
}

NACRE_DEVICE_TEST(Sizing, TheSlopeIsBounded)
NACRE_DEVICE_TEST(Sizing, SizesGrowAsFastAsTheyMay)
NACRE_DEVICE_TEST(Sizing, AMedialBallFillsASphere)
NACRE_DEVICE_TEST(Sizing, AMedialBallFillsHalfASlab)
NACRE_DEVICE_TEST(Sizing, AThinSlabInAWideVolumeIsThin)
NACRE_DEVICE_TEST(Sizing, SizesBeyondTheVolumeAreHeld)
NACRE_DEVICE_TEST(Sizing, SizesAreClamped)
NACRE_DEVICE_TEST(Sizing, CurvatureAddsABound)
NACRE_DEVICE_TEST(Sizing, SmallerEpsilonAndDeltaMeanMoreParticles)
NACRE_DEVICE_TEST(Sizing, ExpectedParticlesAreAreaOverSize)

}  // namespace nacre::test
