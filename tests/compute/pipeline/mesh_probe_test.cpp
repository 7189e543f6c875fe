// Nacre: a mesh run probed: fields at points, particles and boxes as a renderer gets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"
#include "tests/compute/pipeline/shown_memory.hpp"

namespace nacre::test {
namespace {

/// Turned, stretched and moved.
MeshVolume askew(MeshVolume volume) {
  volume.spacing = {0.5, 1, 0.8};
  volume.origin = {100, -20, 3};
  volume.axes = {Vec3d(0, 1, 0), Vec3d(-1, 0, 0), Vec3d(0, 0, 1)};
  return volume;
}

Vec3d world(const MeshVolume& volume, const Vec3d& index) {
  Vec3d p = volume.origin;
  for (int k = 0; k < 3; ++k) p += volume.axes[k] * (index[k] * volume.spacing[k]);
  return p;
}

TEST(MeshLook, PointsOfTheWorldHaveMaterialsAndSizes) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = askew(three_materials());
  const std::vector<Vec3d> points{world(volume, {12, 12, 12}),
                                  world(volume, {20, 12, 12}),
                                  world(volume, {2, 2, 20}),
                                  world(volume, {23, 3, 2}),
                                  {0, 0, 0},
                                  {NAN, 0, 0}};
  pipeline->load(volume);
  EXPECT_THROW(pipeline->material_at(points), Error) << "no fields yet";
  EXPECT_THROW(pipeline->field_at(MeshField::size, points), Error);
  pipeline->build_fields();
  EXPECT_EQ(pipeline->material_at(points), (std::vector<std::uint16_t>{1, 2, 0, 3, 0, 0}));
  EXPECT_EQ(pipeline->field_at(MeshField::material, points), (std::vector<float>{1, 2, 0, 3, 0, 0}));
  const std::vector<float> size = pipeline->field_at(MeshField::size, points),
                           distance = pipeline->field_at(MeshField::distance, points);
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(size[k], 0.1f);
    EXPECT_LE(size[k], 0.5f * 1.001f);  // the largest size is one edge of the smallest spacing
  }
  EXPECT_EQ(distance[2], std::numeric_limits<float>::infinity()) << "farther than was looked";
  for (int k = 4; k < 6; ++k) {
    EXPECT_TRUE(std::isnan(size[k]));
    EXPECT_TRUE(std::isnan(distance[k]));
  }
}

TEST(MeshLook, DistancesAreThoseFromTheBall) {
  const auto device = make_cpu_device();
  const Vec3d c(13.2, 12.7, 13.1);
  MeshVolume volume = scalar_volume({27, 26, 27}, ball(c, 8.3));
  volume.spacing = Vec3d(0.25);
  const auto pipeline = make_mesh_pipeline(*device);
  pipeline->load(volume);
  pipeline->build_fields();
  std::vector<Vec3d> points;
  std::vector<double> expected;
  for (const Vec3d& d : even_directions(500))
    for (const double off : {-3.0, -1.0, -0.3, 0.0, 0.2, 0.7, 2.0, 3.0}) {
      points.push_back(world(volume, c + d * (8.3 + off)));
      expected.push_back(0.25 * std::fabs(off));
    }
  const std::vector<float> distance = pipeline->field_at(MeshField::distance, points);
  double most = 0;
  for (std::size_t k = 0; k < points.size(); ++k) most = std::max(most, std::fabs(distance[k] - expected[k]));
  EXPECT_LT(most, 0.25 * 0.12) << "a tenth of a voxel";
}

/// Five balls in a large ball, as labels.
MeshVolume organs(int n) {
  return label_volume(Int3(n), 7, [n](const Vec3d& p) {
    const Vec3d u = p / n - Vec3d(0.5);
    const Vec3d centres[] = {{0.2, 0, 0}, {-0.15, 0.1, 0.1}, {0, -0.2, 0.02}, {0.05, 0.2, -0.1}, {-0.1, -0.1, 0}};
    for (int k = 0; k < 5; ++k)
      if (length(u - centres[k]) < 0.13) return k + 2;
    return length(u) < 0.42 ? 1 : 0;
  });
}

std::vector<Vec3d> slice(double width, double z) {
  std::vector<Vec3d> points;
  for (int k = 0; k < 512 * 512; ++k) points.push_back({k % 512 * width / 512, double(k / 512) * width / 512, z});
  return points;
}

TEST(MeshLook, MaterialsOfPicturesAreTheMaterials) {
  const auto device = make_cpu_device();
  for (const MeshVolume& volume : {three_materials(), three_balls(), organs(40)}) {
    const auto pipeline = make_mesh_pipeline(*device);
    pipeline->load(volume);
    pipeline->build_fields();
    for (const double z : {6.3, 12.3, 19.9}) {
      const std::vector<Vec3d> points = slice(volume.dims.x, z);
      const std::vector<std::uint16_t> exact = pipeline->material_at(points);
      const std::vector<float> shown = pipeline->field_at(MeshField::material, points);
      std::size_t differ = 0;
      for (std::size_t i = 0; i < points.size(); ++i) differ += exact[i] != shown[i] ? 1 : 0;
      EXPECT_EQ(differ, 0) << z;
    }
  }
}

class MeshShow : public ::testing::TestWithParam<std::string> {
 protected:
  static constexpr std::int64_t capacity = 20000;

