// Nacre: surface preparation and vector choice on real files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "tests/paths.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

Surface load(const std::string& file) { return open_surface({test::shared_data(file)}).load(0); }

/// Edges of exactly two triangles that run the same way along them.
std::size_t inconsistent_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::uint64_t, int>> sides;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[(k + 1) % 3];
      sides.emplace_back(std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1);
    }
  std::sort(sides.begin(), sides.end());
  std::size_t wrong = 0;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].first == sides[i].first) ++end;
    wrong += end - i == 2 && sides[i].second == sides[i + 1].second;
  }
  return wrong;
}

std::vector<Vec3f> vectors_of(const Surface& surface, const std::string& name) {
  const PointArray& array = *surface.find(name);
  std::vector<Vec3f> vectors(array.size());
  for (std::size_t p = 0; p < vectors.size(); ++p)
    vectors[p] = {array.values[3 * p], array.values[3 * p + 1], array.values[3 * p + 2]};
  return vectors;
}

TEST(PrepareData, ShuffledWindSphereFacesOutwardsAgain) {
  NACRE_NEEDS_SHARED_DATA("flow/wind-sphere");
  Surface surface = load("flow/wind-sphere/wind_sphere_9steps.vtp");
  for (std::size_t t = 0; t < surface.triangles.size(); t += 1 + t % 3)
    std::swap(surface.triangles[t].b, surface.triangles[t].c);
  EXPECT_GT(inconsistent_edges(surface.triangles), 10000u);
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(surface, 40, &warnings);
  EXPECT_EQ(inconsistent_edges(s.triangles), 0u);
  EXPECT_FALSE(warnings.empty());
  double worst = 1;
  for (std::size_t c = 0; c < s.corner_normals.size(); ++c)
    worst = std::min(worst, dot(Vec3d(s.corner_normals[c]), normalized(s.points[s.triangles[c / 3][int(c % 3)]])));
  EXPECT_GT(worst, 0.99);
}

TEST(PrepareData, AtriumIsWoundConsistently) {
  NACRE_NEEDS_SHARED_DATA("flow/atrium-moving");
  const Surface surface = load("flow/atrium-moving/model_moved_00.vtp");
  EXPECT_GT(inconsistent_edges(surface.triangles), 0u);
  std::vector<std::string> warnings;
  EXPECT_EQ(inconsistent_edges(prepare(surface, 40, &warnings).triangles), 0u);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0].find("wound like their neighbours"), std::string::npos);
}

TEST(PrepareData, PipeInflowIsNormalToItsSurface) {
  NACRE_NEEDS_SHARED_DATA("flow/pipe");
  const Surface surface = load("flow/pipe/bct.vtp");
  const VectorChoice choice = choose_vectors(surface, "");
  const VectorStatistics stats = vector_statistics(prepare(surface), vectors_of(surface, choice.name));
  EXPECT_GT(stats.normal_share, 0.99);
}

TEST(PrepareData, TheRightVectorsAreChosen) {
  NACRE_NEEDS_SHARED_DATA("flow/drivaer");
  const std::map<std::string, std::string> expected = {
      {"flow/drivaer/drivaer_0030.vtp", "wallShearStress"},
      {"flow/disk-out/disk_out_ref_surface.vtp", "V"},
      {"flow/wind-sphere/wind_sphere_9steps.vtp", "Velocity"},
      {"flow/artery/artery_wallshear_5steps.vtp", "WallShearRate"},
      {"flow/atrium-moving/model_moved_03.vtp", "displacement"},
  };
  for (const auto& [file, name] : expected) {
    const Surface surface = load(file);
    EXPECT_EQ(choose_vectors(surface, "").name.substr(0, name.size()), name) << file;
  }
}

TEST(PrepareData, WallShearLiesInTheSurface) {
  NACRE_NEEDS_SHARED_DATA("flow/drivaer");
  const Surface surface = load("flow/drivaer/drivaer_0030.vtp");
  const PreparedSurface s = prepare(surface);
  EXPECT_EQ(inconsistent_edges(s.triangles), 0u);
  const VectorStatistics stats = vector_statistics(s, vectors_of(surface, "wallShearStress"));
  EXPECT_LT(stats.normal_share, 0.2);
  EXPECT_GT(stats.percentile_98, 0);
  EXPECT_GT(stats.max_speed, stats.percentile_98);
}

TEST(PrepareData, EveryDefectMeshIsPreparedOrRefused) {
  NACRE_NEEDS_SHARED_DATA("meshes");
  std::size_t prepared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(test::shared_data("meshes"))) {
    if (!entry.is_regular_file() || entry.file_size() > 3000000) continue;  // the large ones are sound
    try {
      const PreparedSurface s = prepare(open_surface({entry.path()}).load(0));
      ++prepared;
      ASSERT_EQ(s.corner_normals.size(), 3 * s.triangles.size()) << entry.path();
      for (const Vec3f& n : s.corner_normals) ASSERT_NEAR(length(n), 1, 1e-4) << entry.path();
      for (const Triangle& t : s.triangles) ASSERT_LT(std::max({t.a, t.b, t.c}), s.points.size()) << entry.path();
    } catch (const Error&) {  // a file without surface, or of another kind
    }
  }
  EXPECT_GT(prepared, 40u);
}

}  // namespace
}  // namespace nacre
