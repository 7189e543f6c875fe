// Nacre: tests of NRRD volumes.
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

using Nrrd = VolumeTest;

constexpr const char* sizes = "dimension: 3\nsizes: 3 2 2\n";

std::string header(const std::string& fields) { return "NRRD0004\n" + fields + "\n"; }

std::string raw(const std::string& type, const std::string& fields, const std::string& data) {
  return header("type: " + type + "\n" + sizes + "encoding: raw\n" + fields) + data;
}

template <class T>
void expect_type(const Volume& volume, const char* name) {
  EXPECT_EQ(values_of(volume), count_up(12));
  EXPECT_TRUE(std::holds_alternative<VoxelArray<T>>(volume.values));
  EXPECT_STREQ(value_type_name(volume.values), name);
}

TEST_F(Nrrd, EveryNumericType) {
  const std::string end = "endian: little\nspacings: 1 1 1\n";
  expect_type<std::uint8_t>(read("a.nrrd", raw("uchar", end, counting<std::uint8_t>(12))), "uint8");
  expect_type<std::int8_t>(read("a.nrrd", raw("signed char", end, counting<std::int8_t>(12))), "int8");
  expect_type<std::uint16_t>(read("a.nrrd", raw("ushort", end, counting<std::uint16_t>(12))), "uint16");
  expect_type<std::int16_t>(read("a.nrrd", raw("short", end, counting<std::int16_t>(12))), "int16");
  expect_type<std::uint32_t>(read("a.nrrd", raw("unsigned int", end, counting<std::uint32_t>(12))), "uint32");
  expect_type<std::int32_t>(read("a.nrrd", raw("int", end, counting<std::int32_t>(12))), "int32");
  expect_type<std::uint64_t>(read("a.nrrd", raw("uint64", end, counting<std::uint64_t>(12))), "uint64");
  expect_type<std::int64_t>(read("a.nrrd", raw("longlong", end, counting<std::int64_t>(12))), "int64");
  expect_type<float>(read("a.nrrd", raw("float", end, counting<float>(12))), "float");
  expect_type<double>(read("a.nrrd", raw("double", end, counting<double>(12))), "double");
}

TEST_F(Nrrd, LabelsHaveTheNamesOfSegments) {
  const std::string segments =
      "spacings: 1 1 1\nSegment0_LabelValue:=2\nSegment0_Name:=left lung\nSegment1_Name:=liver\n"
      "Segment0_Color:=0.5 0.25 1\nSegment1_Color:=red\nSegment1_LabelValue:=7\nSegment2_Name:=no "
      "value\nSegment3_LabelValue:=nine\nSegment3_Name:=no number\n"
      "Segment5_LabelValue:=5\nSegment5_Name:=after a gap\n";
  const Volume volume = read("a.seg.nrrd", raw("uchar", segments, counting<std::uint8_t>(12)));
  EXPECT_EQ(volume.label_names, (LabelNames{{2, "left lung"}, {7, "liver"}}));
  EXPECT_EQ(volume.label_colours, (LabelColours{{2, {0.5f, 0.25f, 1}}}));
  EXPECT_TRUE(read("b.nrrd", raw("uchar", "spacings: 1 1 1\n", counting<std::uint8_t>(12))).label_names.empty());
}

TEST_F(Nrrd, LongNamesAreCutBetweenLetters) {
  const std::string wide(119, 'w');
  const std::string segments = "spacings: 1 1 1\nSegment0_LabelValue:=2\nSegment0_Name:=" + wide +
                               "\u00e9\nSegment1_LabelValue:=3\n" + "Segment1_Name:=caf\xe9\n";
  const Volume volume = read("a.seg.nrrd", raw("uchar", segments, counting<std::uint8_t>(12)));
  EXPECT_EQ(volume.label_names, (LabelNames{{2, wide}, {3, "caf\ufffd"}}));
}

TEST_F(Nrrd, BigEndian) {
  expect_type<std::int16_t>(
      read("a.nrrd", raw("short", "endian: big\nspacings: 1 1 1\n", counting<std::int16_t>(12, true))), "int16");
}

TEST_F(Nrrd, Encodings) {
  const std::string fields = std::string("type: uchar\n") + sizes + "spacings: 1 1 1\n";
  expect_type<std::uint8_t>(read("a.nrrd", header(fields + "encoding: ascii\n") + "0 1 2 3 4 5\n6 7 8 9 10 11\n"),
                            "uint8");
  expect_type<std::uint8_t>(read("a.nrrd", header(fields + "encoding: hex\n") + "000102030405060708090a0b\n"), "uint8");
  expect_type<std::uint8_t>(read("a.nrrd", header(fields + "encoding: gzip\n") + gzipped(counting<std::uint8_t>(12))),
                            "uint8");
}

