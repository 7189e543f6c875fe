// Nacre: spots and stripes in the pipeline: along the vectors, round without, and refused where they cannot be made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "compute/device/error.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/evidence/legibility.hpp"

namespace nacre::test {
namespace {

/// A sphere with vectors around its axis, which swing; or with none.
class Patterns : public ::testing::Test {
 protected:
  Patterns() {
    for (const Triangle& t : mesh_.triangles)
      for (int k = 0; k < 3; ++k) normals_.push_back(Vec3f(normalized(mesh_.points[t[k]])));
    FlowParameters& p = pipeline_->parameters;
    p.resolution = 112;
    p.refine = 2;
    p.pattern_spacing = 14;
  }

  /// Shown values with this texture, `speed` times as fast as the reference.
  FlowValues form(FlowTexture texture, double speed) {
    pipeline_->parameters.texture = texture;
    pipeline_->embed({mesh_.points, mesh_.triangles, normals_});
    FlowVectors vectors;
    vectors.at = [this, speed](double, std::span<Vec3f> out) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        const Vec3d p = mesh_.points[i];
        out[i] = Vec3f(normalized(Vec3d(-p.y, p.x, 0.6 * std::sin(3 * p.x))) * speed);
      }
    };
    pipeline_->flow().start(vectors);
    return pipeline_->flow().values();
  }

  Legibility seen(const FlowValues& values) const {
    return legibility(values, pipeline_->flow().embedding().cell_size, 600);
  }

  void refused(const std::string& what) {
    try {
      pipeline_->embed({mesh_.points, mesh_.triangles, normals_});
      ADD_FAILURE() << "made: " << what;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      EXPECT_FALSE(error.advice().empty());
    }
  }

  const Mesh mesh_ = sphere({0, 0, 0}, 1, 64);
  std::vector<Vec3f> normals_;
  const std::unique_ptr<Device> device_ = make_cpu_device();
  const std::unique_ptr<FlowPipeline> pipeline_ = make_flow_pipeline(*device_);
};

using LongPatterns = Patterns;

TEST_F(LongPatterns, RunAlongTheVectors) {
  const Legibility stripes = seen(form(FlowTexture::stripes, 1)), spots = seen(form(FlowTexture::spots, 1));
  std::printf("within 15 degrees: stripes %.2f, spots %.2f\n", stripes.within, spots.within);
  EXPECT_GE(stripes.within, 0.75);
  EXPECT_GE(spots.within, 0.4);
  EXPECT_GT(spots.length, 1.3 * spots.width) << "ovals";
}

TEST_F(Patterns, WhereNothingMovesSpotsAreRoundAndPointAnywhere) {
  FlowValues still = form(FlowTexture::spots, 0);
  for (std::size_t i = 0; i < still.velocity.size(); ++i)
    still.velocity[i] = Vec3f(-float(still.centre[i].y), float(still.centre[i].x), 0);  // to look along something
  const Legibility spots = seen(still);
  std::printf("within 15 degrees of any direction: %.2f, length by width %.2f\n", spots.within,
              spots.length / spots.width);
  EXPECT_LT(spots.within, 0.3) << "a sixth by chance";
  EXPECT_NEAR(spots.length / spots.width, 1, 0.15);
}

TEST_F(Patterns, AnotherSeedIsAnotherPatternAndTheSameIsTheSame) {
  pipeline_->parameters.resolution = 64;
  const std::vector<float> first = form(FlowTexture::stripes, 1).value, again = form(FlowTexture::stripes, 1).value;
  EXPECT_EQ(first, again);
  pipeline_->parameters.seed = 2;
  EXPECT_NE(form(FlowTexture::stripes, 1).value, first);
}

TEST_F(Patterns, WhatCannotBeMadeIsRefused) {
  FlowParameters& p = pipeline_->parameters;
  p.texture = FlowTexture::spots;
  p.pattern_stretch = 3;
  refused("`pattern_stretch` 3 is out of range");
  p.pattern_stretch = 2;
  p.pattern_spacing = 9;
  refused("`pattern_spacing` 9 is too small");
  p.pattern_spacing = 80;
  refused("`pattern_spacing` 80 is too large");
  p.pattern_spacing = 14;
  p.radius = 5;
  refused("`radius` 5 is too small");
  p.radius = 0;
  p.method = EmbeddingKind::octree;
  refused("`texture` spots needs the grid");
}

}  // namespace
}  // namespace nacre::test
