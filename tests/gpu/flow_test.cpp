// Nacre: both backends show the same flow, and the GPU's limits are told as errors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "compute/device/error.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"
#include "tests/gpu/each_backend.hpp"
#include "tests/gpu/shapes.hpp"

namespace nacre::gpu_tests {
namespace {

/// The shown frame after 1 and after 20 steps (8 where cases are small), and a picture of the latter.
struct Frames {
  std::vector<float> first, last;
  std::vector<std::uint8_t> picture;
};

/// Flow around the axis of a torus `scale` times as large, its speed swinging with time; `embedding`: grid, brick,
/// cell.
Frames run(Device& device, double scale, const std::string& embedding) {
  const Shape shape = torus(120, 48, scale);
  const int steps = small_cases() ? 8 : 20;
  FlowParameters parameters;
  parameters.resolution = small_cases() ? 112 : 160;
  test::choose_embedding(parameters, embedding);
  parameters.ttl = 4;
  parameters.steps = steps;
  const auto pipeline = make_flow_pipeline(device);
  pipeline->parameters = parameters;
  pipeline->embed(shape.mesh());
  FlowVectors vectors;
  vectors.at = [&](double t, std::span<Vec3f> out) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Vec3d p = shape.points[i] / scale;
      const double swing = std::sin(2 * t);
      out[i] = Vec3f(Vec3d(-p.y, p.x, 0.5 * swing * p.x) * (0.75 + 0.25 * swing));
    }
  };
  vectors.end = 3;
  pipeline->flow().start(vectors);
  Frames frames;
  for (int k = 0; k < steps; ++k) {
    pipeline->flow().step();
    if (k == 0) frames.first = pipeline->flow().shown();
  }
  frames.last = pipeline->flow().shown();
  RenderOptions options;
  options.camera = fit_camera("iso", Vec3d(-1.4, -1.4, -0.4) * scale, Vec3d(1.4, 1.4, 0.4) * scale, 320, 240);
  options.width = 320;
  options.height = 240;
  frames.picture = pipeline->flow().render(options);
  return frames;
}

void expect_alike(const Frames& a, const Frames& b, const char* what) {
  ASSERT_EQ(a.first.size(), b.first.size());
  ASSERT_EQ(a.picture.size(), b.picture.size());
  const double d1 = mean_difference(a.first, b.first), d20 = mean_difference(a.last, b.last);
  const double c1 = correlation(a.first, b.first), c20 = correlation(a.last, b.last);
  const double picture = mean_difference(a.picture, b.picture);
  std::printf("%s, %zu cells: step 1 mean difference %.2e, correlation %.6f; ", what, a.first.size(), d1, c1);
  std::printf("last step %.2e, %.6f; picture %.3f of 255\n", d20, c20, picture);
  testing::Test::RecordProperty("mean_difference_1", std::to_string(d1));
  testing::Test::RecordProperty("correlation_1", std::to_string(c1));
  testing::Test::RecordProperty("mean_difference_20", std::to_string(d20));
  testing::Test::RecordProperty("correlation_20", std::to_string(c20));
  testing::Test::RecordProperty("picture_difference", std::to_string(picture));
  // A path whose end rounds to another cell hands its particles to another cell: differences grow with the steps.
  EXPECT_LE(d1, 0.02);
  EXPECT_GE(c1, 0.985);
  EXPECT_LE(d20, 0.08);
  EXPECT_GE(c20, 0.94);
  EXPECT_LE(picture, 2.0);
}

class FlowAgreement : public testing::TestWithParam<const char*> {};

/// The same surface in another unit differs by rounding alone: what rounding does to a frame bounds what two backends
/// may differ by, which round differently too.
TEST_P(FlowAgreement, RoundingAloneMovesTheTextureLittle) {
  const auto device = make_cpu_device();
  expect_alike(run(*device, 1, GetParam()), run(*device, 3, GetParam()), "CPU, another unit");
}

TEST_P(FlowAgreement, CudaShowsWhatTheCpuShows) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto cpu = make_cpu_device(), gpu = make_cuda_device(arena_limit);
  expect_alike(run(*cpu, 1, GetParam()), run(*gpu, 1, GetParam()), "CPU and CUDA");
}

