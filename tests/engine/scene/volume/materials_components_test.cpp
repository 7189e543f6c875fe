// Nacre: tests of dropping small components.
#include <algorithm>

#include "engine/scene/volume/materials_parts.hpp"
#include "tests/engine/scene/volume/small_volumes.hpp"

namespace nacre::test {
namespace {

/// 5 x 5 x 5 voxels: material 1 in the middle 3 x 3 x 3, the outside around.
std::vector<std::uint8_t> cube() {
  std::vector<std::uint8_t> values(125, 0);
  for (int k = 1; k < 4; ++k)
    for (int j = 1; j < 4; ++j)
      for (int i = 1; i < 4; ++i) values[std::size_t((k * 5 + j) * 5 + i)] = 1;
  return values;
}
constexpr std::size_t middle = (2 * 5 + 2) * 5 + 2;

MeshVolume cleaned(const std::vector<std::uint8_t>& values, std::int64_t fewest,
                   std::vector<std::string>* warnings = nullptr) {
  MaterialOptions options;
  options.min_component = fewest;
  return materials_of(volume_of({5, 5, 5}, values), options, warnings);
}

TEST(SmallComponents, SpeckleTakesWhatSurroundsIt) {
  std::vector<std::uint8_t> values = cube();
  values[middle] = 2;
  values[0] = 1;
  values[4] = 3;
  EXPECT_EQ(cleaned(values, 0).labels, (Labels{0, 1, 2, 3}));
  std::vector<std::string> warnings;
  const MeshVolume mesh = cleaned(values, 2, &warnings);
  const std::vector<std::uint8_t> expected = cube();
  const std::vector<std::uint16_t> material = mesh.material.copy();
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), material.begin(), material.end()));
  EXPECT_EQ(mesh.labels, (Labels{0, 1}));
  ASSERT_EQ(warnings.size(), 3u);
  EXPECT_TRUE(contains(warnings[0], "3 components of fewer than 2 voxels (3 voxels)")) << warnings[0];
  EXPECT_TRUE(contains(warnings[1], "Nothing is left of label 2"));
}

TEST(SmallComponents, NumbersCloseUpAfterALostLabel) {
  std::vector<std::uint8_t> values = cube();
  values[middle] = 7;
  std::replace(values.begin(), values.end(), std::uint8_t(1), std::uint8_t(9));
  const MeshVolume mesh = cleaned(values, 2);
  EXPECT_EQ(mesh.labels, (Labels{0, 9}));
  const std::vector<std::uint16_t> material = mesh.material.copy();
  EXPECT_EQ(*std::max_element(material.begin(), material.end()), 1);
}

TEST(SmallComponents, NamesStayWithTheirLabels) {
  std::vector<std::uint8_t> values = cube();
  values[middle] = 2;
  values[middle + 1] = values[middle + 2] = 3;
  Volume volume = volume_of({5, 5, 5}, values);
  volume.label_names = {{1, "all around"}, {2, "speck"}, {3, "bar"}, {8, "nowhere"}};
  MaterialOptions options;
  EXPECT_EQ(materials_of(volume, options).names, (std::vector<std::string>{"outside", "all around", "speck", "bar"}));
  options.min_component = 2;
  EXPECT_EQ(materials_of(volume, options).names, (std::vector<std::string>{"outside", "all around", "bar"}));
  options.merge = {{1, 3}};
  EXPECT_EQ(materials_of(volume, options).names, (std::vector<std::string>{"outside", "bar"}));
  volume.label_names = {{8, "nowhere"}};
  EXPECT_TRUE(materials_of(volume).names.empty());
}

TEST(SmallComponents, HolesAreFilledButTheOutsideAtTheFacesStays) {
  std::vector<std::uint8_t> values(125, 1);
  values[middle] = 0;  // a hole
  values[0] = 0;       // one voxel of the outside at the volume's corner
  const MeshVolume mesh = cleaned(values, 5);
  EXPECT_EQ(mesh.material[middle], 1);
  EXPECT_EQ(mesh.material[0], 0);
}

