// Nacre: both backends build the same embedding from the same triangles.
#include <cmath>

#include "tests/gpu/each_backend.hpp"
#include "tests/gpu/shapes.hpp"

namespace nacre::gpu_tests {
namespace {

class Embedding : public EachBackend {
 protected:
  /// Compares with the CPU. Positions may differ by rounding, so what they are compared with does too; which cells the
  /// surface passes through may not.
  void expect_as_on_cpu(const Shape& shape, int resolution) {
    FlowParameters parameters;
    parameters.resolution = resolution;
    const auto cpu = make_cpu_device();
    const HostEmbedding expected = make_runs(Cpu{}, *cpu)->embed(shape.mesh(), parameters);
    const HostEmbedding found = runs->embed(shape.mesh(), parameters);
    ASSERT_GT(expected.place.size(), 1000u);
    ASSERT_EQ(found.brick_code, expected.brick_code);
    ASSERT_EQ(found.place, expected.place) << "surface cells";
    expect_near(found.offset, expected.offset, "closest points");
    expect_near(found.seed, expected.seed, "seeds");
    EXPECT_LE(differing_share(found.triangle, expected.triangle), 0.03);  // either of two that share an edge
    EXPECT_LE(differing_share(found.texel, expected.texel), 1e-4);        // a float may fall on either side of a cell
    EXPECT_LE(differing_share(found.neighbour, expected.neighbour), 1e-4);
  }

  static void expect_near(const std::vector<Float4>& a, const std::vector<Float4>& b, const char* what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    std::size_t apart = 0;  // the same distance, to another point: on a medial axis either is right
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Vec3f p(a[i].x, a[i].y, a[i].z), q(b[i].x, b[i].y, b[i].z);
      ASSERT_LE(std::fabs(length(p) - length(q)), 1e-5f) << what << " " << i;
      apart += length(p - q) > 1e-5f;
    }
    EXPECT_LE(double(apart), 1e-3 * double(a.size())) << what;
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