TEST_F(Nrrd, DetachedHeaders) {
  const std::string fields = std::string("type: uchar\n") + sizes + "spacings: 1 1 1\nencoding: raw\n";
  write("a.raw", counting<std::uint8_t>(12));
  expect_type<std::uint8_t>(read("a.nhdr", header(fields + "data file: a.raw\n")), "uint8");
  write("slice1.raw", counting<std::uint8_t>(12).substr(0, 6));
  write("slice2.raw", counting<std::uint8_t>(12).substr(6));
  expect_type<std::uint8_t>(read("b.nhdr", header(fields + "data file: slice%d.raw 1 2 1\n")), "uint8");
  expect_type<std::uint8_t>(read("c.nhdr", "NRRD0004\n" + fields + "data file: LIST\nslice1.raw\nslice2.raw\n"),
                            "uint8");
}

TEST_F(Nrrd, SpacingsAndTheirAbsence) {
  const std::string data = counting<std::uint8_t>(12);
  expect_near(read("a.nrrd", raw("uchar", "spacings: 0.5 2 3\n", data)).spacing, {0.5, 2, 3});
  const Volume flipped = read("a.nrrd", raw("uchar", "spacings: 1 -2 3\n", data));
  expect_near(flipped.spacing, {1, 2, 3});
  expect_near(flipped.axes[1], {0, -1, 0});
  EXPECT_FALSE(flipped.right_handed());
  const Volume absent = read("a.nrrd", raw("uchar", "", data));
  expect_near(absent.spacing, {1, 1, 1});
  ASSERT_EQ(absent.warnings.size(), 3u);
  EXPECT_TRUE(contains(absent.warnings[1], "no spacing for axis 1"));
  const Volume ranges =
      read("a.nrrd", raw("uchar", "axis mins: 10 0 0\naxis maxs: 14 1 1\ncenters: node node node\n", data));
  expect_near(ranges.spacing, {2, 1, 1});
  expect_near(ranges.origin, {10, 0, 0});
}

TEST_F(Nrrd, OrientationIsKept) {
  const Volume volume =
      read("a.nrrd", raw("uchar",
                         "space: left-posterior-superior\nspace directions: (0,2,0) (-3,0,0) (0,0,4)\n"
                         "space origin: (10,20,30)\n",
                         counting<std::uint8_t>(12)));
  EXPECT_EQ(volume.space, "left-posterior-superior");
  expect_near(volume.spacing, {2, 3, 4});
  expect_near(volume.origin, {10, 20, 30});
  expect_near(volume.axes[0], {0, 1, 0});
  expect_near(volume.axes[1], {-1, 0, 0});
  EXPECT_TRUE(volume.right_handed());
}

TEST_F(Nrrd, ShearIsAnErrorUnlessItIsRounding) {
  const std::string data = counting<std::uint8_t>(12);
  const auto with = [&](const std::string& direction) {
    return raw("uchar", "space dimension: 3\nspace directions: (1,0,0) " + direction + " (0,0,1)\n", data);
  };
  const std::string why = failure("a.nrrd", with("(1,1,0)"));
  EXPECT_TRUE(contains(why, "axes 0 and 1 are at 45.00 degrees")) << why;
  const Volume volume = read("a.nrrd", with("(0.0005,1,0)"));
  EXPECT_NEAR(dot(volume.axes[0], volume.axes[1]), 0, 1e-12);
  EXPECT_NEAR(length(volume.axes[1]), 1, 1e-12);
  EXPECT_TRUE(contains(failure("a.nrrd", with("(0,0,0)")), "spacing along its axis 1 is zero"));
}

