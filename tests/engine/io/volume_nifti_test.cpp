// Nacre: tests of NIfTI volumes.
#include <cmath>
#include <limits>

#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

using Nifti = VolumeTest;

/// A NIfTI-1 or -2 header with its fields at their offsets; 3 x 2 x 2 voxels of int16.
class Header {
 public:
  explicit Header(int version = 1, bool big = false)
      : version_(version), big_(big), bytes_(version == 1 ? 352 : 544, '\0') {
    put<std::int32_t>(0, version == 1 ? 348 : 540);
    const std::string magic = version == 1 ? std::string("n+1\0", 4) : std::string("n+2\0\r\n\032\n", 8);
    bytes_.replace(version == 1 ? 344 : 4, magic.size(), magic);
    dims({3, 3, 2, 2, 1, 1, 1, 1});
    type(4, 16);
    pixdim({1, 1, 1, 1});
    if (version == 1)
      put<float>(108, 352);
    else
      put<std::int64_t>(168, 544);
  }

  Header& dims(const std::vector<std::int64_t>& dims) {
    for (std::size_t i = 0; i < dims.size(); ++i)
      version_ == 1 ? put<std::int16_t>(40 + 2 * i, std::int16_t(dims[i])) : put<std::int64_t>(16 + 8 * i, dims[i]);
    return *this;
  }
  Header& type(int code, int bits) {
    put<std::int16_t>(version_ == 1 ? 70 : 12, std::int16_t(code));
    put<std::int16_t>(version_ == 1 ? 72 : 14, std::int16_t(bits));
    return *this;
  }
  Header& pixdim(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      version_ == 1 ? put<float>(76 + 4 * i, float(values[i])) : put<double>(104 + 8 * i, values[i]);
    return *this;
  }
  Header& scale(double slope, double intercept) {
    version_ == 1 ? put<float>(112, float(slope)) : put<double>(176, slope);
    version_ == 1 ? put<float>(116, float(intercept)) : put<double>(184, intercept);
    return *this;
  }
  Header& sform(const std::vector<double>& rows) {
    version_ == 1 ? put<std::int16_t>(254, 1) : put<std::int32_t>(348, 1);
    for (std::size_t i = 0; i < 12; ++i)
      version_ == 1 ? put<float>(280 + 4 * i, float(rows[i])) : put<double>(400 + 8 * i, rows[i]);
    return *this;
  }
  /// A quarter turn about z.
  Header& qform_quarter_turn() {
    version_ == 1 ? put<std::int16_t>(252, 1) : put<std::int32_t>(344, 1);
    const double half = std::sqrt(0.5);
    version_ == 1 ? put<float>(264, float(half)) : put<double>(368, half);
    return *this;
  }

  template <class T>
  Header& put(std::size_t at, T value) {
    bytes_.replace(at, sizeof(T), bytes_of(value, big_));
    return *this;
  }
  std::string with(const std::string& data) const { return bytes_ + data; }
  const std::string& bytes() const { return bytes_; }

 private:
  int version_;
  bool big_;
  std::string bytes_;
};

const std::string shorts = counting<std::int16_t>(12);

TEST_F(Nifti, BothVersionsBothOrdersPackedOrNot) {
  for (const int version : {1, 2})
    for (const bool big : {false, true}) {
      const std::string content = Header(version, big).pixdim({1, 2, 3, 4}).with(counting<std::int16_t>(12, big));
      for (const Volume& volume : {read("a.nii", content), read("a.nii.gz", gzipped(content))}) {
        EXPECT_EQ(values_of(volume), count_up(12)) << version << big;
        EXPECT_STREQ(value_type_name(volume.values), "int16");
        EXPECT_EQ(volume.dims, Int3(3, 2, 2));
        expect_near(volume.spacing, {2, 3, 4});
        EXPECT_EQ(volume.warnings.size(), 1u);  // neither sform nor qform
      }
    }
}

TEST_F(Nifti, TwoFiles) {
  write("a.img", shorts);
  std::string header = Header().put<float>(108, 0).bytes().substr(0, 348);
  header.replace(344, 3, "ni1");
  EXPECT_EQ(values_of(read("a.hdr", header)), count_up(12));
  EXPECT_EQ(values_of(read_volume(folder_ / "a.img")), count_up(12));
  EXPECT_TRUE(contains(failure("alone.hdr", header), "file with its values is missing"));
  EXPECT_TRUE(contains(failure("lonely.img", shorts), "no .hdr file beside it"));
}

