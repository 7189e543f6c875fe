// Nacre: how sharp the shown flow is: along the present flow everywhere, as far as cells of its size allow, and strong
// and fine in the picture.
#include <gtest/gtest.h>

#include <cstdio>

#include "engine/picture/colormap.hpp"
#include "tests/evidence/crispness.hpp"
#include "tests/evidence/legibility.hpp"
#include "tests/evidence/surface_lic.hpp"
#include "tests/evidence/texture_measures.hpp"

namespace nacre {
namespace {

struct LegibilityCase {
  const char *sample, *embedding;

  friend void PrintTo(const LegibilityCase& test, std::ostream* out) { *out << test.sample << ' ' << test.embedding; }
};

FlowParameters default_parameters(const LegibilityCase& test, int resolution) {
  FlowParameters parameters;
  if (std::string(test.embedding) == "brick") parameters.method = EmbeddingKind::octree;
  parameters.resolution = resolution;
  return parameters;
}

std::string name_of(const testing::TestParamInfo<LegibilityCase>& test) {
  std::string name = std::string(test.param.sample) + "_" + test.param.embedding;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

void print(const char* what, const LegibilityCase& test, const Legibility& seen) {
  std::printf(
      "%s on %s, %s, %d positions: within 15 degrees %.1f%%, of the slowest tenth %.1f%%, half-width %.2f, "
      "half-length %.2f cells\n",
      what, test.sample, test.embedding, seen.positions, 100 * seen.within, 100 * seen.slowest_within, seen.width,
      seen.length);
}

class FlowLegibility : public testing::TestWithParam<LegibilityCase> {};

/// A careful line integral convolution on the same cells is the yardstick: a window near a critical point has no single
/// direction, whoever draws it.
TEST_P(FlowLegibility, StreaksFollowThePresentFlowAsWellAsAConvolution) {
  FlowRun run(GetParam().sample, default_parameters(GetParam(), 512), 0, false);
  run.steps(16);
  FlowValues values = run.pipeline->flow().values();
  const double cell = run.pipeline->flow().embedding().cell_size;
  const Legibility ours = legibility(values, cell);
  values.value = SurfaceLic(values, cell).convolve(10);
  const Legibility lic = legibility(values, cell);
  print("streaks", GetParam(), ours);
  print("LIC", GetParam(), lic);
  EXPECT_GE(ours.within, 0.98 * lic.within);
  EXPECT_GE(ours.slowest_within, 0.9 * lic.slowest_within) << "of some 140 positions";
  EXPECT_LE(ours.width, 1.12 * lic.width);
  EXPECT_GE(ours.length, lic.length);
}

class FlowLegibilityInPictures : public testing::TestWithParam<LegibilityCase> {};

/// Fitted into the default picture, with as many texture cells as it has pixels.
TEST_P(FlowLegibilityInPictures, StreaksAreFineAndStrong) {
  FlowRun run(GetParam().sample, default_parameters(GetParam(), 1024), 0, false);
  run.steps(4);
  RenderOptions options;
  options.camera = fit_camera("iso", run.vectors->surface().points, options.width, options.height);
  const Crispness grey = crispness(run.pipeline->flow().render(options), options.width, options.height);
  const std::vector<float> speed = [&] {
    std::vector<Vec3f> vectors(run.vectors->surface().points.size());
    run.vectors->vectors(run.pipeline->flow().time(), vectors);
    std::vector<float> lengths;
    for (const Vec3f& v : vectors) lengths.push_back(length(v));
    return lengths;
  }();
  options.scalar = speed;
  options.high = run.vectors->statistics().percentile_98;
  options.colours = colormap("sea").table;
  const Crispness coloured = crispness(run.pipeline->flow().render(options), options.width, options.height);
  std::printf("picture of %s, %s: half-width %.2f px, half-length %.2f px, contrast %.3f, in colours %.3f\n",
              GetParam().sample, GetParam().embedding, grey.across, grey.along, grey.contrast, coloured.contrast);
  EXPECT_GT(grey.across, 0);
  EXPECT_LE(grey.across, 0.8);
  EXPECT_GE(grey.contrast, 0.25);
  EXPECT_GE(coloured.contrast, 0.2);
}

INSTANTIATE_TEST_SUITE_P(On, FlowLegibility,
                         testing::Values(LegibilityCase{"train", "grid"}, LegibilityCase{"train", "brick"},
                                         LegibilityCase{"cylinder", "grid"}, LegibilityCase{"cylinder", "brick"}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(On, FlowLegibilityInPictures,
                         testing::Values(LegibilityCase{"train", "grid"}, LegibilityCase{"train", "brick"}), name_of);

}  // namespace
}  // namespace nacre
