// Nacre: both backends build the same embedding from the same triangles.
#include <algorithm>
#include <cmath>

#include "compute/embedding/triangle.hpp"
#include "compute/math/morton.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "tests/gpu/each_backend.hpp"
#include "tests/gpu/shapes.hpp"

namespace nacre::gpu_tests {
namespace {

/// What a grid was built from, in its coordinates.
struct Reference {
  FlowDomain domain;
  int sub, refine;
  std::vector<Corners> triangles;

  Reference(const Shape& shape, const FlowParameters& parameters)
      : domain(make_domain(shape.mesh(), parameters)), sub(parameters.subcells), refine(parameters.refine) {
    const auto at = [&](std::uint32_t p) { return domain.to_grid(shape.points[p]); };
    for (const Triangle& t : shape.triangles) triangles.push_back({at(t.a), at(t.b), at(t.c)});
  }

  static Int3 within(std::size_t number, int width) {
    const int n = int(number);
    return {n % width, n / width % width, n / width / width};
  }

  Int3 cell(const HostEmbedding& grid, std::size_t at) const {
    const std::size_t volume = std::size_t(sub) * sub * sub;
    return morton_cell(grid.brick_code[at / volume]) * Int3(sub) + within(at % volume, sub);
  }

  Vec3d centre(const HostEmbedding& grid, std::size_t at) const { return Vec3d(cell(grid, at)) + Vec3d(0.5); }

  /// Of surface cell `s` of the texture, in cells of the grid.
  Vec3d texture_centre(const HostEmbedding& grid, std::size_t s) const {
    const std::size_t volume = std::size_t(refine) * refine * refine, position = grid.position[s];
    const Int3 c = cell(grid, grid.block_cell[position / volume]) * Int3(refine) + within(position % volume, refine);
    return (Vec3d(c) + Vec3d(0.5)) / double(refine);
  }

  bool on_surface(const Vec3d& p) const {
    return std::any_of(triangles.begin(), triangles.end(),
                       [&](const Corners& t) { return length(closest_point(t, p) - p) <= tolerance; });
  }

  static constexpr double tolerance = 2e-5;  // of a cell; floats hold the points
};

class Embedding : public EachBackend {
 protected:
  /// Compares with the CPU. Positions may differ by rounding, and where points or triangles tie, each backend may take
  /// another of them; which cells the surface passes through may not differ.
  void expect_as_on_cpu(const Shape& shape, int resolution) {
    FlowParameters parameters;
    parameters.resolution = resolution;
    const Reference reference(shape, parameters);
    const auto cpu = make_cpu_device();
    const HostEmbedding expected = make_runs(Cpu{}, *cpu)->embed(shape.mesh(), parameters);
    const HostEmbedding found = runs->embed(shape.mesh(), parameters);
    ASSERT_GT(expected.position.size(), 1000u);
    ASSERT_EQ(found.brick_code, expected.brick_code);
    ASSERT_EQ(found.position, expected.position) << "surface cells";
    expect_as_near(found, expected, reference);
    expect_seeds(found, expected, reference);
    EXPECT_LE(differing_share(found.texel, expected.texel), 1e-4);  // a float may fall on either side of a cell
    EXPECT_LE(differing_share(found.neighbour, expected.neighbour), 1e-4);
  }

  static Vec3d xyz(const Float4& a) { return {a.x, a.y, a.z}; }

  /// Every cell of the band has a point as near as on the CPU, on the triangle that it names.
  static void expect_as_near(const HostEmbedding& found, const HostEmbedding& expected, const Reference& reference) {
    ASSERT_EQ(found.offset.size(), expected.offset.size());
    std::size_t looked_at = 0;
    for (std::size_t i = 0; i < found.offset.size(); ++i) {
      const double distance = length(xyz(expected.offset[i]));
      if (distance > reference.domain.radius) continue;
      const Vec3d centre = reference.centre(found, i), p = centre + xyz(found.offset[i]);
      ASSERT_NEAR(length(p - centre), distance, reference.tolerance) << i;
      ASSERT_LT(found.triangle[i], reference.triangles.size()) << i;
      ASSERT_LE(length(closest_point(reference.triangles[found.triangle[i]], p) - p), reference.tolerance) << i;
      ++looked_at;
    }
    EXPECT_GT(looked_at, 10000u);
  }

  /// The same for the cells of the texture, whose seeds name no triangle: those that differ must lie on the surface,
  /// too.
  static void expect_seeds(const HostEmbedding& found, const HostEmbedding& expected, const Reference& reference) {
    ASSERT_EQ(found.seed.size(), expected.seed.size());
    ASSERT_EQ(found.block_cell, expected.block_cell);
    for (std::size_t s = 0; s < found.seed.size(); ++s) {
      const Vec3d p = xyz(found.seed[s]), q = xyz(expected.seed[s]);
      ASSERT_NEAR(length(p), length(q), reference.tolerance) << s;
      if (length(p - q) <= reference.tolerance) continue;
      ASSERT_TRUE(reference.on_surface(reference.texture_centre(found, s) + p / double(reference.refine))) << s;
    }
  }

  static double differing_share(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    if (a.size() != b.size()) return 1;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing += a[i] != b[i];
    return double(differing) / double(a.size());
  }
};
INSTANTIATE_TEST_SUITE_P(On, Embedding, testing::Values("cpu", "cuda"), backend_name);

TEST_P(Embedding, OfManySmallTriangles) { expect_as_on_cpu(torus(200, 80), 200); }

TEST_P(Embedding, OfTwelveTrianglesAsWideAsTheGrid) { expect_as_on_cpu(box(), 240); }

}  // namespace
}  // namespace nacre::gpu_tests
