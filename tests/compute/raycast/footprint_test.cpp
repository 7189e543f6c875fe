// Nacre: a texture whose cells are far smaller than pixels: what a pixel shows is their mean, whatever way it turns.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "compute/device/device.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"

namespace nacre::test {
namespace {

/// A sphere that turns about z.
struct TurningSphere {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  std::vector<Vec3f> normals;
  std::unique_ptr<Device> device = make_cpu_device();
  std::unique_ptr<FlowPipeline> pipeline = make_flow_pipeline(*device);

  TurningSphere(const char* embedding, int resolution) {
    constexpr int rings = 24, sectors = 48;
    for (int r = 0; r <= rings; ++r)
      for (int s = 0; s < sectors; ++s) {
        const double polar = 3.14159265358979 * r / rings, around = 2 * 3.14159265358979 * s / sectors;
        points.push_back({std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar)});
      }
    const auto add = [&](int a, int b, int c) {
      triangles.push_back({std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)});
      for (const int k : {a, b, c}) normals.push_back(Vec3f(points[std::size_t(k)]));
    };
    for (int r = 0; r < rings; ++r)
      for (int s = 0; s < sectors; ++s) {
        const int a = r * sectors + s, b = r * sectors + (s + 1) % sectors;
        if (r > 0) add(a, a + sectors, b);
        if (r + 1 < rings) add(b, a + sectors, b + sectors);
      }
    choose_embedding(pipeline->parameters, embedding);
    pipeline->parameters.resolution = resolution;
    pipeline->parameters.streaks = 6;
    pipeline->embed({points, triangles, normals});
    FlowVectors vectors;
    vectors.at = [this](double, std::span<Vec3f> out) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = Vec3f(cross(Vec3d(0, 0, 1), points[i]));
    };
    pipeline->flow().start(vectors);
  }

  /// Brightness of each pixel, in linear light, of a picture `size` pixels wide.
  std::vector<double> picture(double degrees, int size, int samples) const {
    RenderOptions options;
    options.width = options.height = size;
    options.samples = samples;
    options.camera.eye = {6, 0, 2};
    options.camera.target = {0, 0, 0};
    options.camera.up = {0, 0, 1};
    options.camera.height = 1;  // nothing but the sphere is in view: a pixel across its outline would need more rays
    options.camera = orbit(options.camera, degrees);
    const std::vector<std::uint8_t> bytes = pipeline->flow().render(options);
    std::vector<double> light;
    for (std::size_t i = 0; i < bytes.size(); i += 4) light.push_back(bytes[i] * double(bytes[i]) / (255.0 * 255.0));
    return light;
  }
};

/// Mean square difference of a picture and the same picture computed with `finer` times the pixels.
double error_of(const TurningSphere& sphere, double degrees, int size, int samples, int finer) {
  const std::vector<double> seen = sphere.picture(degrees, size, samples);
  const std::vector<double> fine = sphere.picture(degrees, size * finer, 1);
  double error = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      double mean = 0;
      for (int k = 0; k < finer * finer; ++k)
        mean +=
            fine[std::size_t(y * finer + k / finer) * std::size_t(size * finer) + std::size_t(x * finer + k % finer)];
      const double off = seen[std::size_t(y * size + x)] - mean / (finer * finer);
      error += off * off;
    }
  return error / (double(size) * size);
}

class MinifiedTexture : public ::testing::TestWithParam<const char*> {};

/// Ten cells to a pixel. Means over bricks reach somewhat beyond a pixel, which blurs and does not shimmer.
TEST_P(MinifiedTexture, IsTheMeanOfWhatAPixelCovers) {
  const TurningSphere sphere(GetParam(), 320);
  for (const int samples : {1, 2}) {
    double error = 0;
    for (const double degrees : {0.0, 0.7}) error += error_of(sphere, degrees, 16, samples, 16) / 2;
    std::printf("%s, %d rays a pixel and axis: root mean square error %.4f of white\n", GetParam(), samples,
                std::sqrt(error));
    EXPECT_LT(std::sqrt(error), 0.06);
  }
}

/// From frame to frame only what turns in the light changes: the texture is too fine to be seen.
TEST_P(MinifiedTexture, DoesNotShimmerWhenItTurns) {
  const TurningSphere sphere(GetParam(), 320);
  std::vector<double> before = sphere.picture(0, 16, 1);
  double change = 0;
  for (int frame = 1; frame <= 6; ++frame) {
    const std::vector<double> now = sphere.picture(0.9 * frame, 16, 1);
    for (std::size_t i = 0; i < now.size(); ++i) change += (now[i] - before[i]) * (now[i] - before[i]);
    before = now;
  }
  change = std::sqrt(change / (6.0 * double(before.size())));
  std::printf("%s: root mean square change from frame to frame %.4f of white\n", GetParam(), change);
  EXPECT_LT(change, 0.03);
}

INSTANTIATE_TEST_SUITE_P(By, MinifiedTexture, ::testing::Values("grid", "brick"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace nacre::test