TEST(SmallComponents, PartsThatGrowTogetherStay) {
  std::vector<std::uint8_t> values = cube();
  values[middle] = 2;
  values[middle + 1] = 3;  // the two touch each other: the first becomes 1, or they become one part of two voxels
  const MeshVolume mesh = cleaned(values, 2);
  for (std::size_t i = 0; i < 125; ++i) EXPECT_EQ(mesh.material[i], cube()[i]);
}

TEST(SmallComponents, APartBesideOneThatWasGivenToItStays) {
  std::vector<std::uint8_t> values(125, 1);
  values[0] = 2;                          // in the corner: two of its three neighbours are 3
  values[1] = values[5] = values[6] = 3;  // too small alone, but not with that one
  const MeshVolume mesh = cleaned(values, 4);
  EXPECT_EQ(mesh.labels, (Labels{0, 1, 3}));
  for (const std::size_t voxel : {0, 1, 5, 6}) EXPECT_EQ(mesh.material[voxel], 2) << voxel;
}

TEST(SmallComponents, DiagonalNeighboursAreNotConnected) {
  std::vector<std::uint8_t> values(125, 0);
  std::fill(values.begin() + 75, values.end(), std::uint8_t(1));
  values[0] = 1;
  values[6] = 1;  // shares an edge with the first
  EXPECT_EQ(cleaned(values, 2).material[0], 0);
  EXPECT_EQ(cleaned(values, 2).material[6], 0);
  values[1] = 1;  // shares a face with both
  EXPECT_EQ(cleaned(values, 3).material[0], 1);
}

TEST(SmallComponents, CheckerboardEnds) {
  std::vector<std::uint8_t> values(125);
  for (std::size_t i = 0; i < 125; ++i) values[i] = std::uint8_t(1 + (i % 5 + i / 5 % 5 + i / 25) % 3);
  const MeshVolume mesh = cleaned(values, 10);
  EXPECT_GE(mesh.materials(), 2);
}

TEST(SmallComponents, ValuesFollow) {
  std::vector<float> scalar(125, 0.1f);
  for (std::size_t i = 0; i < 125; ++i)
    if (cube()[i]) scalar[i] = 0.9f;
  scalar[0] = 0.8f;       // a speckle above the level
  scalar[middle] = 0.2f;  // a hole below
  MaterialOptions options;
  options.isovalues = {0.5};
  options.min_component = 2;
  const MeshVolume mesh = materials_of(volume_of({5, 5, 5}, scalar), options);
  EXPECT_EQ(mesh.material[0], 0);
  EXPECT_EQ(mesh.material[middle], 1);
  EXPECT_NEAR(mesh.values[0][0], 0.2f, 1e-6);
  EXPECT_NEAR(mesh.values[0][middle], 0.8f, 1e-6);

  std::vector<float> a(125), b(125);
  for (std::size_t i = 0; i < 125; ++i) (cube()[i] ? a : b)[i] = 1;
  std::swap(a[middle], b[middle]);
  options.isovalues = {};
  const std::vector<Volume> volumes = {volume_of<float>({5, 5, 5}, a), volume_of<float>({5, 5, 5}, b)};
  const MeshVolume indicators = make_mesh_volume(volumes, options);
  EXPECT_EQ(indicators.material[middle], 1);
  EXPECT_GT(indicators.values[1][middle], indicators.values[2][middle]);
}

TEST(SmallComponents, NothingLeft) {
  std::vector<std::uint8_t> values(125, 0);
  values[middle] = 1;
  MaterialOptions options;
  options.min_component = 2;
  EXPECT_TRUE(contains(refusal(volume_of({5, 5, 5}, values), options), "nothing to mesh"));
  EXPECT_TRUE(contains(refusal(volume_of({5, 5, 5}, values), options), "lower --min-component"));
}

}  // namespace
}  // namespace nacre::test
