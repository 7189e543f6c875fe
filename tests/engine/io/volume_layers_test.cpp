// Nacre: tests of segmentations whose segments overlap, and lie in layers of a 4-D NRRD.
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

using Layers = VolumeTest;

constexpr const char* head =
    "NRRD0004\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nencoding: raw\nspace origin: (0,0,0)\n";
constexpr const char* layers_first =
    "sizes: 2 3 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n";
constexpr const char* layers_last =
    "sizes: 3 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1) none\nkinds: domain domain domain list\n";

std::string segment(int number, const std::string& name, int label, int layer) {
  const std::string key = "Segment" + std::to_string(number) + "_";
  return key + "Name:=" + name + "\n" + key + "LabelValue:=" + std::to_string(label) + "\n" + key +
         "Layer:=" + std::to_string(layer) + "\n";
}

const std::string body = segment(0, "body", 1, 0), tumour = segment(1, "tumour", 2, 1),
                  vessel = segment(2, "vessel", 3, 1);

/// Layer 0 is 1 everywhere but in the first voxel; layer 1 has 2, 3 and an unknown 9.
const std::vector<int> below = {0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, above = {2, 2, 0, 3, 9, 0, 0, 0, 0, 0, 0, 0};
const std::vector<double> together = {2, 2, 1, 3, 1, 1, 1, 1, 1, 1, 1, 1};

std::string values(bool first) {
  std::string bytes;
  for (std::size_t i = 0; i < 24; ++i) {
    const std::size_t voxel = first ? i / 2 : i % 12, layer = first ? i % 2 : i / 12;
    bytes += char((layer == 0 ? below : above)[voxel]);
  }
  return bytes;
}

TEST_F(Layers, LaterSegmentsCount) {
  for (const bool first : {true, false}) {
    const Volume volume = read("a.seg.nrrd", head + std::string(first ? layers_first : layers_last) + body + tumour +
                                                 vessel + "\n" + values(first));
    EXPECT_EQ(values_of(volume), together);
    EXPECT_EQ(volume.label_names, (LabelNames{{1, "body"}, {2, "tumour"}, {3, "vessel"}}));
    ASSERT_EQ(volume.warnings.size(), 1u);
    EXPECT_TRUE(contains(volume.warnings[0], "overlap in 2 voxels")) << volume.warnings[0];
    EXPECT_EQ(volume.dims.x, 3);
    EXPECT_STREQ(value_type_name(volume.values), "uint16");
  }
}

TEST_F(Layers, TheOrderOfSegmentsDecides) {
  const std::string last_is_body = segment(0, "tumour", 2, 1) + segment(1, "vessel", 3, 1) + segment(2, "body", 1, 0);
  const Volume volume = read("a.seg.nrrd", head + std::string(layers_first) + last_is_body + "\n" + values(true));
  EXPECT_EQ(values_of(volume), (std::vector<double>{2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
}

TEST_F(Layers, EqualLabelsAreNumbered) {
  const std::string equal = segment(0, "body", 1, 0) + segment(1, "tumour", 2, 1) + segment(2, "vessel", 1, 1);
  std::string data = values(true);
  std::replace(data.begin(), data.end(), char(3), char(1));
  const Volume volume = read("a.seg.nrrd", head + std::string(layers_first) + equal + "\n" + data);
  EXPECT_EQ(values_of(volume), together);
  EXPECT_EQ(volume.label_names, (LabelNames{{1, "body"}, {2, "tumour"}, {3, "vessel"}}));
  EXPECT_TRUE(contains(volume.warnings[0], "numbered 1 to 3"));
}

TEST_F(Layers, OneLayerIsChosen) {
  const fs::path path = write("a.seg.nrrd", head + std::string(layers_first) + body + tumour + "\n" + values(true));
  const Volume volume = read_volume(path, {1, {}});
  EXPECT_EQ(values_of(volume), std::vector<double>(above.begin(), above.end()));
  EXPECT_EQ(volume.label_names, (LabelNames{{2, "tumour"}}));
  EXPECT_STREQ(value_type_name(volume.values), "uint8");
  EXPECT_TRUE(volume.warnings.empty());
  EXPECT_THROW(read_volume(path, {2, {}}), Error);
}

TEST_F(Layers, WithoutSegmentsALayerHasToBeChosen) {
  const std::string plain = head + std::string(layers_first) + "\n" + values(true);
  EXPECT_TRUE(contains(failure("a.nrrd", plain), "choose one with --layer"));
  EXPECT_EQ(values_of(read_volume(write("a.nrrd", plain), {0, {}})), std::vector<double>(below.begin(), below.end()));
  const std::string flat =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\nspacings: 1 1 1\n\n" + values(true).substr(12);
  EXPECT_EQ(values_of(read_volume(write("b.nrrd", flat), {0, {}})).size(), 12u);
  EXPECT_THROW(read_volume(write("b.nrrd", flat), {1, {}}), Error);
}

TEST_F(Layers, WhatIsDamagedIsAnError) {
  const std::string segments = body + tumour + "\n";
  EXPECT_FALSE(failure("a.seg.nrrd", head + std::string(layers_first) + segments + values(true).substr(1)).empty());
  const std::string huge =
      "sizes: 2000000000 3 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n";
  EXPECT_TRUE(contains(failure("b.seg.nrrd", head + huge + segments + values(true)), "layers"));
  const std::string large =
      "sizes: 60000 3 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n";
  EXPECT_TRUE(contains(failure("c.seg.nrrd", head + large + segments + values(true)), "cannot hold them"));
}

}  // namespace
}  // namespace nacre::test
