// Nacre: tests of MetaImage volumes.
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

using MetaImage = VolumeTest;

const std::string voxel_bytes = counting<std::uint8_t>(12);

std::string meta(const std::string& fields, const std::string& data, const std::string& type = "UCHAR",
                 const std::string& file = "LOCAL") {
  return "ObjectType = Image\nNDims = 3\n" + fields + "ElementType = MET_" + type + "\nElementDataFile = " + file +
         "\n" + data;
}

std::string plain(const std::string& more = "") { return "DimSize = 3 2 2\nElementSpacing = 1 2 3\n" + more; }

/// What zlib makes of voxel_bytes, without gzip's frame.
std::string deflated(const std::string& content) {
  std::string out(compressBound(uLong(content.size())), '\0');
  uLongf size = uLongf(out.size());
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(content.data()),
           uLong(content.size()));
  return out.substr(0, size);
}

TEST_F(MetaImage, OrientationIsKept) {
  const Volume volume =
      read("a.mha", meta(plain("TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\n"), voxel_bytes));
  EXPECT_EQ(values_of(volume), count_up(12));
  EXPECT_EQ(volume.name, "a.mha");
  expect_near(volume.spacing, {1, 2, 3});
  expect_near(volume.origin, {10, 20, 30});
  expect_near(volume.axes[0], {0, 1, 0});
  expect_near(volume.axes[1], {-1, 0, 0});
  EXPECT_TRUE(volume.warnings.empty());
  EXPECT_EQ(read("b.mha", meta("DimSize = 3 2 2\n", voxel_bytes)).warnings.size(), 1u);
}

TEST_F(MetaImage, TypesAndOrders) {
  const auto check = [&](const std::string& type, const std::string& data, const char* name,
                         const std::string& more = "") {
    const Volume volume = read("a.mha", meta(plain(more), data, type));
    EXPECT_EQ(values_of(volume), count_up(12)) << type;
    EXPECT_STREQ(value_type_name(volume.values), name);
  };
  check("CHAR", counting<std::int8_t>(12), "int8");
  check("SHORT", counting<std::int16_t>(12), "int16");
  check("USHORT", counting<std::uint16_t>(12, true), "uint16", "BinaryDataByteOrderMSB = True\n");
  check("INT", counting<std::int32_t>(12), "int32");
  check("ULONG", counting<std::uint32_t>(12), "uint32");
  check("LONG_LONG", counting<std::int64_t>(12), "int64");
  check("FLOAT", counting<float>(12, true), "float", "ElementByteOrderMSB = True\n");
  check("DOUBLE", counting<double>(12), "double");
  check("SHORT", "0 1 2 3 4 5 6 7 8 9 10 11\n", "int16", "BinaryData = False\n");
}

TEST_F(MetaImage, PackedAndInItsOwnFile) {
  EXPECT_EQ(values_of(read("a.mha", meta(plain("CompressedData = True\n"), deflated(voxel_bytes)))), count_up(12));
  write("a.raw", voxel_bytes);
  write("b.raw", "head" + voxel_bytes);
  write("a.zraw", deflated(voxel_bytes));
  EXPECT_EQ(values_of(read("a.mhd", meta(plain(), "", "UCHAR", "a.raw"))), count_up(12));
  EXPECT_EQ(values_of(read("b.mhd", meta(plain("HeaderSize = 4\n"), "", "UCHAR", "b.raw"))), count_up(12));
  EXPECT_EQ(values_of(read("c.mhd", meta(plain("HeaderSize = -1\n"), "", "UCHAR", "b.raw"))), count_up(12));
  EXPECT_EQ(values_of(read("d.mhd", meta(plain("CompressedData = True\n"), "", "UCHAR", "a.zraw"))), count_up(12));
  const std::string packed = deflated(voxel_bytes), last = "CompressedData = True\nHeaderSize = -1\n";
  write("b.zraw", "head" + packed);
  const std::string size = "CompressedDataSize = " + std::to_string(packed.size()) + "\n";
  EXPECT_EQ(values_of(read("e.mhd", meta(plain(last + size), "", "UCHAR", "b.zraw"))), count_up(12));
  EXPECT_TRUE(contains(failure("f.mhd", meta(plain(last), "", "UCHAR", "b.zraw")), "no CompressedDataSize"));
}