  void SetUp() override {
    pipeline_->parameters.solver = GetParam();
    pipeline_->parameters.iterations = 20;
    pipeline_->load(volume_);
    EXPECT_EQ(pipeline_->show_particles(lent()).total(), 0) << "none yet";
    EXPECT_EQ(pipeline_->show_boxes(boxes_.data(), capacity), 0);
    pipeline_->build_fields();
  }

  ShownParticles lent() const { return shown_memory(position_, direction_); }

  /// Boxes have particles in them, and those of the order that moves lie in one. `slack`: voxels.
  void expect_boxes(int order, float slack = 1e-4f) {
    const ShownCounts counts = pipeline_->show_particles(lent());
    const std::int64_t n = pipeline_->show_boxes(boxes_.data(), capacity);
    ASSERT_GT(n, 0);
    ASSERT_LE(n, capacity);
    const std::vector<Float4> position = position_.view();
    const std::vector<ShownBox> boxes = boxes_.view();
    std::vector<int> inside(std::size_t(n), 0);
    for (std::int64_t i = 0; i < counts.total(); ++i) {
      const Float4 p = position[std::size_t(i)];
      bool any = false;
      for (std::size_t b = 0; b < std::size_t(n); ++b) {
        const Vec3f &low = boxes[b].low, &high = boxes[b].high;
        if (p.x < low.x - slack || p.y < low.y - slack || p.z < low.z - slack || p.x > high.x + slack ||
            p.y > high.y + slack || p.z > high.z + slack)
          continue;
        any = true;
        ++inside[b];
      }
      EXPECT_TRUE(any || order_of(counts, i) != order) << i;
    }
    const auto empty = std::count(inside.begin(), inside.end(), 0);
    EXPECT_LE(empty, slack > 0.1f ? 3 : 0);  // the last step takes particles away that have lost their interface
  }

  const MeshVolume volume_ = askew(three_balls());
  const std::unique_ptr<Device> device_ = make_cpu_device(2, true);  // memory that the host cannot look into
  const std::unique_ptr<MeshPipeline> pipeline_ = make_mesh_pipeline(*device_);
  const Lent<Float4> position_{*device_, capacity}, direction_{*device_, capacity};
  const Lent<ShownBox> boxes_{*device_, capacity};
};

TEST_P(MeshShow, ParticlesAreShownAsTheyAreOrderByOrder) {
  pipeline_->relax();
  expect_shown(*pipeline_, position_, direction_);
  const ShownCounts counts = pipeline_->show_particles(lent());
  EXPECT_EQ(counts.points, pipeline_->info().points);
  EXPECT_GT(counts.points, 0);
  EXPECT_GT(counts.curves, 10);
  EXPECT_GT(counts.surfaces, 200);
  expect_boxes(2, 0.3f);  // the last step onto the fields comes after the tree
  pipeline_->triangulate();
  expect_shown(*pipeline_, position_, direction_);
}

TEST_P(MeshShow, TheyCanBeFollowedWhileTheyMove) {
  int curves_alone = 0, with_surfaces = 0, smoothing = 0;
  pipeline_->progress = [&](const MeshProgress& p) {
    const bool smooths = p.stage == "smooth";
    if (p.iteration == 0 || (!smooths && p.iteration % 4 != 1)) return;
    const ShownCounts counts = pipeline_->show_particles(lent());
    EXPECT_EQ(counts.total(), p.particles);
    EXPECT_EQ(counts.points, pipeline_->info().points);
    EXPECT_GT(counts.curves, 0);
    ++(smooths ? smoothing : counts.surfaces == 0 ? curves_alone : with_surfaces);
    expect_shown(*pipeline_, position_, direction_);
    if (!smooths) expect_boxes(counts.surfaces == 0 ? 1 : 2);  // the tree is not needed any more
  };
  pipeline_->relax();
  pipeline_->triangulate();
  EXPECT_GE(curves_alone, 3);
  EXPECT_GE(with_surfaces, 3);
  EXPECT_GE(smoothing, 6);
  const SurfaceMesh followed = pipeline_->triangulate();
  pipeline_->progress = nullptr;
  pipeline_->relax();
  expect_same(pipeline_->triangulate(), followed);  // looking changes nothing
}

TEST_P(MeshShow, NothingIsWrittenWhereItDoesNotFit) {
  pipeline_->relax();
  const ShownCounts counts = pipeline_->show_particles({});
  EXPECT_GT(counts.total(), 200);
  ShownParticles small = lent();
  small.capacity = counts.total() - 1;
  EXPECT_EQ(pipeline_->show_particles(small).total(), counts.total());
  EXPECT_TRUE(position_.untouched());
  EXPECT_TRUE(direction_.untouched());
  const std::int64_t boxes = pipeline_->show_boxes(nullptr, 0);
  EXPECT_GT(boxes, 10);
  EXPECT_EQ(pipeline_->show_boxes(boxes_.data(), boxes - 1), boxes);
  EXPECT_TRUE(boxes_.untouched());
  small.capacity = counts.total();
  pipeline_->show_particles(small);
  EXPECT_FALSE(position_.untouched());
  EXPECT_FALSE(direction_.untouched());
  pipeline_->show_boxes(boxes_.data(), boxes);
  EXPECT_FALSE(boxes_.untouched());
}

INSTANTIATE_TEST_SUITE_P(By, MeshShow, ::testing::Values("tree", "redblack", "serial"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace nacre::test
