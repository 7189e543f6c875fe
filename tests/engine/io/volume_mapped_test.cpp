// Nacre: tests of large volumes that stay in their files. The files have holes, and take hardly any room.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "compute/device/error.hpp"
#include "engine/io/mapped_values.hpp"
#include "engine/io/volume_reader.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre::test {
namespace {

constexpr Int3 mapped_dims{512, 512, 257};
constexpr std::size_t mapped_voxels = std::size_t(512) * 512 * 257;
static_assert(mapped_voxels > worth_mapping);

/// A few labels far apart.
const std::vector<std::pair<std::size_t, std::uint8_t>> mapped_labels{
    {0, 9}, {511, 3}, {512 * 512, 200}, {std::size_t(1) << 26, 7}, {mapped_voxels - 1, 255}};

VolumeChoice in_place() {
  VolumeChoice choice;
  choice.mapped = true;
  return choice;
}

class MappedVolume : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& header, std::size_t offset) {
    const std::filesystem::path file = folder_ / name;
    std::ofstream out(file, std::ios::binary);
    out << header;
    for (const auto& [at, label] : mapped_labels) {
      out.seekp(std::streamoff(offset + at));
      out.put(char(label));
    }
    return file;
  }

  /// Mapped, and the same as when it is read.
  static void expect_mapped(const std::filesystem::path& file) {
    const Volume mapped = read_volume(file, in_place()), read = read_volume(file);
    EXPECT_EQ(mapped.dims, mapped_dims);
    const auto& there = std::get<VoxelArray<std::uint8_t>>(mapped.values);
    const auto& here = std::get<VoxelArray<std::uint8_t>>(read.values);
    EXPECT_NE(dynamic_cast<const MappedFile*>(there.held().get()), nullptr);
    EXPECT_EQ(dynamic_cast<const MappedFile*>(here.held().get()), nullptr);
    ASSERT_EQ(there.size(), mapped_voxels);
    ASSERT_EQ(here.size(), mapped_voxels);
    for (const auto& [at, label] : mapped_labels) EXPECT_EQ(there[at], label) << at;
    EXPECT_EQ(std::memcmp(there.data(), here.data(), mapped_voxels), 0);
    EXPECT_EQ(mapped.warnings, read.warnings);
  }

  TemporaryFolder folder_;
};

TEST_F(MappedVolume, Nrrd) {
  const std::string header =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 512 512 257\nspacings: 1 1 1\nencoding: raw\n";
  expect_mapped(write("a.nrrd", header + "\n", header.size() + 1));
  write("b.raw", "", 0);
  std::ofstream(folder_ / "b.nhdr") << header << "data file: b.raw\n";
  expect_mapped(folder_ / "b.nhdr");
}

TEST_F(MappedVolume, MetaImage) {
  const std::string header = "NDims = 3\nDimSize = 512 512 257\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\n";
  const std::string local = header + "ElementDataFile = LOCAL\n";
  expect_mapped(write("a.mha", local, local.size()));
  write("b.raw", "", 0);
  std::ofstream(folder_ / "b.mhd") << header << "ElementDataFile = b.raw\n";
  expect_mapped(folder_ / "b.mhd");
}

TEST_F(MappedVolume, Nifti) {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, const auto value) { std::memcpy(header.data() + at, &value, sizeof(value)); };
  put(0, std::int32_t(348));
  const std::int16_t dims[] = {3, 512, 512, 257, 1, 1, 1, 1};
  std::memcpy(header.data() + 40, dims, sizeof(dims));
  put(70, std::int16_t(2));  // bytes
  put(72, std::int16_t(8));
  for (std::size_t k = 0; k < 4; ++k) put(76 + 4 * k, 1.0f);
  put(108, 352.0f);
  put(112, 1.0f);
  std::memcpy(header.data() + 344, "n+1", 4);
  expect_mapped(write("a.nii", header, 352));
}

TEST_F(MappedVolume, ATruncatedFileIsRefused) {
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 512 512 257\nencoding: raw\n\n";
  const std::filesystem::path file = write("a.nrrd", header, header.size());
  std::filesystem::resize_file(file, header.size() + mapped_voxels - 1);
  EXPECT_THROW(read_volume(file, in_place()), Error);
}

}  // namespace
}  // namespace nacre::test
