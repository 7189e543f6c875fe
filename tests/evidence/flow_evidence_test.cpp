// Nacre: what the flow texture must show: alignment, motion, coherence, determinism, stagnation.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <random>

#include "tests/compute/pipeline/choose_embedding.hpp"
#include "tests/evidence/texture_measures.hpp"

namespace nacre {
namespace {

FlowParameters parameters_at(int resolution, int ttl, const std::string& embedding) {
  FlowParameters parameters;
  test::choose_embedding(parameters, embedding);
  parameters.resolution = embedding == "thesis" ? resolution / 2 : resolution;  // the yardstick is slow
  parameters.ttl = ttl;
  return parameters;
}

/// The same must hold on every embedding.
class FlowEvidence : public testing::TestWithParam<const char*> {
 protected:
  FlowParameters at_resolution(int resolution, int ttl = 4) const { return parameters_at(resolution, ttl, GetParam()); }
};

/// Median angle between texture and flow over a sample, leaving out points at rest.
double median_alignment(const std::string& sample, const FlowParameters& parameters,
                        const std::function<Vec3d(Vec3d)>& onto_surface) {
  FlowRun run(sample, parameters);
  run.steps(6);
  const FlowValues values = run.pipeline->flow().values();
  std::vector<Vec3d> points;
  std::vector<Vec3f> normals, flow;
  for (std::size_t i = 0; i < values.value.size(); i += values.value.size() / 800) {
    if (length(values.velocity[i]) < 1e-3 * run.vectors->statistics().percentile_98) continue;
    points.push_back(values.closest_point[i]);
    normals.push_back(values.normal[i]);
    flow.push_back(values.velocity[i]);
  }
  const double error = median(alignment_errors(*run.pipeline, points, normals, flow, onto_surface));
  std::printf("alignment on %s, %s: median %.1f degrees\n", sample.c_str(),
              run.pipeline->flow().embedding().kind.c_str(), error);
  return error;
}

TEST_P(FlowEvidence, StreaksAlignWithTheFlowOnASphere) {
  EXPECT_LE(median_alignment("sphere", at_resolution(384), [](Vec3d x) { return normalized(x); }), 10);
}

TEST_P(FlowEvidence, StreaksAlignWithTheFlowOnATorus) {
  EXPECT_LE(median_alignment("torus", at_resolution(384),
                             [](Vec3d x) {
                               const Vec3d ring = normalized(Vec3d(x.x, x.y, 0));
                               return ring + normalized(x - ring) * 0.4;
                             }),
            10);
}

std::vector<Vec3d> spiral_on_sphere(int n, double angle) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double z = -0.8 + 1.6 * (i + 0.5) / n, a = i * 2.399963 + angle, r = std::sqrt(1 - z * z);
    points.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return points;
}

/// Frame k must look most like frame k + 1 when that is turned back by what the flow turns in a step.
TEST_P(FlowEvidence, TextureMovesWithTheFlow) {
  for (const int ttl : {2, 4}) {
    FlowRun run("sphere-rotation", at_resolution(256, ttl));
    run.steps(2 * ttl);
    const int points = 6000;
    const std::vector<float> before = run.pipeline->flow().sample_shown(spiral_on_sphere(points, 0));
    run.steps(1);
    const double expected = run.pipeline->parameters.step_cells * run.pipeline->flow().embedding().cell_size /
                            run.vectors->statistics().percentile_98;
    double best = -1, at = 0;
    for (double share = 0; share <= 2; share += 0.05) {
      const double c =
          correlation(before, run.pipeline->flow().sample_shown(spiral_on_sphere(points, share * expected)));
      if (c > best) best = c, at = share;
    }
    std::printf("motion at ttl %d: %.2f of v dt, correlation %.3f\n", ttl, at, best);
    EXPECT_NEAR(at, 1.0, 0.15) << "ttl " << ttl;
    EXPECT_GT(best, 0.65) << "noise is mixed in";
  }
}

/// The texture is on the surface, not on the screen: seen from a camera turned by half a degree it is the same.
TEST_P(FlowEvidence, TextureStaysWhenTheCameraMoves) {
  FlowRun run("sphere", at_resolution(384));
  run.steps(4);
  RenderOptions options;
  options.width = options.height = 768;  // four times the pixels that the texture has cells for
  options.camera = fit_camera("iso", {-1, -1, -1}, {1, 1, 1}, options.width, options.height);
  options.camera.orthographic = true;
  options.samples = 3;
  const Camera turned = orbit(options.camera, 0.5);
  /// Brightness of the pixels that see the given points.
  const auto look = [&](const Camera& camera, const std::vector<Vec3d>& points) {
    options.camera = camera;
    const std::vector<std::uint8_t> image = run.pipeline->flow().render(options);
    options.texture = false;
    const std::vector<std::uint8_t> plain = run.pipeline->flow().render(options);  // takes the light out
    options.texture = true;
    const Vec3d right = camera.right(), up = cross(right, camera.forward());
    std::vector<float> seen;
    for (const Vec3d& p : points) {
      const double x = (dot(p - camera.target, right) / camera.height + 0.5) * options.width - 0.5;
      const double y = (0.5 - dot(p - camera.target, up) / camera.height) * options.height - 0.5;
      const int x0 = int(x), y0 = int(y);
      double value = 0;
      for (int k = 0; k < 4; ++k) {
        const double w = (k & 1 ? x - x0 : 1 - x + x0) * (k >> 1 ? y - y0 : 1 - y + y0);
        const std::size_t at = 4 * (std::size_t(y0 + (k >> 1)) * options.width + x0 + (k & 1));
        value += w * double(image[at]) / std::max<int>(plain[at], 1);
      }
      seen.push_back(float(value));
    }
    return seen;
  };
  std::vector<Vec3d> points;
  const Camera start = options.camera;
  for (const Vec3d& p : spiral_on_sphere(8000, 0))
    if (dot(p, start.forward()) < -0.6) points.push_back(p);
  const double c = correlation(look(start, points), look(turned, points));
  std::printf("coherence over half a degree: %.3f at %zu points\n", c, points.size());
  EXPECT_GE(c, 0.95);
}

std::vector<float> run_bytes(int threads, FlowParameters parameters, std::uint32_t seed) {
  parameters.seed = seed;
  FlowRun run("torus", parameters, threads, false, 60);
  run.steps(4);
  return run.pipeline->flow().shown();
}

TEST_P(FlowEvidence, OneSeedGivesOneResultOnAnyNumberOfThreads) {
  const std::vector<float> one = run_bytes(1, at_resolution(128, 3), 7), two = run_bytes(2, at_resolution(128, 3), 7);
  const std::vector<float> other = run_bytes(2, at_resolution(128, 3), 8);
  EXPECT_EQ(one, two);
  EXPECT_NE(one, other);
}

/// A flow that stands still on one half: there the texture is gray noise, neither black nor white nor flat.
TEST_P(FlowEvidence, StagnantRegionsStayGrayNoise) {
  FlowRun run("sphere", at_resolution(128));
  const auto flow = run.vectors.get();
  FlowVectors half;
  half.at = [flow](double t, std::span<Vec3f> out) {
    flow->vectors(t, out);
    for (std::size_t i = 0; i < out.size(); ++i)
      if (flow->surface().points[i].z < 0) out[i] = {};
  };
  half.reference_speed = flow->statistics().percentile_98;
  run.pipeline->flow().start(half);
  run.steps(12);
  const FlowValues values = run.pipeline->flow().values();
  const std::vector<float> shown = run.pipeline->flow().sample_shown(values.closest_point);
  double sum = 0, squares = 0;
  int n = 0, black = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (values.centre[i].z > -0.2) continue;
    sum += shown[i];
    squares += shown[i] * shown[i];
    black += shown[i] == 0;
    ++n;
  }
  const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
  EXPECT_NEAR(mean, 0.5, 0.1);
  EXPECT_GT(deviation, 0.08);
  EXPECT_LT(black, n / 10);
}

