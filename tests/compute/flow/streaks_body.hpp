// Nacre: test bodies for streaks along the present flow, on the grid and on the octree of bricks.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "compute/embedding/build_brick_octree.hpp"
#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "compute/flow/streaks.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"

namespace nacre::test {

/// A mesh in texture cells, with a vector and a normal per triangle corner: neighbours may differ.
struct FlowSheet {
  Mesh mesh;
  std::vector<Vec3f> vectors;  ///< one per point of the mesh
  std::vector<Vec3f> normals;  ///< one per corner

  /// Adds triangles that flow as one.
  void add(const Mesh& part, const Vec3f& flow) {
    mesh.add(part);
    vectors.resize(mesh.points.size(), flow);
    for (std::size_t t = normals.size() / 3; t < mesh.triangles.size(); ++t) {
      const Corners c = mesh.corners(t);
      normals.insert(normals.end(), 3, Vec3f(normalized(cross(c.b - c.a, c.c - c.a))));
    }
  }
};

/// Writes down where a surface cell is.
struct NotePosition {
  Int3* positions;
  NACRE_HD void operator()(CellIndex s, const Int3& position) const { positions[s] = position; }
};

/// What was made of a texture, per surface cell.
struct DrawnStreaks {
  std::vector<Int3> position;
  std::vector<StreakCell> cells;
  std::vector<float> value, streaks;

