// Nacre: tests of volumes as they come: real ones, and those that others wrote to break readers.
#include <algorithm>
#include <numeric>
#include <set>

#include "engine/scene/volume/materials.hpp"
#include "tests/engine/io/volume_files.hpp"

namespace nacre::test {
namespace {

std::string failure_of(const fs::path& path) {
  try {
    read_volume(path);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::vector<fs::path> volumes_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && is_volume_file(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::size_t voxels_of_label(const Volume& volume, std::int64_t label) {
  const auto labels = count_labels(volume, 300);
  if (labels)
    for (const auto& [value, voxels] : *labels)
      if (value == label) return voxels;
  return 0;
}

TEST(VolumeData, EveryRealVolumeLoads) {
  NACRE_NEEDS_SHARED_DATA("labels");
  std::size_t read = 0;
  for (const char* folder : {"labels", "scalar"})
    for (const fs::path& path : volumes_in(shared_data(folder))) {
      const std::string why = failure_of(path);
      // Its header says 32 bits, it holds 16 bits per voxel.
      const bool cut = path.filename() == "small-scalar.inr";
      EXPECT_EQ(why.empty(), !cut) << path << ": " << why;
      read += why.empty();
    }
  EXPECT_EQ(read, 31u);
}

TEST(VolumeData, LiverHasItsLabels) {
  NACRE_NEEDS_SHARED_DATA("labels/junctions");
  const Volume liver = read_volume(shared_data("labels/junctions/liver.inr.gz"));
  EXPECT_EQ(liver.dims, Int3(438, 353, 165));
  expect_near(liver.spacing, {0.617188, 0.617188, 1.33333});
  EXPECT_EQ(voxels_of_label(liver, 84), 2u);
  EXPECT_EQ(voxels_of_label(liver, 255), 3160496u);
  MaterialOptions options;
  options.min_component = 10;
  std::vector<std::string> warnings;
  EXPECT_EQ(make_mesh_volume({&liver, 1}, options, &warnings).labels, (std::vector<std::int64_t>{0, 85, 127, 255}));
  EXPECT_FALSE(warnings.empty());
}

TEST(VolumeData, FrogAndAorta) {
  NACRE_NEEDS_SHARED_DATA("labels/frog");
  const Volume frog = read_volume(shared_data("labels/frog/frogtissue.mhd"));
  EXPECT_EQ(frog.dims, Int3(500, 470, 136));
  EXPECT_EQ(voxels_of_label(frog, 1), 35279u);
  const Volume aorta = read_volume(shared_data("scalar/aorta/aorta.mha"));
  expect_near(aorta.axes[0], {-1, 0, 0});
  expect_near(aorta.origin, {-156.445, -24.6094, 0}, 1e-3);
  EXPECT_NEAR(volume_statistics(aorta).max, 2570.2, 0.1);
}

TEST(VolumeData, HeadProbabilitiesFillTheHead) {
  NACRE_NEEDS_SHARED_DATA("labels/head-probabilities");
  std::vector<Volume> volumes;
  for (int i = 1; i <= 6; ++i)
    volumes.push_back(
        read_volume(shared_data("labels/head-probabilities") / ("c" + std::to_string(i) + "_40-44.nrrd")));
  const MeshVolume mesh = make_mesh_volume(volumes, {});
  EXPECT_EQ(mesh.labels, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(mesh.names[3], "c3_40-44");
  std::vector<std::size_t> voxels(7);
  for (const std::uint16_t material : mesh.material.copy()) ++voxels[material];
  for (int m = 1; m < 7; ++m) EXPECT_GT(voxels[std::size_t(m)], 100000u) << m;
  // In the middle of the head the six leave nothing to the outside; without the sixth, the air, its share is outside.
  const std::size_t middle = (107 * 212 + 106) * 169 + 84;
  EXPECT_NEAR(mesh.values[0][middle], 0, 0.02);
  MaterialOptions options;
  options.materials = {1, 2, 3, 4, 5};
  const MeshVolume without = make_mesh_volume(volumes, options);
  std::size_t outside = 0;
  for (const std::uint16_t material : without.material.copy()) outside += material == 0;
  EXPECT_GT(outside, voxels[0] + voxels[6] / 2);
}

TEST(VolumeData, SphereFunctionsDivideTheCube) {
  NACRE_NEEDS_SHARED_DATA("labels/cleaver");
  std::vector<Volume> volumes;
  for (int i = 1; i <= 4; ++i)
    volumes.push_back(read_volume(shared_data("labels/cleaver") / ("spheres" + std::to_string(i) + ".nrrd")));
  const MeshVolume mesh = make_mesh_volume(volumes, {});
  std::vector<std::size_t> voxels(5);
  for (const std::uint16_t material : mesh.material.copy()) ++voxels[material];
  EXPECT_EQ(voxels[0], 0u);  // everywhere one of the four is the largest
  for (int m = 1; m < 5; ++m) EXPECT_GT(voxels[std::size_t(m)], 100u);
}

TEST(VolumeData, ScalarVolumesNeedAnIsovalue) {
  NACRE_NEEDS_SHARED_DATA("scalar");
  const Volume skull = read_volume(shared_data("scalar/skull_2.9.inr"));
  EXPECT_THROW(make_mesh_volume({&skull, 1}, {}), Error);
  MaterialOptions options;
  options.isovalues = {2.9};
  const MeshVolume mesh = make_mesh_volume({&skull, 1}, options);
  const std::vector<std::uint16_t> material = mesh.material.copy();
  EXPECT_GT(std::accumulate(material.begin(), material.end(), 0), 1000);
}

TEST(VolumeData, MalformedFilesEndWell) {
  NACRE_NEEDS_SHARED_DATA("malformed");
  // Not three dimensions of space, more than one value per voxel, complex numbers, no values, or no such file.
  const std::set<std::string> bad = {"test_simple4d_raw.nrrd",
                                     "test2d_ascii.nrrd",
                                     "test1d_ascii.nrrd",
                                     "test_customFields.nrrd",
                                     "BallBinary30x30x30_byteskip_minus_five.nhdr",
                                     "nifti1.hdr",
                                     "nifti2.hdr",
                                     "analyze.hdr",
                                     "5D_zeros.nii.gz",
                                     "5D_small.nii",
                                     "complex.nii.gz",
                                     "not-nifti.nii",
                                     "example4d.nii.gz",
                                     "example_nifti2.nii.gz",
                                     "row_major.dconn.nii",
                                     "functional.nii",
                                     "test.mgz"};
  std::size_t seen = 0;
  for (const char* folder : {"e-nrrd", "e-nifti", "e-vtk", "e-misc"})
    for (const fs::path& path : volumes_in(shared_data("malformed") / folder)) {
      const std::string why = failure_of(path);
      EXPECT_EQ(why.find('\n'), why.npos);
      EXPECT_EQ(!why.empty(), bad.count(path.filename().string()) > 0) << path << ": " << why;
      ++seen;
    }
  EXPECT_EQ(seen, 44u);
}

TEST(VolumeData, TwinsAreEqual) {
  NACRE_NEEDS_SHARED_DATA("malformed/e-nifti");
  const fs::path nifti = shared_data("malformed/e-nifti"), nrrd = shared_data("malformed/e-nrrd");
  EXPECT_EQ(values_of(read_volume(nifti / "big.nii.gz")), values_of(read_volume(nifti / "little.nii.gz")));
  EXPECT_EQ(values_of(read_volume(nifti / "avg152T1_LR_nifti.nii")),
            values_of(read_volume(nifti / "avg152T1_LR_nifti2.nii.gz")));
  const std::vector<double> ball = values_of(read_volume(nrrd / "BallBinary30x30x30.nrrd"));
  for (const char* name : {"BallBinary30x30x30.nhdr", "BallBinary30x30x30.nii.gz", "BallBinary30x30x30_bz2.nrrd",
                           "BallBinary30x30x30_gz.nrrd", "BallBinary30x30x30_gz_byteskip_minus_one.nrrd",
                           "BallBinary30x30x30_gz_lineskip.nrrd", "BallBinary30x30x30_byteskip_minus_one.nhdr",
                           "BallBinary30x30x30_byteskip_minus_one_nifti.nhdr"})
    EXPECT_EQ(values_of(read_volume(nrrd / name)), ball) << name;
}

}  // namespace
}  // namespace nacre::test
