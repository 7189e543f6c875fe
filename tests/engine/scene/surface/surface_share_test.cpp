// Nacre: a surface in shares is prepared as it is in one piece. Threads act as processes.
#include "engine/scene/surface/surface_share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <random>

#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/winding.hpp"
#include "tests/engine/scene/surface/shapes.hpp"
#include "tests/thread_ranks.hpp"

namespace nacre {
namespace {

using test::cube;
using test::icosphere;

/// What matters of a prepared surface, independent of how points are numbered.
struct Corner {
  Vec3d position;
  Vec3f normal;
  bool operator==(const Corner& other) const { return position == other.position && normal == other.normal; }
};

std::vector<Corner> corners_of(const PreparedSurface& surface, const Share* share = nullptr) {
  std::vector<Corner> corners;
  const std::size_t first = share ? share->first_triangle : 0;
  const std::size_t count = share ? share->triangles : surface.triangles.size();
  for (std::size_t c = 3 * first; c < 3 * (first + count); ++c)
    corners.push_back({surface.points[surface.triangles[c / 3][int(c % 3)]], surface.corner_normals[c]});
  return corners;
}

SurfaceSeries series_of(const Surface& surface) {
  return {"test", {0.0}, [surface](std::size_t) { return surface; }, {}};
}

struct InShares {
  std::vector<Corner> corners;
  std::vector<std::string> warnings;  ///< of the first
  std::string whole_needed;
  std::uint64_t points = 0, triangles = 0;
};

InShares prepare_in_shares(const Surface& surface, int count) {
  std::vector<InShares> each(static_cast<std::size_t>(count));
  on_ranks(count, [&](Ranks& ranks) {
    InShares& own = each[std::size_t(ranks.rank())];
    const SharedSeries shared = share_series(series_of(surface), ranks);
    const PreparedShare prepared = prepare_share(ranks, shared.series.load(0), shared.point_id, 40, &own.warnings);
    own.whole_needed = prepared.whole_needed;
    if (!own.whole_needed.empty()) return;
    own.corners = corners_of(prepared.surface, &prepared.share);
    own.points = prepared.share.all_points;
    own.triangles = prepared.share.all_triangles;
  });
  InShares all = each[0];
  for (std::size_t q = 1; q < each.size(); ++q) {
    all.corners.insert(all.corners.end(), each[q].corners.begin(), each[q].corners.end());
    EXPECT_EQ(each[q].whole_needed, all.whole_needed);
  }
  return all;
}

void expect_as_whole(const Surface& surface, const std::string& what) {
  std::vector<std::string> warnings;
  const PreparedSurface whole = prepare(surface, 40, &warnings);
  for (const int count : {1, 2, 3, 4, 7}) {
    const InShares shares = prepare_in_shares(surface, count);
    EXPECT_EQ(shares.whole_needed, "") << what;
    EXPECT_EQ(shares.triangles, whole.triangles.size()) << what;
    EXPECT_EQ(shares.points, whole.points.size()) << what;
    EXPECT_EQ(shares.warnings, warnings) << what;
    EXPECT_TRUE(shares.corners == corners_of(whole)) << what << " on " << count;
  }
}

Surface flipped_at_random(Surface surface, unsigned seed) {
  std::mt19937 random(seed);
  for (Triangle& t : surface.triangles)
    if (random() % 2) std::swap(t.b, t.c);
  return surface;
}

Surface shuffled(Surface surface, unsigned seed) {
  std::mt19937 random(seed);
  std::shuffle(surface.triangles.begin(), surface.triangles.end(), random);
  return surface;
}

/// Each triangle with points of its own.
Surface unwelded(const Surface& surface) {
  Surface apart;
  for (const Triangle& t : surface.triangles) {
    const auto first = std::uint32_t(apart.points.size());
    for (int k = 0; k < 3; ++k) apart.points.push_back(surface.points[t[k]]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return apart;
}

void add(Surface& to, Surface part, const Vec3d& shift) {
  const auto first = std::uint32_t(to.points.size());
  for (const Vec3d& p : part.points) to.points.push_back(p + shift);
  for (const Triangle& t : part.triangles) to.triangles.push_back({t.a + first, t.b + first, t.c + first});
}

/// A band of `n` squares; its ends meet, after half a turn if it is `twisted`.
Surface band(int n, bool twisted, bool closed) {
  Surface s;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * 3.14159265358979 * k / n, turn = twisted ? angle / 2 : 0;
    const Vec3d out(std::cos(angle), std::sin(angle), 0), side = out * std::sin(turn) + Vec3d(0, 0, std::cos(turn));
    s.points.push_back(out * 3.0 - side);
    s.points.push_back(out * 3.0 + side);
  }
  for (std::uint32_t k = 0; k + (closed ? 0 : 1) < std::uint32_t(n); ++k) {
    const std::uint32_t a = 2 * k, b = a + 1;
    std::uint32_t c = 2 * ((k + 1) % std::uint32_t(n)), d = c + 1;
    if (twisted && k + 1 == std::uint32_t(n)) std::swap(c, d);
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({b, d, c});
  }
  return s;
}

TEST(SurfaceInShares, IsPreparedAsInOnePiece) {
  expect_as_whole(cube(), "cube");
  expect_as_whole(icosphere(3), "sphere");
  expect_as_whole(flipped_at_random(icosphere(3), 1), "sphere wound at random");
  expect_as_whole(shuffled(flipped_at_random(icosphere(3), 2), 3), "sphere in no order");
  expect_as_whole(unwelded(flipped_at_random(icosphere(2), 4)), "sphere without common points");
  expect_as_whole(shuffled(unwelded(cube()), 5), "cube without common points");
}

TEST(SurfaceInShares, PartsAreWoundAlikeAcrossManyShares) {
  expect_as_whole(flipped_at_random(band(300, false, true), 6), "ring");
  expect_as_whole(shuffled(flipped_at_random(band(301, false, false), 7), 8), "band in no order");
  Surface several = icosphere(2);
  Surface inwards = icosphere(1);
  for (Triangle& t : inwards.triangles) std::swap(t.b, t.c);
  add(several, inwards, {3, 0, 0});
  add(several, flipped_at_random(cube(), 9), {0, 4, 0});
  add(several, band(20, false, false), {0, 0, 7});
  expect_as_whole(several, "several parts");
  expect_as_whole(shuffled(several, 10), "several parts in no order");
}

TEST(SurfaceInShares, TrianglesAreDroppedAsInOnePiece) {
  Surface s = icosphere(2);
  for (int k = 0; k < 40; ++k) s.triangles.push_back(s.triangles[std::size_t(7 * k)]);
  std::swap(s.triangles.back().a, s.triangles.back().b);
  s.points.push_back(s.points[s.triangles[5].a]);  // a needle, whose ends are at one position
  s.triangles.insert(s.triangles.begin() + 100, {std::uint32_t(s.points.size() - 1), s.triangles[5].a, 17});
  s.points.push_back((s.points[s.triangles[9].a] + s.points[s.triangles[9].b]) * 0.5);
  s.triangles.push_back({s.triangles[9].a, s.triangles[9].b, std::uint32_t(s.points.size() - 1)});
  expect_as_whole(s, "duplicates and needles");
  expect_as_whole(shuffled(s, 11), "duplicates and needles in no order");
}

TEST(SurfaceInShares, FewTrianglesLeaveSomeWithNone) {
  Surface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  s.triangles = {{0, 1, 2}, {1, 2, 3}};
  expect_as_whole(s, "two triangles");
}

TEST(SurfaceInShares, WhatIsOneSidedOrDoubledIsLeftToOnePiece) {
  EXPECT_NE(prepare_in_shares(band(60, true, true), 3).whole_needed, "");
  EXPECT_NE(prepare_in_shares(shuffled(band(60, true, true), 1), 4).whole_needed, "");
  Surface sheets = band(30, false, false);
  Surface other = sheets;
  for (Triangle& t : other.triangles) std::swap(t.b, t.c);
  add(sheets, other, {});
  sheets.arrays.push_back({"p", 1, std::vector<float>(sheets.points.size())});
  EXPECT_NE(prepare_in_shares(sheets, 3).whole_needed, "");
  sheets.arrays.clear();
  expect_as_whole(sheets, "without arrays they are duplicates");
}

TEST(SurfaceInShares, VectorsHaveTheStatisticsOfOnePiece) {
  Surface s = shuffled(icosphere(4), 12);
  PointArray normals{"n", 3, {}}, vectors{"v", 3, {}}, other{"w", 3, {}}, scalar{"p", 1, {}};
  std::mt19937 random(13);
  for (const Vec3d& p : s.points) {
    for (int k = 0; k < 3; ++k) normals.values.push_back(float(p[k]));
    for (int k = 0; k < 3; ++k) vectors.values.push_back(p.z > 0.9 ? 0 : float(random()) / 4e9f - 0.5f);
    for (int k = 0; k < 3; ++k) other.values.push_back(p.z > 0 ? 0 : float(p[(k + 1) % 3]));
    scalar.values.push_back(float(p.x * p.y));
  }
  s.arrays = {normals, vectors, other, scalar};
  Settings settings;
  settings.color = "p";
  FlowLog log;
  log.warn = log.note = [](const std::string&) {};
  for (const char* wanted : {"", "@swirl", "@rotation"}) {
    settings.vectors = wanted;
    std::string chosen;
    log.chosen = [&](const VectorChoice& choice) { chosen = choice.name + choice.reason; };
    const VectorsInTime whole = make_flow_input(series_of(s), settings, log);
    const std::string expected = chosen;
    const Camera view = preset_camera("iso");
    const Camera camera = fit_camera(view, corners_of_all_steps(whole), 300, 200);
    for (const int count : {1, 2, 5}) {
      std::atomic<int> same = 0;
      on_ranks(count, [&](Ranks& ranks) {
        FlowLog own = log;
        std::string name, why;
        own.chosen = [&](const VectorChoice& choice) { name = choice.name + choice.reason; };
        auto input = make_flow_input(share_series(series_of(s), ranks), ranks, settings, own, why);
        const VectorStatistics &a = whole.statistics(), &b = input->statistics();
        const ColourSpread &c = whole.color_spread(), &d = input->color_spread();
        const bool equal = a.normal_share == b.normal_share && a.zero_share == b.zero_share &&
                           a.max_speed == b.max_speed && a.percentile_98 == b.percentile_98 && c.low == d.low &&
                           c.high == d.high && c.least_positive == d.least_positive && c.sample == d.sample;
        same += equal && name == expected && fit_camera(view, corners_of_all_steps(*input), 300, 200) == camera;
      });
      EXPECT_EQ(same, count) << wanted;
    }
  }
}

TEST(WholeVolume, HasTheSignOfTheVolume) {
  for (const bool inwards : {false, true}) {
    WholeVolume sum;
    const Surface s = icosphere(1);
    for (const Triangle& t : s.triangles) sum.add(s.points[0], 2, s.points[t.a], s.points[t.b], s.points[t.c], inwards);
    EXPECT_EQ(sum.sign(), inwards ? -1 : 1);
  }
  EXPECT_EQ(WholeVolume().sign(), 0);
  WholeVolume small;
  small.low = -1;
  EXPECT_EQ(small.sign(), -1);
  small.low = 1;
  EXPECT_EQ(small.sign(), 1);
}

}  // namespace
}  // namespace nacre