/// Zero vectors everywhere are not an error: noise in, noise out.
TEST_P(FlowEvidence, AllZeroVectorsGiveNoise) {
  FlowRun run("torus", at_resolution(64), 0, true, 40);
  FlowVectors still;
  still.at = [](double, std::span<Vec3f> out) { std::fill(out.begin(), out.end(), Vec3f{}); };
  run.pipeline->flow().start(still);
  run.steps(3);
  const std::vector<float> shown = run.pipeline->flow().shown();
  double sum = 0, squares = 0;
  for (const float v : shown) {
    ASSERT_TRUE(v >= 0 && v <= 1);
    sum += v;
    squares += v * v;
  }
  const double n = double(shown.size()), mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
  EXPECT_NEAR(mean, 0.5, 0.1);
  EXPECT_GT(deviation, 0.08) << "flat grey is no noise";
}

/// The texture grid is the same whatever the closest-point grid below it.
TEST(FlowGrid, RefineDoesNotChangeWhereTheSurfaceIs) {
  std::map<int, std::uint64_t> cells;
  for (const int refine : {1, 2, 4, 8}) {
    FlowParameters parameters = parameters_at(128, 4, "grid");
    parameters.refine = refine;
    FlowRun run("torus", parameters, 0, true, 60);
    cells[refine] = run.pipeline->flow().embedding().surface_cells;
    run.steps(1);
  }
  for (const auto& [refine, count] : cells)
    EXPECT_NEAR(double(count), double(cells[4]), 0.02 * double(cells[4])) << refine;
}

INSTANTIATE_TEST_SUITE_P(On, FlowEvidence, testing::Values("grid", "brick", "thesis"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace nacre