TEST_F(Nrrd, ForeignAxes) {
  const std::string twelve = counting<std::uint8_t>(12);
  const auto with = [](const std::string& fields) { return header("type: uchar\nencoding: raw\n" + fields); };
  const Volume one_step = read("a.nrrd", with("dimension: 4\nsizes: 3 2 2 1\nspacings: 1 1 1 1\n") + twelve);
  EXPECT_EQ(values_of(one_step), count_up(12));
  const Volume component = read("a.nrrd", with("dimension: 4\nsizes: 1 3 2 2\nkinds: vector space space space\n"
                                               "space dimension: 3\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n") +
                                              twelve);
  EXPECT_EQ(component.dims, Int3(3, 2, 2));
  const std::string colours =
      failure("a.nrrd",
              with("dimension: 4\nsizes: 3 2 2 2\nkinds: RGB-color space space space\n") + counting<std::uint8_t>(24));
  EXPECT_TRUE(contains(colours, "axis 0 (RGB-color, 3 entries)")) << colours;
  const std::string steps = failure("a.nrrd", with("dimension: 4\nsizes: 2 2 2 5\n") + counting<std::uint8_t>(40));
  EXPECT_TRUE(contains(steps, "4 dimensions") && contains(steps, "axis 3 (5 entries)")) << steps;
  EXPECT_TRUE(contains(failure("a.nrrd", with("dimension: 2\nsizes: 4 3\n") + twelve), "2 of the 3 spatial axes"));
  EXPECT_TRUE(contains(failure("a.nrrd", with("dimension: 3\nsizes: 4 3 1\n") + twelve), "flat image of 4 x 3 x 1"));
}

TEST_F(Nrrd, WhatIsDamagedIsAnError) {
  const std::string data = counting<std::uint8_t>(12);
  EXPECT_TRUE(contains(failure("a.nrrd", raw("uchar", "", data.substr(1))), "cannot hold them"));
  EXPECT_TRUE(contains(failure("a.nrrd", "no nrrd at all"), "does not begin with NRRD"));
  EXPECT_TRUE(contains(failure("a.nrrd", raw("block", "block size: 1\n", data)), "blocks of bytes"));
  EXPECT_NE(failure("a.nrrd", raw("uchar", "spacings: 1 0 1\n", data)), "");
  const auto sized = [](const std::string& numbers, const std::string& encoding = "raw") {
    return header("type: double\ndimension: 3\nsizes: " + numbers + "\nendian: little\nencoding: " + encoding + "\n") +
           "x";
  };
  EXPECT_TRUE(contains(failure("a.nrrd", sized("1000000 1000000 1000000")), "do not fit in memory"));
  EXPECT_NE(failure("a.nrrd", sized("4294967296 4294967296 4294967296")), "");
  EXPECT_NE(failure("a.nrrd", sized("99999999999999999999 2 2")), "");
  EXPECT_NE(failure("a.nrrd", sized("-2 2 2")), "");
  EXPECT_NE(failure("a.nrrd", sized("0 2 2")), "");
  EXPECT_TRUE(contains(failure("a.nrrd", sized("500 500 500", "gzip")), "cannot hold them"));
  EXPECT_NE(failure("a.nrrd", sized("50 50 50", "gzip")), "");
}

TEST_F(Nrrd, DataFilesThatAreNone) {
  const std::string fields = std::string("type: uchar\n") + sizes + "encoding: raw\n";
  EXPECT_TRUE(contains(failure("a.nhdr", header(fields + "data file: missing.raw\n")), "missing.raw is missing"));
  EXPECT_TRUE(contains(failure("a.nhdr", header(fields + "data file: /dev/zero\n")), "is missing"));
  EXPECT_TRUE(contains(failure("a.nhdr", header(fields + "datafile: -\n")), "is missing"));
  EXPECT_TRUE(contains(failure("a.nhdr", header(fields + "Data File: %s%d.raw 1 2 1\n")), "is not valid"));
  EXPECT_TRUE(contains(failure("a.nhdr", header(fields + "data file: %d.raw 1 2000000000 1\n")), "is not valid"));
  EXPECT_TRUE(contains(failure("a.nhdr", header(fields + "data file: %d.raw 1 2 0\n")), "is not valid"));
  EXPECT_TRUE(contains(failure("a.nhdr", "NRRD0004\n" + fields + "data file: LIST\n/dev/zero\n"), "is missing"));
}

TEST_F(Nrrd, EveryTruncationAndFlippedByteEndsWell) {
  const std::string whole = raw("short",
                                "endian: little\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nkinds: domain "
                                "domain domain\nspace origin: (0,0,0)\nkey:=value\n# comment\n",
                                counting<std::int16_t>(12));
  std::size_t read = 0;
  const auto attempt = [&](const std::string& content) {
    const std::string why = failure("a.nrrd", content);
    EXPECT_EQ(why.find('\n'), why.npos);
    read += why.empty();
  };
  for (std::size_t length = 0; length < whole.size(); ++length) attempt(whole.substr(0, length));
  EXPECT_EQ(read, 0u);  // no part of it is a volume
  for (std::size_t at = 0; at + 24 < whole.size(); ++at)
    for (const char c : {'\0', '9', '-', '(', '\n', '%', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = c;
      attempt(damaged);
    }
  EXPECT_GT(read, 0u);  // some damage does not matter
}

}  // namespace
}  // namespace nacre::test