TEST_F(Nifti, Types) {
  const auto check = [&](int code, int bits, const std::string& data, const char* name) {
    const Volume volume = read("a.nii", Header().type(code, bits).with(data));
    EXPECT_EQ(values_of(volume), count_up(12)) << name;
    EXPECT_STREQ(value_type_name(volume.values), name);
  };
  check(2, 8, counting<std::uint8_t>(12), "uint8");
  check(256, 8, counting<std::int8_t>(12), "int8");
  check(512, 16, counting<std::uint16_t>(12), "uint16");
  check(8, 32, counting<std::int32_t>(12), "int32");
  check(768, 32, counting<std::uint32_t>(12), "uint32");
  check(1024, 64, counting<std::int64_t>(12), "int64");
  check(1280, 64, counting<std::uint64_t>(12), "uint64");
  check(16, 32, counting<float>(12), "float");
  check(64, 64, counting<double>(12), "double");
  EXPECT_TRUE(contains(failure("a.nii", Header().type(32, 64).with(std::string(96, '\0'))), "COMPLEX64"));
  EXPECT_TRUE(contains(failure("a.nii", Header().type(128, 24).with(std::string(36, '\0'))), "RGB24"));
  EXPECT_NE(failure("a.nii", Header().type(4711, 16).with(shorts)), "");
}

TEST_F(Nifti, SlopeAndIntercept) {
  const std::vector<double> values = values_of(read("a.nii", Header().scale(0.5, 10).with(shorts)));
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(values[i], 10 + 0.5 * double(i));
  EXPECT_STREQ(value_type_name(read("a.nii", Header().scale(1, 0).with(shorts)).values), "int16");
  EXPECT_STREQ(value_type_name(read("a.nii", Header().scale(0, 7).with(shorts)).values), "int16");
}

TEST_F(Nifti, OrientationIsKept) {
  for (const int version : {1, 2}) {
    const Volume s = read("a.nii", Header(version).sform({0, 3, 0, 10, -2, 0, 0, 20, 0, 0, 4, 30}).with(shorts));
    expect_near(s.spacing, {2, 3, 4});
    expect_near(s.origin, {10, 20, 30});
    expect_near(s.axes[0], {0, -1, 0});
    expect_near(s.axes[1], {1, 0, 0});
    EXPECT_EQ(s.space, "right-anterior-superior");
    EXPECT_TRUE(s.warnings.empty());
    const Volume q = read("a.nii", Header(version).pixdim({-1, 2, 3, 4}).qform_quarter_turn().with(shorts));
    expect_near(q.axes[0], {0, 1, 0});
    expect_near(q.axes[1], {-1, 0, 0});
    expect_near(q.axes[2], {0, 0, -1});
    EXPECT_FALSE(q.right_handed());
  }
}

