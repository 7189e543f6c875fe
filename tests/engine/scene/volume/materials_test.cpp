// Nacre: tests of materials from label maps, scalar volumes and indicators.
#include "engine/scene/volume/materials.hpp"

#include <cmath>
#include <limits>

#include "tests/engine/scene/volume/small_volumes.hpp"

namespace nacre::test {
namespace {

const Int3 eight(2, 2, 2);
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Volume gaps() { return volume_of<std::uint8_t>(eight, {0, 4, 4, 9, 0, 200, 9, 9}); }

TEST(VolumeValues, StatisticsAndLabels) {
  const Volume volume = volume_of<float>(eight, {1, 2, nan, 2, infinity, -3, 2, 1});
  const VolumeStatistics statistics = volume_statistics(volume);
  EXPECT_EQ(statistics.min, -3);
  EXPECT_EQ(statistics.max, 2);
  EXPECT_EQ(statistics.nan, 1u);
  EXPECT_EQ(statistics.infinite, 1u);
  EXPECT_TRUE(statistics.integral);
  EXPECT_EQ(count_labels(volume, 3), (std::vector<LabelCount>{{-3, 1}, {1, 2}, {2, 3}}));
  EXPECT_FALSE(count_labels(volume, 2));
  EXPECT_FALSE(count_labels(volume_of<float>(eight, std::vector<float>(8, 0.5f)), 10));
  EXPECT_FALSE(volume_statistics(volume_of<double>(eight, std::vector<double>(8, 1e18))).integral);
}

TEST(LabelMaterials, GapsAreClosedAndTheGridKept) {
  Volume volume = gaps();
  volume.spacing = {1, 2, 3};
  volume.origin = {4, 5, 6};
  volume.axes = {Vec3d(0, 1, 0), Vec3d(1, 0, 0), Vec3d(0, 0, 1)};
  const MeshVolume mesh = materials_of(volume);
  EXPECT_EQ(mesh.kind, MeshVolume::Kind::labels);
  EXPECT_EQ(mesh.labels, (Labels{0, 4, 9, 200}));
  EXPECT_EQ(mesh.material.copy(), (Materials{0, 1, 1, 2, 0, 3, 2, 2}));
  EXPECT_EQ(mesh.dims, eight);
  EXPECT_EQ(mesh.spacing, Vec3d(1, 2, 3));
  EXPECT_EQ(mesh.origin, Vec3d(4, 5, 6));
  EXPECT_EQ(mesh.axes[0], Vec3d(0, 1, 0));
  EXPECT_TRUE(mesh.values.empty());
}

TEST(LabelMaterials, NegativeLabelsFloatsAndNoZero) {
  const MeshVolume negative = materials_of(volume_of<std::int16_t>(eight, {-5, -5, 7, 7, 0, 0, 7, 7}));
  EXPECT_EQ(negative.labels, (Labels{0, -5, 7}));
  const MeshVolume floats = materials_of(volume_of<double>(eight, {1, 1, 1, 1, 2, 2, 2, 2}));
  EXPECT_EQ(floats.labels, (Labels{0, 1, 2}));
  EXPECT_EQ(floats.material.copy(), (Materials{1, 1, 1, 1, 2, 2, 2, 2}));
}

TEST(LabelMaterials, ChosenMaterials) {
  MaterialOptions options;
  options.materials = {9, 200};
  EXPECT_EQ(materials_of(gaps(), options).labels, (Labels{0, 9, 200}));
  EXPECT_EQ(materials_of(gaps(), options).material.copy(), (Materials{0, 0, 0, 1, 0, 2, 1, 1}));
  options.materials = {0, 4};  // the background as a material of its own
  EXPECT_EQ(materials_of(gaps(), options).labels, (Labels{-1, 0, 4}));
  EXPECT_EQ(materials_of(gaps(), options).material.copy(), (Materials{1, 2, 2, 0, 1, 0, 0, 0}));
  options.materials = {5};
  EXPECT_TRUE(contains(refusal(gaps(), options), "no label 5 (there are 0, 4, 9, 200)")) << refusal(gaps(), options);
}

TEST(LabelMaterials, Merging) {
  MaterialOptions options;
  options.merge = {{4, 9}};
  EXPECT_EQ(materials_of(gaps(), options).labels, (Labels{0, 9, 200}));
  EXPECT_EQ(materials_of(gaps(), options).material.copy(), (Materials{0, 1, 1, 1, 0, 2, 1, 1}));
  options.merge = {{4, 9}, {9, 4}};  // all at once: they change positions
  EXPECT_EQ(materials_of(gaps(), options).material.copy(), (Materials{0, 2, 2, 1, 0, 3, 1, 1}));
  options.merge = {{200, 0}};
  EXPECT_EQ(materials_of(gaps(), options).labels, (Labels{0, 4, 9}));
  options.merge = {{4, 9}};
  options.materials = {4};
  EXPECT_TRUE(contains(refusal(gaps(), options), "no label 4 (there are 0, 9, 200)"));
  options = {};
  options.merge = {{3, 4}};
  EXPECT_TRUE(contains(refusal(gaps(), options), "no label 3"));
  options.merge = {{4, 9}, {4, 200}};
  EXPECT_TRUE(contains(refusal(gaps(), options), "cannot be merged into two"));
}

TEST(LabelMaterials, WhatIsNoNumberIsOutside) {
  MaterialOptions options;
  options.mode = MaterialOptions::Mode::labels;
  std::vector<std::string> warnings;
  const MeshVolume mesh = materials_of(volume_of<float>(eight, {0, 1, nan, 2, 2, infinity, 0, 1}), options, &warnings);
  EXPECT_EQ(mesh.material.copy(), (Materials{0, 1, 0, 2, 2, 0, 0, 1}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], "2 voxels that are not numbers"));
}

TEST(LabelMaterials, NothingToMesh) {
  MaterialOptions labels;
  labels.mode = MaterialOptions::Mode::labels;
  EXPECT_TRUE(contains(refusal(volume_of<std::uint8_t>(eight, std::vector<std::uint8_t>(8, 3))),
                       "one material only (every voxel is 3)"));
  EXPECT_NE(refusal(volume_of<std::uint8_t>(eight, std::vector<std::uint8_t>(8, 0))), "");
  EXPECT_TRUE(contains(refusal(volume_of<float>(eight, std::vector<float>(8, nan)), labels), "none of its voxels"));
  MaterialOptions merged;
  merged.merge = {{4, 0}, {9, 0}, {200, 0}};
  EXPECT_TRUE(contains(refusal(gaps(), merged), "no label but the outside"));
  const std::string fractions = refusal(volume_of<float>(eight, {0, 0.5f, 1, 2, 3, 4, 5, 6}), labels);
  EXPECT_TRUE(contains(fractions, "not a label map") && contains(fractions, "0 to 6")) << fractions;
}

TEST(ScalarMaterials, OneAndSeveralLevels) {
  MaterialOptions options;
  options.isovalues = {5, 2};
  const MeshVolume mesh = materials_of(volume_of<std::uint8_t>(eight, {0, 1, 2, 3, 4, 5, 6, 7}), options);
  EXPECT_EQ(mesh.kind, MeshVolume::Kind::scalar);
  EXPECT_EQ(mesh.levels, (std::vector<float>{2, 5}));
  EXPECT_EQ(mesh.labels, (Labels{0, 1, 2}));
  EXPECT_EQ(mesh.material.copy(), (Materials{0, 0, 1, 1, 1, 2, 2, 2}));
  ASSERT_EQ(mesh.values.size(), 1u);
  EXPECT_EQ(mesh.values[0], (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(ScalarMaterials, WhatIsNoNumberIsOutside) {
  MaterialOptions options;
  options.isovalues = {0.5};
  std::vector<std::string> warnings;
  const MeshVolume mesh =
      materials_of(volume_of<float>(eight, {0, 1, nan, 1, infinity, -infinity, 1, 0}), options, &warnings);
  EXPECT_EQ(mesh.material.copy(), (Materials{0, 1, 0, 1, 1, 0, 1, 0}));
  EXPECT_EQ(mesh.values[0], (std::vector<float>{0, 1, 0, 1, 1, 0, 1, 0}));
  EXPECT_EQ(warnings.size(), 2u);
}

TEST(ScalarMaterials, WithoutASurface) {
  const Volume volume = volume_of<float>(eight, {0, 0.5f, 1, 2, 3, 4, 5, 6});
  const auto at = [&](std::vector<double> levels) {
    MaterialOptions options;
    options.isovalues = std::move(levels);
    return refusal(volume, options);
  };
  EXPECT_TRUE(contains(at({7}), "no surface at iso-value 7 (the values run from 0 to 6)")) << at({7});
  EXPECT_NE(at({0}), "");  // all of it is inside
  EXPECT_NE(at({-1}), "");
  EXPECT_NE(at({std::nan("")}), "");
  EXPECT_TRUE(contains(at({1, 2, 1}), "given twice"));
  EXPECT_EQ(at({6}), "");
  EXPECT_TRUE(contains(refusal(volume), "needs an iso-value") && contains(refusal(volume), "0 to 6"))
      << refusal(volume);
  MaterialOptions options;
  options.isovalues = {1};
  EXPECT_TRUE(contains(refusal(volume_of<float>(eight, std::vector<float>(8, 2)), options), "one value only"));
}

TEST(ScalarMaterials, OtsuSplitsTwoGroups) {
  const double cut = otsu_threshold(volume_of<float>(eight, {0, 1, 0.5f, 1, 10, 11, 10.5f, 10}));
  EXPECT_NEAR(cut, 5.5, 0.05) << "in the middle of the gap from 1 to 10";
}

TEST(ThresholdMaterials, BetweenTwoValues) {
  MaterialOptions options;
  options.threshold = {1.5, 4.25};
  const MeshVolume mesh = materials_of(volume_of<float>(eight, {0, 1, 2, 3, 4, 5, nan, 2.5f}), options);
  EXPECT_EQ(mesh.kind, MeshVolume::Kind::indicators);
  EXPECT_EQ(mesh.labels, (Labels{0, 1}));
  EXPECT_EQ(mesh.material.copy(), (Materials{0, 0, 1, 1, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.values[1][2], 0.5f);
  EXPECT_EQ(mesh.values[1][4], 0.25f);
  EXPECT_EQ(mesh.values[0][4], -0.25f);
  options.threshold = {2, 3};  // whole values on the bounds are inside
  EXPECT_EQ(materials_of(volume_of<std::uint8_t>(eight, {0, 1, 2, 3, 4, 5, 6, 7}), options).material.copy(),
            (Materials{0, 0, 1, 1, 0, 0, 0, 0}));
  options.threshold = {4, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(materials_of(volume_of<std::uint8_t>(eight, {0, 1, 2, 3, 4, 5, 6, 7}), options).material.copy(),
            (Materials{0, 0, 0, 0, 1, 1, 1, 1}));
  for (const auto& [low, high] :
       {std::pair(8.0, 9.0), std::pair(-1.0, 9.0), std::pair(3.0, 2.0), std::pair(std::nan(""), 2.0)}) {
    options.threshold = {low, high};
    EXPECT_NE(refusal(volume_of<std::uint8_t>(eight, {0, 1, 2, 3, 4, 5, 6, 7}), options), "") << low << ":" << high;
  }
}

std::vector<Volume> probabilities() {
  return {volume_of<std::uint8_t>(eight, {255, 200, 100, 0, 0, 0, 0, 50}, "a.nii.gz"),
          volume_of<std::uint8_t>(eight, {0, 55, 105, 255, 100, 20, 0, 50}, "b.nrrd")};
}

TEST(LabelMaterials, EightBitsOfAnImageAreNoLabels) {
  std::vector<std::uint8_t> image, patches;
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const bool inside = x > 2 && y > 2;
        image.push_back(std::uint8_t(inside ? 9 * x + 5 * y + 3 * z : 0));
        patches.push_back(std::uint8_t(inside ? 1 + x / 4 + 4 * (y / 4) + 16 * (z / 4) : 0));
      }
  const Volume of_image = volume_of({16, 16, 16}, image), of_patches = volume_of({16, 16, 16}, patches);
  const std::string why = refusal(of_image);
  EXPECT_TRUE(contains(why, "needs an iso-value") && contains(why, "--labels")) << why;
  EXPECT_EQ(materials_of(of_patches).labels.size(), 65u);
  MaterialOptions options;
  options.mode = MaterialOptions::Mode::labels;
  EXPECT_GT(materials_of(of_image, options).labels.size(), 100u);
}

TEST(IndicatorMaterials, ProbabilitiesLeaveTheRestToTheOutside) {
  const std::vector<Volume> volumes = probabilities();
  const MeshVolume mesh = make_mesh_volume(volumes, {});
  EXPECT_EQ(mesh.kind, MeshVolume::Kind::indicators);
  EXPECT_EQ(mesh.labels, (Labels{0, 1, 2}));
  EXPECT_EQ(mesh.names, (std::vector<std::string>{"outside", "a", "b"}));
  EXPECT_EQ(mesh.material.copy(), (Materials{1, 1, 2, 2, 0, 0, 0, 0}));
  ASSERT_EQ(mesh.values.size(), 3u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(mesh.values[0][i] + mesh.values[1][i] + mesh.values[2][i], 1, 1e-6);
  EXPECT_FLOAT_EQ(mesh.values[1][1], 200 / 255.0f);
}

TEST(IndicatorMaterials, ChosenAndMerged) {
  const std::vector<Volume> volumes = probabilities();
  MaterialOptions options;
  options.materials = {2};
  const MeshVolume chosen = make_mesh_volume(volumes, options);
  EXPECT_EQ(chosen.labels, (Labels{0, 2}));
  EXPECT_EQ(chosen.names[1], "b");
  EXPECT_EQ(chosen.material.copy(), (Materials{0, 0, 0, 1, 0, 0, 0, 0}));
  options.materials = {};
  options.merge = {{1, 2}};
  const MeshVolume merged = make_mesh_volume(volumes, options);
  EXPECT_EQ(merged.labels, (Labels{0, 2}));
  EXPECT_NEAR(merged.values[1][2], 205 / 255.0f, 1e-6);
  EXPECT_EQ(merged.material.copy(), (Materials{1, 1, 1, 1, 0, 0, 0, 0}));
  options.merge = {{3, 1}};
  EXPECT_TRUE(contains(refusal(volumes, options), "no label 3 (there are 1, 2)"));
}

TEST(IndicatorMaterials, FunctionsAreTakenAsTheyAre) {
  const std::vector<Volume> volumes = {volume_of<float>(eight, {3, 1, -1, -3, 3, 1, -1, nan}, "left.nrrd"),
                                       volume_of<float>(eight, {-3, -1, 1, 3, -3, -1, 1, 3}, "right.nrrd")};
  const MeshVolume mesh = make_mesh_volume(volumes, {});
  EXPECT_EQ(mesh.material.copy(), (Materials{1, 1, 2, 2, 1, 1, 2, 2}));
  EXPECT_EQ(mesh.values[1][0], 3);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_FALSE(std::isnan(mesh.values[1][i]));
  MaterialOptions options;
  options.materials = {2};  // where the other would be is outside
  EXPECT_EQ(make_mesh_volume(volumes, options).material.copy(), (Materials{0, 0, 1, 1, 0, 0, 1, 1}));
}

TEST(IndicatorMaterials, OtherGridsAreNamed) {
  std::vector<Volume> volumes = probabilities();
  volumes[1].spacing.y = 1.5;
  const std::string why = refusal(volumes);
  EXPECT_TRUE(contains(why, "a.nii.gz and b.nrrd are not on the same grid (spacing 1 and 1.5 along axis 1)")) << why;
  volumes = probabilities();
  volumes[1].origin.x = 0.5;
  EXPECT_TRUE(contains(refusal(volumes), "origins"));
  volumes = probabilities();
  volumes[1].axes = {Vec3d(0, 1, 0), Vec3d(1, 0, 0), Vec3d(0, 0, 1)};
  EXPECT_TRUE(contains(refusal(volumes), "axis 0 points"));
  volumes = {probabilities()[0], volume_of<std::uint8_t>({4, 2, 1}, std::vector<std::uint8_t>(8, 1))};
  EXPECT_TRUE(contains(refusal(volumes), "2 x 2 x 2 voxels and 4 x 2 x 1"));
}

TEST(MaterialOptionsTest, ThatDoNotGoTogether) {
  const Volume volume = gaps();
  MaterialOptions options;
  EXPECT_NE(refusal(std::span<const Volume>(), options), "");
  options.mode = MaterialOptions::Mode::isovalue;
  EXPECT_TRUE(contains(refusal(volume, options), "no iso-value"));
  options.isovalues = {3};
  EXPECT_EQ(refusal(volume, options), "");
  options.materials = {4};
  EXPECT_NE(refusal(volume, options), "");
  options.materials = {};
  EXPECT_NE(refusal(probabilities(), options), "");
  options.threshold = {1, 2};
  EXPECT_NE(refusal(volume, options), "");
  options = {};
  options.mode = MaterialOptions::Mode::labels;
  EXPECT_NE(refusal(probabilities(), options), "");
  options.isovalues = {3};
  EXPECT_NE(refusal(volume, options), "");
}

TEST(MaterialOptionsTest, ManyLabelsLookLikeAnImage) {
  std::vector<std::uint8_t> values(432);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(i / 4);
  std::vector<std::string> warnings;
  EXPECT_EQ(materials_of(volume_of({12, 6, 6}, values), {}, &warnings).labels.size(), 108u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], "give --isovalue"));
  std::vector<std::int16_t> more(343);
  for (std::size_t i = 0; i < more.size(); ++i) more[i] = std::int16_t(i);
  EXPECT_TRUE(contains(refusal(volume_of({7, 7, 7}, more)), "needs an iso-value"));
}

}  // namespace
}  // namespace nacre::test
