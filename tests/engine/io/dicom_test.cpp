// Nacre: tests of DICOM: which files and folders count as such, and what the child gives back. Real files of other
// programs are in tests/exchange.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/io/volume_readers.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

constexpr const char* variable = "NACRE_DICOM_IMPORT";

fs::path write(const TemporaryFolder& folder, const std::string& name, const std::string& bytes) {
  fs::create_directories((folder / name).parent_path());
  std::ofstream(folder / name, std::ios::binary) << bytes;
  return folder / name;
}

/// A shell script in the child's position, for the life of this object.
class FakeChild {
 public:
  FakeChild(const TemporaryFolder& folder, const std::string& script) {
    const fs::path path = write(folder, "child.sh", "#!/bin/sh\n" + script + "\n");
    fs::permissions(path, fs::perms::owner_all);
    ::setenv(variable, path.c_str(), 1);
  }
  ~FakeChild() { ::unsetenv(variable); }
};

std::string dicom_like() { return std::string(128, '\0') + "DICM and nothing else"; }

std::string error_of(const fs::path& position) {
  try {
    read_volume(position);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Dicom, FilesAndFoldersAreKnownByTheirContent) {
  const TemporaryFolder folder;
  const fs::path numbered = write(folder, "scan/IM0007", dicom_like());
  const fs::path dotted = write(folder, "scan/1.2.840.113", dicom_like());
  EXPECT_TRUE(is_volume_file(numbered));
  EXPECT_TRUE(is_volume_file(dotted));
  EXPECT_TRUE(is_volume_file(folder / "scan"));
  EXPECT_EQ(find_volume_format(folder / "scan")->name, "DICOM");
  EXPECT_FALSE(is_volume_file(write(folder, "other/IM0007", "something else")));
  EXPECT_FALSE(is_volume_file(folder / "other"));
  EXPECT_FALSE(is_volume_file(folder / "missing"));
  EXPECT_FALSE(is_volume_file(write(folder, "mesh.ply", dicom_like())));
}

TEST(Dicom, WhatTheChildWritesIsRead) {
  const TemporaryFolder folder;
  write(folder, "scan/IM0", dicom_like());
  const FakeChild child(folder,
                        "printf 'NRRD0004\\ntype: short\\ndimension: 3\\nsizes: 2 2 2\\nendian: little\\nencoding: "
                        "raw\\nspacings: 1 2 3\\n\\n\\1\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\0\\5\\0' >$2/volume.nrrd\n"
                        "echo 0 $2/volume.nrrd");
  const Volume volume = read_volume(folder / "scan");
  EXPECT_EQ(volume.voxels(), 8u);
  EXPECT_EQ(volume.spacing.x, 1);
  EXPECT_EQ(volume.spacing.z, 3);
  EXPECT_EQ(volume.name, "scan");
  const FileInfo info = describe(folder / "scan");
  EXPECT_EQ(info.format, "DICOM");
  EXPECT_EQ(info.bytes, dicom_like().size());
}

TEST(Dicom, FailuresAreErrorsOfTheFile) {
  const TemporaryFolder folder;
  const fs::path file = write(folder, "a.dcm", dicom_like());
  {
    const FakeChild child(folder, "echo 'nacre-dicom-import: it holds 2 series' >&2; exit 1");
    EXPECT_NE(error_of(file).find("it holds 2 series"), std::string::npos) << error_of(file);
  }
  {
    const FakeChild child(folder, "kill -SEGV $$");
    EXPECT_NE(error_of(file).find("GDCM crashed"), std::string::npos) << error_of(file);
  }
  {
    const FakeChild child(folder, "echo nonsense >$2/volume.nrrd; echo 0 $2/volume.nrrd");
    const std::string error = error_of(file);
    EXPECT_NE(error.find("a.dcm"), std::string::npos) << error;
    EXPECT_EQ(error.find("nacre-import"), std::string::npos) << "the temporary file is named: " << error;
  }
  ::setenv(variable, "/nowhere", 1);
  EXPECT_NE(error_of(file).find("without GDCM"), std::string::npos) << error_of(file);
  ::unsetenv(variable);
}

TEST(Dicom, DamagedFilesAreRefused) {
  if (!dicom_child_available()) GTEST_SKIP() << "nacre-dicom-import was not built (GDCM not found)";
  const TemporaryFolder folder;
  EXPECT_NE(error_of(write(folder, "a/a.dcm", dicom_like())), "");
  EXPECT_NE(error_of(folder / "a"), "");
  std::string noise = dicom_like();
  std::uint32_t state = 7;
  for (int i = 0; i < 4096; ++i) noise += char((state = state * 1664525u + 1013904223u) >> 24);
  EXPECT_NE(error_of(write(folder, "b/b.dcm", noise)), "");
}

}  // namespace
}  // namespace nacre
