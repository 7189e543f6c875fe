// Nacre: tests of FreeSurfer's volumes, and of the files that name labels.
#include "engine/io/label_names.hpp"
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

using Mgh = VolumeTest;
using LabelFile = VolumeTest;

/// Fields of a header, in the order of the file, and what follows the values.
struct MghFile {
  std::int32_t version = 1, frames = 1, type = 0;
  std::array<std::int32_t, 3> dims{3, 2, 2};
  std::int16_t oriented = 1;
  std::array<float, 15> geometry{0.5f, 2, 3, -1, 0, 0, 0, 0, -1, 0, 1, 0, 10, 20, 30};  ///< spacing, axes, centre
  std::string tail;

  std::string with(const std::string& data) const {
    std::string bytes = bytes_of(version, true);
    for (const std::int32_t dim : dims) bytes += bytes_of(dim, true);
    bytes += bytes_of(frames, true) + bytes_of(type, true) + bytes_of(std::int32_t(0), true) + bytes_of(oriented, true);
    for (const float number : geometry) bytes += bytes_of(number, true);
    bytes.resize(284, '\0');
    return bytes + data + tail;
  }
};

const std::string mgh_values = counting<std::uint8_t>(12);

std::string counted(const std::string& text) { return bytes_of(std::int32_t(text.size() + 1), true) + text + '\0'; }

std::string colours() {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += bytes_of(std::int32_t(i), true);
  return bytes;
}

/// A colour table of the second version, with two names.
std::string colour_table(std::int32_t entries = 2) {
  return bytes_of(std::int32_t(-2), true) + bytes_of(std::int32_t(54), true) + counted("LUT.txt") +
         bytes_of(entries, true) + bytes_of(std::int32_t(17), true) + counted("Left-Hippocampus") + colours() +
         bytes_of(std::int32_t(53), true) + counted("Right-Hippocampus") + colours();
}

std::string tag(std::int32_t number, const std::string& content) {
  return bytes_of(number, true) + bytes_of(std::int64_t(content.size()), true) + content;
}

const std::string scanner(20, '\0');

TEST_F(Mgh, PlainAndPacked) {
  const std::string file = MghFile().with(mgh_values);
  for (const Volume& volume : {read("a.mgh", file), read("a.mgz", gzipped(file)), read("b.mgz", file)}) {
    EXPECT_EQ(values_of(volume), count_up(12));
    EXPECT_STREQ(value_type_name(volume.values), "uint8");
    expect_near(volume.spacing, {0.5, 2, 3});
    expect_near(volume.axes[1], {0, 0, -1});
    expect_near(volume.axes[2], {0, 1, 0});
    // The centre minus half of each extent along its axis: 1.5 * 0.5, 1 * 2, 1 * 3.
    expect_near(volume.origin, {10 + 0.75, 20 - 3, 30 + 2});
    EXPECT_EQ(volume.space, "right-anterior-superior");
    EXPECT_EQ(volume.warnings.empty(), volume.name != "b.mgz") << "b.mgz is not packed, although its name says so";
    EXPECT_TRUE(volume.label_names.empty());
  }
}

TEST_F(Mgh, EveryType) {
  MghFile file;
  const auto check = [&](int type, const std::string& data, const char* name) {
    file.type = type;
    const Volume volume = read("a.mgh", file.with(data));
    EXPECT_EQ(values_of(volume), count_up(12)) << name;
    EXPECT_STREQ(value_type_name(volume.values), name);
  };
  check(1, counting<std::int32_t>(12, true), "int32");
  check(3, counting<float>(12, true), "float");
  check(4, counting<std::int16_t>(12, true), "int16");
  check(10, counting<std::uint16_t>(12, true), "uint16");
}

TEST_F(Mgh, WithoutAxesTheSlicesAreCoronal) {
  MghFile file;
  file.oriented = 0;
  const Volume volume = read("a.mgh", file.with(mgh_values));
  expect_near(volume.axes[0], {-1, 0, 0});
  expect_near(volume.axes[1], {0, 0, -1});
  expect_near(volume.spacing, {1, 1, 1});
  ASSERT_EQ(volume.warnings.size(), 1u);
}

TEST_F(Mgh, LabelsHaveTheNamesOfItsColourTable) {
  const LabelNames expected = {{17, "Left-Hippocampus"}, {53, "Right-Hippocampus"}};
  MghFile file;
  file.tail = scanner + tag(3, "mri_convert a b") + bytes_of(std::int32_t(1), true) + colour_table();
  EXPECT_EQ(read("a.mgz", gzipped(file.with(mgh_values))).label_names, expected);
  file.tail =
      scanner + bytes_of(std::int32_t(30), true) + bytes_of(std::int32_t(5), true) + "a.xfm" + tag(5, colour_table());
  EXPECT_EQ(read("a.mgh", file.with(mgh_values)).label_names, expected);
  // The first version: names in the order of the labels.
  file.tail = scanner + bytes_of(std::int32_t(1), true) + bytes_of(std::int32_t(2), true) + counted("LUT.txt") +
              counted("Unknown") + colours() + counted("Cortex") + colours();
  EXPECT_EQ(read("a.mgh", file.with(mgh_values)).label_names, (LabelNames{{0, "Unknown"}, {1, "Cortex"}}));
}

