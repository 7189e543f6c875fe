// Nacre: the boxes of an embedding, as the pipeline writes them for a renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "compute/math/morton.hpp"
#include "tests/engine/gl/offscreen.hpp"
#include "tests/engine/render/flow_scene.hpp"

namespace nacre {
namespace {

class Boxes : public test::Offscreen {
 protected:
  void open(const std::string& embedding) {
    scene_.emplace("torus", 32, 96, 4, embedding);
    boxes_ = scene_->pipeline->flow().boxes();
    codes_.assign(boxes_.count() + 1, 77);  // one more, which stays
    scene_->pipeline->flow().show_boxes(codes_.data());
    ASSERT_GE(boxes_.level_start.size(), 2u);
    ASSERT_GT(boxes_.width, 0);
  }

  void TearDown() override {
    scene_.reset();  // before the context
    test::Offscreen::TearDown();
  }

  std::size_t levels() const { return boxes_.level_start.size() - 1; }
  std::vector<std::uint64_t> level(std::size_t l) const {
    return {codes_.begin() + long(boxes_.level_start[l]), codes_.begin() + long(boxes_.level_start[l + 1])};
  }

  /// Every position of the surface is in a box of the finest level.
  void expect_cover() {
    const std::vector<std::uint64_t> finest = level(levels() - 1);
    const std::set<std::uint64_t> known(finest.begin(), finest.end());
    EXPECT_EQ(known.size(), finest.size());
    EXPECT_EQ(codes_.back(), 77u);
    std::size_t outside = 0;
    for (const Vec3d& p : scene_->surface.points) {
      const Vec3d at = (p - boxes_.origin) / boxes_.width;
      outside += !known.contains(morton({int(std::floor(at.x)), int(std::floor(at.y)), int(std::floor(at.z))}));
    }
    EXPECT_EQ(outside, 0u);
  }

  /// `cells`: of the texture, along the edge of a smallest box.
  void expect_boxes(std::size_t levels_wanted, int cells) {
    EXPECT_EQ(levels(), levels_wanted);
    EXPECT_DOUBLE_EQ(boxes_.width, cells * scene_->pipeline->flow().embedding().cell_size);
    expect_cover();
  }

  /// The boxes of a level are those around the next one's, in order.
  void expect_tree() {
    EXPECT_EQ(level(0), std::vector<std::uint64_t>{0});
    for (std::size_t l = 0; l + 1 < levels(); ++l) {
      std::vector<std::uint64_t> around = level(l + 1);
      for (std::uint64_t& code : around) code >>= 3;
      EXPECT_TRUE(std::is_sorted(around.begin(), around.end())) << l;
      around.erase(std::unique(around.begin(), around.end()), around.end());
      EXPECT_EQ(level(l), around) << l;
    }
  }

  std::optional<test::FlowScene> scene_;
  FlowBoxes boxes_;
  std::vector<std::uint64_t> codes_;
};

TEST_F(Boxes, OfTheBrickOctreeAreItsNodesAndBricks) {
  open("brick");
  expect_boxes(5, 8);  // 8 << 4 cells per axis
  expect_tree();
}

TEST_F(Boxes, OfTheThesisOctreeAreItsNodes) {
  open("thesis");
  expect_boxes(7, 2);
  expect_tree();
}

TEST_F(Boxes, OfTheGridAreItsBricks) {
  open("grid");
  expect_boxes(1, 16);  // subcells x refine
}

}  // namespace
}  // namespace nacre