TEST_F(MetaImage, FourthDimensionOfOneStep) {
  std::string content = meta(
      "DimSize = 3 2 2 1\nElementSpacing = 1 2 3 9\nOffset = 1 2 3 4\n"
      "TransformMatrix = 0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1\n",
      voxel_bytes);
  const std::string four = content.replace(content.find("NDims = 3"), 9, "NDims = 4");
  const Volume volume = read("a.mha", four);
  expect_near(volume.spacing, {1, 2, 3});
  expect_near(volume.axes[0], {0, 1, 0});
  EXPECT_TRUE(contains(failure("a.mha", std::string(four).replace(four.find("3 2 2 1"), 7, "3 2 1 2")), "dimension 4"));
}

TEST_F(MetaImage, WhatIsDamagedIsAnError) {
  const auto with = [&](const std::string& fields, const std::string& data = voxel_bytes) {
    return failure("a.mha", meta(fields, data));
  };
  EXPECT_TRUE(contains(with(plain(), voxel_bytes.substr(1)), "cannot hold them"));
  EXPECT_TRUE(
      contains(with(plain("CompressedData = True\n"), deflated(voxel_bytes).substr(0, 15)), "too early or late"));
  std::string damaged = deflated(voxel_bytes);
  damaged[damaged.size() - 1] ^= 1;
  EXPECT_TRUE(contains(with(plain("CompressedData = True\n"), damaged), "damaged"));
  EXPECT_TRUE(contains(with(plain("CompressedData = True\n"), deflated(voxel_bytes + "x")), "too early or late"));
  EXPECT_TRUE(contains(with("DimSize = 3 2 2\nElementSpacing = 1 0 1\n"), "axis 1 is zero"));
  EXPECT_TRUE(contains(with("DimSize = 3 2 2\nElementSpacing = 1 nan 1\n"), "not a number"));
  EXPECT_TRUE(contains(with("DimSize = 3 2 2\nElementSpacing = 1 1\n"), "ElementSpacing = 1 1"));
  EXPECT_TRUE(contains(with("DimSize = 100000 100000 100000\n"), "do not fit"));
  EXPECT_TRUE(contains(with("DimSize = 3 -2 2\n"), "3 x -2 x 2"));
  EXPECT_TRUE(contains(with("DimSize = 3 4 1\n"), "flat image"));
  EXPECT_TRUE(contains(with(plain("ElementNumberOfChannels = 3\n")), "3 values per voxel"));
  EXPECT_TRUE(contains(with(plain("TransformMatrix = 1 1 0 0 1 0 0 0 1\n")), "sheared"));
  EXPECT_TRUE(contains(failure("a.mha", meta(plain(), voxel_bytes, "UCHAR_ARRAY")), "of type 'MET_UCHAR_ARRAY'"));
  EXPECT_TRUE(contains(failure("a.mha", meta(plain("BinaryData = False\n"), "1 2 3")), "fewer numbers than voxels"));
  EXPECT_TRUE(contains(failure("a.mha", "nothing of the kind"), "no MetaImage header"));
  for (const char* file : {"no.raw", "/dev/zero"})
    EXPECT_TRUE(contains(failure("a.mhd", meta(plain(), "", "UCHAR", file)), "is missing"));
  EXPECT_TRUE(contains(failure("a.mhd", meta(plain(), "", "UCHAR", "LIST")), "several files"));
}

TEST_F(MetaImage, EveryTruncationAndFlippedByteEndsWell) {
  const std::string whole = meta(plain("TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\n"), voxel_bytes);
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(failure("a.mha", whole.substr(0, length)), "");
  std::size_t good = 0;
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char c : {'\0', '9', '-', '=', '\n', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = c;
      good += failure("a.mha", damaged).empty();
    }
  EXPECT_GT(good, 0u);
}

}  // namespace
}  // namespace nacre::test