TEST_F(Nifti, Shear) {
  Header header;
  header.sform({1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  EXPECT_TRUE(contains(failure("a.nii", header.with(shorts)), "axes 0 and 1 are at 45.00 degrees"));
  const Volume volume = read("a.nii", header.qform_quarter_turn().with(shorts));
  expect_near(volume.axes[0], {0, 1, 0});
  ASSERT_EQ(volume.warnings.size(), 1u);
  EXPECT_TRUE(contains(volume.warnings[0], "sform is sheared"));
}

TEST_F(Nifti, NanVoxelsAreKeptAndCounted) {
  std::string data = counting<float>(12);
  data.replace(4, 4, bytes_of(std::numeric_limits<float>::quiet_NaN()));
  data.replace(8, 4, bytes_of(std::numeric_limits<float>::infinity()));
  const VolumeStatistics statistics = volume_statistics(read("a.nii", Header().type(16, 32).with(data)));
  EXPECT_EQ(statistics.nan, 1u);
  EXPECT_EQ(statistics.infinite, 1u);
  EXPECT_EQ(statistics.max, 11);
}

TEST_F(Nifti, OtherDimensions) {
  EXPECT_EQ(values_of(read("a.nii", Header().dims({4, 3, 2, 2, 1, 1, 1, 1}).with(shorts))), count_up(12));
  const std::string steps = failure("a.nii", Header().dims({4, 3, 2, 1, 2, 1, 1, 1}).with(shorts));
  EXPECT_TRUE(contains(steps, "2 entries along its dimension 4 (time)")) << steps;
  EXPECT_TRUE(contains(failure("a.nii", Header().dims({5, 3, 2, 2, 1, 3, 1, 1}).with(shorts)), "dimension 5"));
  EXPECT_TRUE(contains(failure("a.nii", Header().dims({2, 4, 3, 1, 1, 1, 1, 1}).with(shorts)), "2 dimensions"));
}

TEST_F(Nifti, WhatIsDamagedIsAnError) {
  EXPECT_TRUE(contains(failure("a.nii", Header().with(shorts.substr(1))), "it ends before its last voxel"));
  EXPECT_TRUE(contains(failure("a.nii", "this is no nifti file, only some text"), "does not begin like"));
  EXPECT_TRUE(contains(failure("a.nii", Header().bytes().substr(0, 100)), "100 of 348 bytes"));
  EXPECT_NE(failure("a.nii", Header().dims({3, -3, 2, 2}).with(shorts)), "");
  EXPECT_NE(failure("a.nii", Header().dims({3, 0, 2, 2}).with(shorts)), "");
  EXPECT_NE(failure("a.nii", Header().dims({3, 30000, 30000, 30000}).with(shorts)), "");
  EXPECT_NE(failure("a.nii", Header(2).dims({3, 4294967296, 4294967296, 4294967296}).with(shorts)), "");
  EXPECT_NE(failure("a.nii", Header().put<float>(108, 1e20f).with(shorts)), "");
  EXPECT_NE(failure("a.nii", Header(2).put<std::int64_t>(168, std::int64_t(1) << 60).with(shorts)), "");
  EXPECT_NE(failure("a.nii", Header().pixdim({1, std::nan(""), 1, 1}).with(shorts)), "");
  const std::string zero = failure("a.nii", Header().sform({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}).with(shorts));
  EXPECT_TRUE(contains(zero, "spacing along its axis 0 is zero")) << zero;
  EXPECT_NE(failure("a.nii.gz", gzipped(Header().with(shorts)).substr(0, 40)), "");
}

/// A file with words in an extension of that kind, as the standard lays them out.
std::string extended(int code, const std::string& words, const std::string& data) {
  std::string block = words;
  block.resize((words.size() + 8 + 15) / 16 * 16 - 8, '\0');
  std::string header = Header().put<float>(108, float(352 + 8 + block.size())).bytes();
  header[348] = 1;
  return header + bytes_of(std::int32_t(block.size() + 8)) + bytes_of(std::int32_t(code)) + block + data;
}

TEST_F(Nifti, LabelsHaveTheNamesOfItsTable) {
  constexpr int caret = 30;
  const std::string table =
      "<?xml version=\"1.0\"?><CaretExtension><VolumeInformation Index=\"0\"><LabelTable>"
      "<Label Key=\"3\" Red=\"0\" Green=\"0.5\" Blue=\"1\"><![CDATA[kidney_left]]></Label><Label Key=\"-2\"> a &amp; b "
      "</Label>"
      "<Label Key=\"x\">no number</Label><Label Key=\"4\"></Label></LabelTable></VolumeInformation></CaretExtension>";
  const Volume volume = read("a.nii", extended(caret, table, shorts));
  EXPECT_EQ(values_of(volume), count_up(12));
  EXPECT_EQ(volume.label_names, (LabelNames{{-2, "a & b"}, {3, "kidney_left"}}));
  EXPECT_EQ(volume.label_colours, (LabelColours{{3, {0, 0.5f, 1}}}));
  EXPECT_EQ(read("a.nii.gz", gzipped(extended(caret, table, shorts))).label_names.size(), 2u);
  EXPECT_EQ(read("a.nii", extended(0, table, shorts)).label_names.size(), 2u);
  EXPECT_TRUE(read("a.nii", extended(6, table, shorts)).label_names.empty());  // a comment
  EXPECT_TRUE(read("a.nii", extended(caret, table.substr(0, 90), shorts)).label_names.empty());
  for (std::size_t end = 0; end < table.size(); ++end)
    EXPECT_EQ(failure("a.nii", extended(caret, table.substr(0, end), shorts)), "") << end;
}

TEST_F(Nifti, EveryFlippedByteEndsWell) {
  for (const int version : {1, 2}) {
    const std::string whole = Header(version).sform({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}).with(shorts);
    std::size_t read = 0;
    for (std::size_t at = 0; at < whole.size() - shorts.size(); ++at)
      for (const char c : {'\x7f', '\xff', '\x01'}) {
        std::string damaged = whole;
        damaged[at] = c;
        const std::string why = failure("a.nii", damaged);
        EXPECT_EQ(why.find('\n'), why.npos);
        read += why.empty();
      }
    EXPECT_GT(read, 0u);
    EXPECT_LT(read, 3 * whole.size());
  }
}

}  // namespace
}  // namespace nacre::test
