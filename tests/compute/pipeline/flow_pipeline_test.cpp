// Nacre: what the door to flow promises whoever draws its frames, on the grid and on both octrees.
#include "compute/pipeline/flow_pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "compute/device/device.hpp"
#include "compute/device/error.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"

namespace nacre::test {
namespace {

class FlowDoor : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    choose_embedding(pipeline_->parameters, GetParam());
    pipeline_->parameters.resolution = 32;
    pipeline_->embed({points_, triangles_, normals_});
    vectors_.reference_speed = 1;
    vectors_.at = [this](double, std::span<Vec3f> out) {
      if (broken_) throw Error("no vectors");
      std::fill(out.begin(), out.end(), Vec3f(1, 0.5f, 0));
    };
  }

  const std::vector<Vec3d> points_{{0, 0, 0.1}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}};
  const std::vector<Triangle> triangles_{{0, 1, 2}, {0, 2, 3}};
  const std::vector<Vec3f> normals_ = std::vector<Vec3f>(6, Vec3f(0, 0, 1));
  const std::unique_ptr<Device> device_ = make_cpu_device();
  const std::unique_ptr<FlowPipeline> pipeline_ = make_flow_pipeline(*device_);
  FlowVectors vectors_;
  bool broken_ = false;
};

TEST_P(FlowDoor, NothingIsShownBeforeTheStart) {
  const auto expect_nothing = [&] {
    EXPECT_THROW(pipeline_->flow().step(), Error);
    EXPECT_THROW(pipeline_->flow().shown(), Error);
    EXPECT_THROW(pipeline_->flow().values(), Error);
    EXPECT_THROW(pipeline_->flow().sample_shown(points_), Error);
    RenderOptions options;
    options.width = options.height = 16;
    EXPECT_EQ(pipeline_->flow().render(options).size(), 4u * 16 * 16) << "the plain surface";
  };
  expect_nothing();
  pipeline_->flow().start(vectors_);
  pipeline_->flow().step();
  broken_ = true;
  EXPECT_THROW(pipeline_->flow().start(vectors_), Error);
  expect_nothing();
}

TEST_P(FlowDoor, MemoryOfWhoDrawsIsWrittenAndNeverRead) {
  pipeline_->flow().start(vectors_);
  std::vector<float> drawn(pipeline_->flow().shown().size(), -1.0f);
  pipeline_->flow().show_into(drawn.data());
  pipeline_->flow().step();
  const std::vector<float> shown = pipeline_->flow().shown();
  EXPECT_EQ(drawn, shown);
  const std::vector<float> probed = pipeline_->flow().sample_shown(points_);
  std::fill(drawn.begin(), drawn.end(), 7.0f);  // given back: it may hold anything
  EXPECT_EQ(pipeline_->flow().shown(), shown);
  EXPECT_EQ(pipeline_->flow().sample_shown(points_), probed);
  pipeline_->flow().show_into(nullptr);
  pipeline_->flow().step();
  EXPECT_NE(pipeline_->flow().shown(), shown);
  EXPECT_EQ(drawn, std::vector<float>(drawn.size(), 7.0f));
}

TEST_P(FlowDoor, AnotherThreadCanReadHowMuchIsDone) {
  std::atomic<float> share{-1};
  pipeline_->watch(nullptr, &share);
  pipeline_->embed({points_, triangles_, normals_});
  EXPECT_EQ(share, std::string(GetParam()) == "thesis" ? -1 : 1) << "the thesis octree does not tell";
  std::vector<float> seen;
  share = -1;
  pipeline_->flow().start(vectors_, [&] { seen.push_back(share); });
  EXPECT_EQ(share, 1);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_GT(std::set<float>(seen.begin(), seen.end()).size(), 2u) << "it grows from step to step of the warm-up";
}

TEST_P(FlowDoor, TheBackgroundIsOpaqueUnlessAskedToBeTransparent) {
  RenderOptions options;
  options.width = options.height = 16;
  options.camera = fit_camera("iso", {0, 0, 0}, {1, 1, 0.1}, options.width, options.height);
  for (const bool transparent : {false, true}) {
    options.transparent = transparent;
    const std::vector<std::uint8_t> picture = pipeline_->flow().render(options);
    EXPECT_EQ(picture[3], transparent ? 0 : 255) << "a corner";
    EXPECT_EQ(picture[4 * (8 * 16 + 8) + 3], 255) << "the middle, where the surface is";
  }
}

TEST_P(FlowDoor, ARunGoesOnFromAnyStepAsIfItHadNotStopped) {
  vectors_.end = 1;
  vectors_.at = [](double t, std::span<Vec3f> out) {
    std::fill(out.begin(), out.end(), Vec3f(1, float(2 * t - 1), 0));
  };
  pipeline_->parameters.steps = 4;
  std::map<int, std::vector<std::byte>> kept;  // by the step that comes next
  const auto keep = [&] {
    std::vector<std::byte>& bytes = kept[pipeline_->flow().next_step()];
    pipeline_->flow().save(
        [&](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  };
  std::vector<std::vector<float>> whole;
  pipeline_->flow().start(vectors_, keep);
  whole.push_back(pipeline_->flow().shown());
  for (int k = 0; k < 4; ++k) {
    pipeline_->flow().step();
    keep();
    whole.push_back(pipeline_->flow().shown());
  }
  ASSERT_EQ(kept.size(), 8u);
  EXPECT_EQ(kept.begin()->first, -3) << "after the first step of the warm-up";
  const std::unique_ptr<Device> device = make_cpu_device(2, true);
  const std::unique_ptr<FlowPipeline> other = make_flow_pipeline(*device);
  other->parameters = pipeline_->parameters;
  other->embed({points_, triangles_, normals_});
  for (const auto& [next, bytes] : kept) {
    std::size_t at = 0;
    other->flow().go_on(vectors_, next, [&, &from = bytes](std::span<std::byte> to) {
      ASSERT_LE(at + to.size(), from.size());
      std::copy_n(from.begin() + std::ptrdiff_t(at), to.size(), to.begin());
      at += to.size();
    });
    EXPECT_EQ(at, bytes.size());
    for (int k = std::max(0, next);; ++k) {
      EXPECT_EQ(other->flow().shown(), whole[std::size_t(k)]) << "frame " << k << " from " << next;
      EXPECT_EQ(other->flow().next_step(), k);
      if (k == 4) break;
      other->flow().step();
    }
    EXPECT_EQ(other->flow().values().value, pipeline_->flow().values().value) << "from " << next;
  }
}

INSTANTIATE_TEST_SUITE_P(By, FlowDoor, ::testing::Values("grid", "brick", "thesis"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace nacre::test