  std::size_t at(const Int3& p) const {
    return std::size_t(std::find(position.begin(), position.end(), p) - position.begin());
  }
};

/// How a texture is drawn: what each cell's value is; how far it is convolved.
template <class Texture>
struct StreakRecipe {
  Texture value;        ///< value(Int3), from 1/2
  int reach = 7;        ///< cells, each way
  bool smooth = false;  ///< along the flow, afterwards
};

/// `marked`: the same surface for what is not computed with several cells at a time.
template <class Backend, class Marked, class Surface, class Texture>
DrawnStreaks draw_on(Executor<Backend>& exec, const Marked& marked, const Surface& on, std::int64_t n,
                     const MeshView& mesh, double cell, const Vec3f* vectors, const StreakRecipe<Texture>& recipe) {
  Arena& arena = exec.arena();
  const Array<Int3> positions = arena.permanent<Int3>(n);
  for_each_surface_cell_of(exec, marked, n, NotePosition{positions.data()});
  DrawnStreaks drawn;
  drawn.position = positions.download();
  for (const Int3& p : drawn.position) drawn.value.push_back(0.5f + recipe.value(p));
  const Array<float> value = arena.permanent_copy<float>(drawn.value), streaks = arena.permanent<float>(n);
  const Array<StreakCell> cells = arena.permanent<StreakCell>(n + 1);
  const Array<PackedWeights> weights = arena.permanent<PackedWeights>(n);
  for_each_surface_cell_of(exec, marked, n,
                           DescribeStreakCells<Marked>{marked, mesh, cell, cells.data(), weights.data()});
  for_each_surface_cell_of(
      exec, marked, n, MarkStreakCells<Marked>{marked, mesh.triangles, vectors, 1e-6f, weights.data(), cells.data()});
  exec.for_each(n, GiveStreakValues{value.data(), cells.data()});
  const Array<StreakSegment> segments = arena.permanent<StreakSegment>(n + 1);
  store_on_surface(exec, on, n, FollowSegments<Surface>{on, cells.data()}, ToArray{segments.data()});
  const ConvolveAlongFlow<Surface> convolve{on, segments.data(), streak_segments(recipe.reach)};
  const Array<float> means = arena.permanent<float>(n);
  store_on_surface(exec, on, n, convolve, ToArray{(recipe.smooth ? means : streaks).data()});
  if (recipe.smooth)
    store_on_surface(exec, on, n, SmoothAlongAndSharpenAcross<Surface>{on, means.data(), cells.data()},
                     ToArray{streaks.data()});
  drawn.cells = cells.download();
  drawn.cells.pop_back();
  drawn.streaks = streaks.download();
  return drawn;
}

/// Lanes: how many streamlines run side by side.
template <class Lanes = Widest, class Backend, class Texture>
DrawnStreaks draw_on_grid(Executor<Backend>& exec, const FlowSheet& sheet, const StreakRecipe<Texture>& recipe) {
  constexpr int refine = 2;
  const std::size_t mark = exec.arena().mark();
  std::vector<Vec3d> points;
  for (const Vec3d& p : sheet.mesh.points) points.push_back(p / double(refine));
  Arena& arena = exec.arena();
  const auto triangles = std::uint32_t(sheet.mesh.triangles.size());
  const MeshView mesh{arena.permanent_copy<Vec3d>(points).data(),
                      arena.permanent_copy<Triangle>(sheet.mesh.triangles).data(),
                      arena.permanent_copy<Vec3f>(sheet.normals).data()};
  const Vec3f* vectors = arena.permanent_copy<Vec3f>(sheet.vectors).data();
  const ClosestPointGrid coarse = build_closest_point_grid(exec, mesh, triangles, Int3(8), 4, 4.47f);
  const RefinedGrid fine = build_refined_grid(exec, mesh, triangles, coarse, refine);
  const RefinedGridView texture = fine.view(coarse.view());
  DrawnStreaks drawn = draw_on(exec, GridSurface{texture}, GridSurfaceOf<Lanes>{texture}, fine.surface_cells, mesh,
                               1.0 / refine, vectors, recipe);
  arena.rewind(mark);
  return drawn;
}

template <class Lanes = Widest, class Backend, class Texture>
DrawnStreaks draw_on_bricks(Executor<Backend>& exec, const FlowSheet& sheet, const StreakRecipe<Texture>& recipe) {
  const std::size_t mark = exec.arena().mark();
  Arena& arena = exec.arena();
  const MeshView mesh{arena.permanent_copy<Vec3d>(sheet.mesh.points).data(),
                      arena.permanent_copy<Triangle>(sheet.mesh.triangles).data(),
                      arena.permanent_copy<Vec3f>(sheet.normals).data()};
  const Vec3f* vectors = arena.permanent_copy<Vec3f>(sheet.vectors).data();
  const BrickOctree tree = build_brick_octree(exec, mesh, std::uint32_t(sheet.mesh.triangles.size()), 3, 3.6);
  const BrickOctreeView view = tree.view();
  DrawnStreaks drawn = draw_on(exec, BrickSurface{view}, BrickSurfaceOf<Lanes>{view}, std::int64_t(view.surface_cells),
                               mesh, 1.0, vectors, recipe);
  arena.rewind(mark);
  return drawn;
}

/// Runs `check(drawn)` on both embeddings.
template <class Backend, class Texture, class Check>
void on_both(Executor<Backend>& exec, const FlowSheet& sheet, const StreakRecipe<Texture>& recipe, const Check& check) {
  {
    SCOPED_TRACE("grid");
    check(draw_on_grid(exec, sheet, recipe));
  }
  SCOPED_TRACE("bricks");
  check(draw_on_bricks(exec, sheet, recipe));
}

inline constexpr int first_x = 16, last_x = 45, middle_y = 24, layer = 18;

/// Cells first_x .. last_x by 16 .. 31 in one layer, the surface `height` above their centres.
inline Mesh flat_part(int from, int to, double height = 0) {
  return sheet({from + 0.01, 16.01, layer + 0.5 + height}, {to - from + 0.98, 0, 0}, {0, 15.98, 0}, 1);
}

/// 0 but for one cell.
struct Impulse {
  static constexpr float value = 0.125f;  // sums of values are stored in units of 1 / 1024
  Int3 position;
  float operator()(const Int3& p) const { return p == position ? value : 0.0f; }
};

template <class Backend>
void CellsKnowFlowAndPlane(Executor<Backend>& exec) {
  FlowSheet sheet;
  sheet.add(flat_part(first_x, last_x, 0.3), {0.3f, 0.4f, 7});
  on_both(exec, sheet, StreakRecipe{Impulse{}}, [&](const DrawnStreaks& drawn) {
    ASSERT_EQ(drawn.cells.size(), 30u * 16u);
    for (std::size_t s = 0; s < drawn.cells.size(); ++s) {
      const StreakCells<Single> cell = load_streak_cells(drawn.cells.data(), s, true);
      EXPECT_LT(length(cell.direction() - Vec3f(0.6f, 0.8f, 0)), 0.002f) << "in the surface";
      EXPECT_EQ(cell.surface.normal(), Vec3f(0, 0, 1));
      EXPECT_NEAR(cell.surface.plane(), 0.3, 0.004);
    }
  });
}

template <class Backend>
void AnImpulseSpreadsEvenlyAlongItsLine(Executor<Backend>& exec) {
  FlowSheet sheet;
  sheet.add(flat_part(first_x, last_x), {2, 0, 0});
  const StreakRecipe<Impulse> recipe{{{30, middle_y, layer}}};
  on_both(exec, sheet, recipe, [&](const DrawnStreaks& drawn) {
    const float share = Impulse::value / float(2 * recipe.reach + 1);
    for (std::size_t s = 0; s < drawn.position.size(); ++s) {
      const Int3 p = drawn.position[s];
      const bool reached = p.y == middle_y && std::abs(p.x - 30) <= recipe.reach;
      ASSERT_NEAR(drawn.streaks[s], 0.5f + (reached ? ConvolveAlongFlow<GridSurface>::gain * share : 0), 1e-6)
          << p.x << ' ' << p.y;
    }
  });
}

/// Smoothed afterwards, it reaches two cells farther, and its ends are soft; the lines beside it become darker.
template <class Backend>
void SmoothingSoftensTheEndsOfALineAndDarkensItsSides(Executor<Backend>& exec) {
  FlowSheet sheet;
  sheet.add(flat_part(first_x, last_x), {2, 0, 0});
  const StreakRecipe<Impulse> recipe{{{30, middle_y, layer}}, 7, true};
  const float across = SmoothAlongAndSharpenAcross<GridSurface>::across;
  on_both(exec, sheet, recipe, [&](const DrawnStreaks& drawn) {
    const float share = Impulse::value / float(2 * recipe.reach + 1);
    for (std::size_t s = 0; s < drawn.position.size(); ++s) {
      const Int3 p = drawn.position[s];
      const int beyond = std::abs(p.x - 30) - recipe.reach, beside = std::abs(p.y - middle_y);
      const float part_of_the_end[] = {0.875f, 0.625f, 0.375f, 0.125f};  // of the weights 1, 2, 2, 2, 1
      const float line = beyond < -1 ? 1 : beyond > 2 ? 0 : part_of_the_end[beyond + 1];
      const float part = beside == 0 ? (1 + 2 * across) * line : beside == 1 && beyond <= 0 ? -across : 0;
      ASSERT_NEAR(drawn.streaks[s], 0.5f + ConvolveAlongFlow<GridSurface>::gain * share * part, 5e-4)
          << p.x << ' ' << p.y;
    }
  });
}

/// A mean of values that are all the same is that value, at the rim too; from the far side of a gap nothing comes.
template <class Backend>
void StreaksEndAtTheRim(Executor<Backend>& exec) {
  FlowSheet sheet;
  sheet.add(flat_part(first_x, 24), {1, 0, 0});
  sheet.add(flat_part(36, last_x), {1, 0, 0});
  const auto halves = [](const Int3& p) { return p.x <= 24 ? 0.0625f : -0.0625f; };
  on_both(exec, sheet, StreakRecipe<decltype(halves)>{halves, 20}, [&](const DrawnStreaks& drawn) {
    for (std::size_t s = 0; s < drawn.position.size(); ++s)
      ASSERT_NEAR(drawn.streaks[s], 0.5f + 4 * halves(drawn.position[s]), 1e-6) << drawn.position[s].x;
  });
}

/// Both halves of a plane flow towards the line between them. A segment follows where it does not end on the way, and
/// has the values on its own side.
template <class Backend>
void StreaksEndWhereTheFlowTurnsBack(Executor<Backend>& exec) {
  constexpr int last = 30;
  FlowSheet sheet;
  sheet.add(flat_part(first_x, last), {1, 0, 0});
  sheet.add(flat_part(last + 1, last_x), {-1, 0, 0});
  const StreakRecipe<Impulse> recipe{{{last - 1, middle_y, layer}}};
  on_both(exec, sheet, recipe, [&](const DrawnStreaks& drawn) {
    for (int x = first_x + segment_length + segment_half; x < 41; ++x) {
      int values = 0;
      bool reached = false;
      for (const int middle : {x - segment_length, x, x + segment_length}) {
        if (middle > last) continue;
        const int lowest = middle - segment_half, highest = std::min(middle + segment_half, last);
        values += highest - lowest + 1;
        reached |= x <= last && lowest <= last - 1 && last - 1 <= highest;
      }
      const float share = reached ? Impulse::value / float(values) : 0;
      EXPECT_NEAR(drawn.streaks[drawn.at({x, middle_y, layer})], 0.5f + 4 * share, 1e-6) << x;
    }
  });
}

/// The two sides of a roof flow up to its ridge: neither sees the other's values.
template <class Backend>
void StreaksEndAtACrease(Executor<Backend>& exec) {
  const double rise = std::tan(pi / 6);
  const Vec3d along{0, 15.98, 0}, up{16, 0, 16 * rise}, down{16, 0, -16 * rise}, eave{15.2, 16.01, 17.4};
  FlowSheet roof;
  roof.add(sheet(eave, up, along, 1), Vec3f(up));
  roof.add(sheet(eave + up, down, along, 1), Vec3f(-down));
  const float ridge = float(eave.x + up.x);
  const auto sides = [=](const Int3& p) { return float(p.x) + 0.5f < ridge ? 0.1f : -0.1f; };
  on_both(exec, roof, StreakRecipe<decltype(sides)>{sides, 8}, [&](const DrawnStreaks& drawn) {
    for (std::size_t s = 0; s < drawn.position.size(); ++s) {
      const Int3 p = drawn.position[s];
      if (std::fabs(float(p.x) + 0.5f - ridge) < 2) continue;
      ASSERT_NEAR(drawn.streaks[s], 0.5f + 4 * sides(p), 0.1) << p.x;
    }
  });
}

template <class Backend>
void ACellWithoutFlowKeepsItsOwnValue(Executor<Backend>& exec) {
  FlowSheet sheet;
  sheet.add(flat_part(first_x, last_x), {0, 0, 0});
  const auto value = [](const Int3& p) { return float((7 * p.x + 3 * p.y) % 5 - 2) / 64; };
  on_both(exec, sheet, StreakRecipe<decltype(value)>{value}, [&](const DrawnStreaks& drawn) {
    for (std::size_t s = 0; s < drawn.position.size(); ++s) {
      EXPECT_EQ(drawn.cells[s].direction, 0u);
      const float gain = ConvolveAlongFlow<GridSurface>::gain;
      ASSERT_NEAR(drawn.streaks[s], 0.5f + gain * value(drawn.position[s]), 1e-5);
    }
  });
}

/// A ball turns about a slanted axis, and values grow along it: a streak that keeps to its line has the value of its
/// cell. On the way it changes from the segment of one cell to that of another.
template <class Backend>
void LongStreaksKeepToTheirLines(Executor<Backend>& exec) {
  const Vec3d centre{30.2, 30.1, 29.7}, axis = normalized(Vec3d(1, 2, 3));
  FlowSheet ball;
  ball.add(sphere(centre, 20.3, 24), {});
  for (std::size_t i = 0; i < ball.vectors.size(); ++i)
    ball.vectors[i] = Vec3f(cross(axis, ball.mesh.points[i] - centre));
  constexpr float slope = 1.0f / 256;
  const auto along = [&](const Int3& p) { return slope * float(dot(axis, Vec3d(p) + Vec3d(0.5) - centre)); };
  on_both(exec, ball, StreakRecipe<decltype(along)>{along, 27}, [&](const DrawnStreaks& drawn) {
    double squares = 0, worst = 0;
    for (std::size_t s = 0; s < drawn.streaks.size(); ++s) {
      const double strays = (drawn.streaks[s] - 0.5f) / ConvolveAlongFlow<GridSurface>::gain - along(drawn.position[s]);
      squares += strays * strays;
      worst = std::max(worst, std::fabs(strays));
    }
    EXPECT_LT(std::sqrt(squares / double(drawn.streaks.size())), 0.4 * slope) << "cells, times the slope";
    EXPECT_LT(worst, 1.5 * slope);
  });
}

NACRE_DEVICE_TEST(Streaks, CellsKnowFlowAndPlane)
NACRE_DEVICE_TEST(Streaks, AnImpulseSpreadsEvenlyAlongItsLine)
NACRE_DEVICE_TEST(Streaks, SmoothingSoftensTheEndsOfALineAndDarkensItsSides)
NACRE_DEVICE_TEST(Streaks, StreaksEndAtTheRim)
NACRE_DEVICE_TEST(Streaks, StreaksEndWhereTheFlowTurnsBack)
NACRE_DEVICE_TEST(Streaks, StreaksEndAtACrease)
NACRE_DEVICE_TEST(Streaks, ACellWithoutFlowKeepsItsOwnValue)
NACRE_DEVICE_TEST(Streaks, LongStreaksKeepToTheirLines)

}  // namespace nacre::test