TEST_F(Mgh, DamagedTablesAreNoNames) {
  MghFile file;
  const std::string old_table = bytes_of(std::int32_t(1), true);
  for (const std::string& tail :
       {scanner.substr(0, 7), scanner, scanner + "abc", scanner + old_table + colour_table().substr(0, 60),
        scanner + old_table + colour_table(2000000000), scanner + old_table + colour_table(-1).substr(0, 8),
        scanner + old_table + bytes_of(std::int32_t(-7), true),
        scanner + old_table + bytes_of(std::int32_t(1), true) + bytes_of(std::int32_t(0x7fffffff), true),
        scanner + bytes_of(std::int32_t(3), true) + bytes_of(std::int64_t(-5), true) + "abcdef",
        scanner + bytes_of(std::int32_t(3), true) + bytes_of(std::int64_t(1) << 60, true)}) {
    file.tail = tail;
    EXPECT_TRUE(read("a.mgh", file.with(mgh_values)).label_names.empty());
  }
}

TEST_F(Mgh, WhatIsDamagedIsAnError) {
  const auto with = [&](auto change) {
    MghFile file;
    change(file);
    return failure("a.mgh", file.with(mgh_values));
  };
  EXPECT_TRUE(contains(with([](MghFile& f) { f.version = 7; }), "version"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.frames = 4; }), "4 frames"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.type = 2; }), "type 2"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.dims[0] = -3; }), "-3 x 2 x 2"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.dims = {1000, 1000, 900}; }), "cannot hold them"));
  EXPECT_TRUE(contains(with([](MghFile& f) {
                         f.dims = {2000000000, 2000000000, 2000000000};
                       }),
                       "do not fit in memory"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.geometry[0] = 0; }), "is zero"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.geometry[12] = std::numeric_limits<float>::infinity(); }), "origin"));
  EXPECT_TRUE(contains(with([](MghFile& f) { f.geometry[6] = -1; }), "sheared"));
  EXPECT_TRUE(contains(failure("b.mgh", MghFile().with(mgh_values).substr(0, 100)), "100 of 284"));
  EXPECT_TRUE(contains(failure("c.mgz", gzipped(MghFile().with(mgh_values.substr(0, 11)))), "ends before"));
  const std::string packed = gzipped(MghFile().with(mgh_values));
  EXPECT_FALSE(failure("d.mgz", packed.substr(0, packed.size() / 2)).empty());
}

TEST_F(LabelFile, OfItkSnapFreeSurferAndSlicer) {
  const LabelNames expected = {{0, "Clear Label"}, {2, "left lung"}, {17, "Left-Hippocampus"}};
  const std::string snap =
      "################\n# ITK-SnAP Label Description File\n################\n"
      "    0     0    0    0        0  0  0    \"Clear Label\"\n    2   255    0    0        1  1  1    \"left "
      "lung\"\r\n"
      "   17   0 0 255  1 1 1 \"Left-Hippocampus\"\n";
  EXPECT_EQ(read_label_names(write("a.label", snap)), expected);
  const std::string colours = "#No. Label Name:  R G B A\n\n0 Unknown 0 0 0 0\n17  Left-Hippocampus   220 216 20 0\n";
  EXPECT_EQ(read_label_names(write("LUT.txt", colours)), (LabelNames{{0, "Unknown"}, {17, "Left-Hippocampus"}}));
  EXPECT_EQ(read_label_names(write("a.txt", "2 left lung\n17 area 51\n-3 neck")),
            (LabelNames{{-3, "neck"}, {2, "left lung"}, {17, "area 51"}}));
}

TEST_F(LabelFile, HasTheColours) {
  const std::string snap = "0 0 0 0 0 0 0 \"Clear\"\n2 255 0 51 1 1 1 \"lung 2\"\n";
  const LabelTable of_snap = read_label_table(write("a.label", snap));
  EXPECT_EQ(of_snap.colours, (LabelColours{{0, {0, 0, 0}}, {2, {1, 0, 0.2f}}}));
  const LabelTable of_freesurfer =
      read_label_table(write("LUT.txt", "17 Left-Hippocampus 255 51 0 0\n4 area 9 0 0 255\n"));
  EXPECT_EQ(of_freesurfer.colours.at(17), (std::array{1.0f, 0.2f, 0.0f}));
  const LabelTable of_three_numbers = read_label_table(write("a.txt", "1 liver 0 255 51\n2 upper left lung 51 0 0\n"));
  EXPECT_EQ(of_three_numbers.colours, (LabelColours{{1, {0, 1, 0.2f}}, {2, {0.2f, 0, 0}}}));
  EXPECT_TRUE(read_label_table(write("a.txt", "2 left lung\n")).colours.empty());
  EXPECT_TRUE(read_label_table(write("a.txt", "2 lung 300 0 0\n")).colours.empty());  // no byte
}

TEST_F(LabelFile, WhatIsNoTableIsAnError) {
  const auto failed = [&](const std::string& text) {
    try {
      read_label_names(write("a.txt", text));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(contains(failed("# nothing\n"), "names no labels"));
  EXPECT_TRUE(contains(failed("1 liver\n\nspleen 2\n"), "line 3"));
  EXPECT_TRUE(contains(failed("1 liver\n7\n"), "line 2"));
  EXPECT_TRUE(contains(failed(std::string("\x89PNG\x1a\n\0\0", 8)), "line 1"));
}

TEST_F(LabelFile, NamesGoBeforeThoseOfTheVolume) {
  MghFile file;
  file.tail = scanner + bytes_of(std::int32_t(1), true) + colour_table();
  VolumeChoice choice;
  choice.names = write("names.txt", "17 hippocampus\n3 cortex\n");
  const Volume volume = read_volume(write("a.mgh", file.with(mgh_values)), choice);
  EXPECT_EQ(volume.label_names, (LabelNames{{3, "cortex"}, {17, "hippocampus"}, {53, "Right-Hippocampus"}}));
}

}  // namespace
}  // namespace nacre::test