TEST_P(FlowAgreement, CudaRepeatsItselfToTheBit) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(arena_limit);
  const Frames a = run(*gpu, 1, GetParam()), b = run(*gpu, 1, GetParam());
  EXPECT_EQ(a.last, b.last);
  EXPECT_EQ(a.picture, b.picture);
}

INSTANTIATE_TEST_SUITE_P(On, FlowAgreement, testing::Values("grid", "brick", "thesis"),
                         [](const auto& test) { return std::string(test.param); });

TEST(CudaDevice, TooLittleMemoryIsAnErrorThatNamesAResolution) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(std::size_t(160) << 20);
  const auto pipeline = make_flow_pipeline(*gpu);
  pipeline->parameters.resolution = 4096;
  const Shape shape = torus(40, 20);
  try {
    pipeline->embed(shape.mesh());
    FAIL() << "embedded in 160 MiB";
  } catch (const Error& error) {
    EXPECT_NE(error.advice().find("use `resolution`"), std::string::npos) << error.what();
    EXPECT_NE(error.advice().find("`device` cpu"), std::string::npos) << error.what();
  }
  pipeline->parameters.resolution = 128;
  EXPECT_NO_THROW(pipeline->embed(shape.mesh())) << "the pipeline works on";
}

TEST(CudaDevice, AnImpossibleBlockIsAnErrorAndForgotten) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(arena_limit);
  EXPECT_THROW(gpu->allocate(std::size_t(1) << 50), Error);
  EXPECT_EQ(make_runs(Cuda{}, *gpu)->random_bits(1000).size(), 1000u) << "the next launch is not blamed";
}

TEST(CudaDevice, ArenasStandSideBySideAndTakeWhatTheyUse) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const std::size_t limit = std::size_t(256) << 20;
  const auto gpu = make_cuda_device(limit);
  const auto first = make_runs(Cuda{}, *gpu), second = make_runs(Cuda{}, *gpu);
  EXPECT_EQ(first->random_bits(5), second->random_bits(5));
  EXPECT_GT(gpu->peak_bytes(), 0u);
  EXPECT_LE(gpu->peak_bytes(), 2 * limit);
}

/// A long part of the device's memory is taken between the making of a pipeline and its use.
TEST(CudaDevice, MemoryThatAnotherTookMeanwhileIsAnError) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(), other = make_cuda_device();
  const auto runs = make_runs(Cuda{}, *gpu);
  const std::size_t taken = other->available_bytes() - (std::size_t(256) << 20);
  void* const block = other->allocate(taken);
  const auto most = std::int64_t(taken / 8);  // would have fitted
  EXPECT_THROW(runs->random_bits(most), Error);
  other->deallocate(block, taken);
  EXPECT_EQ(runs->random_bits(1000).size(), 1000u) << "it works on";
}

/// Estimates go by the memory that there is when the work begins, not by what there was when the pipeline was made.
TEST(CudaDevice, AnEstimateKnowsWhatAnotherTookMeanwhile) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(arena_limit), other = make_cuda_device();
  const auto pipeline = make_flow_pipeline(*gpu);
  pipeline->parameters.resolution = 128;
  const Shape shape = torus(40, 20);
  const std::size_t taken = other->available_bytes() - (std::size_t(40) << 20);
  void* const block = other->allocate(taken);
  try {
    pipeline->embed(shape.mesh());
    ADD_FAILURE() << "embedded in 40 MiB";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("`resolution` 128 needs"), std::string::npos) << error.what();
    EXPECT_NE(error.advice().find("`device` cpu"), std::string::npos) << error.what();
  }
  other->deallocate(block, taken);
  EXPECT_NO_THROW(pipeline->embed(shape.mesh())) << "the pipeline works on";
}

TEST(NoCudaDevice, IsAnErrorWithAdviceAndAutoTakesTheCpu) {
  if (cuda_device_count() > 0) GTEST_SKIP() << "there is a CUDA device on this machine";
  try {
    make_device("cuda");
    FAIL() << "made a device without one";
  } catch (const Error& error) {
    EXPECT_NE(error.advice().find("`device` cpu"), std::string::npos);
  }
  EXPECT_EQ(make_device("auto")->backend(), "cpu");
}

}  // namespace
}  // namespace nacre::gpu_tests
