// Nacre: tests of the built-in volumes: that they are what they say, about as large as the source's data, and without
// specks.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <set>

#include "compute/device/error.hpp"
#include "engine/scene/samples/phantoms.hpp"

namespace nacre {
namespace {

/// Labels of a phantom; of a scalar one 1 inside of the interface.
std::vector<int> labels_of(const Volume& volume) {
  if (const auto* labels = std::get_if<VoxelArray<std::uint8_t>>(&volume.values))
    return {labels->begin(), labels->end()};
  std::vector<int> labels;
  for (const float v : std::get<VoxelArray<float>>(volume.values)) labels.push_back(v > phantom_isovalue);
  return labels;
}

/// Area of all interfaces in voxel faces, those on the volume's own faces included. A plane of any direction has on
/// average 3/2 voxel faces per unit of area, so that two thirds of them are about right for curved surfaces.
double interface_area(const Volume& volume) {
  const std::vector<int> labels = labels_of(volume);
  const Int3 d = volume.dims;
  const std::size_t stride[3] = {1, std::size_t(d.x), std::size_t(d.x) * d.y};
  std::size_t faces = 0, at = 0;
  for (int k = 0; k < d.z; ++k)
    for (int j = 0; j < d.y; ++j)
      for (int i = 0; i < d.x; ++i, ++at) {
        const int index[3] = {i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          if (index[axis] == 0) faces += labels[at] != 0;
          const int next = index[axis] + 1 < d[axis] ? labels[at + stride[axis]] : 0;
          faces += labels[at] != next;
        }
      }
  return double(faces) * 2 / 3;
}

/// Sizes of the 26-connected pieces of each label but the outside.
std::multimap<int, std::size_t> pieces(const Volume& volume) {
  const std::vector<int> labels = labels_of(volume);
  const Int3 d = volume.dims;
  std::vector<bool> done(labels.size());
  std::multimap<int, std::size_t> found;
  for (std::size_t seed = 0; seed < labels.size(); ++seed) {
    if (done[seed] || labels[seed] == 0) continue;
    std::vector<std::size_t> front{seed};
    done[seed] = true;
    std::size_t size = 0;
    while (!front.empty()) {
      const std::size_t at = front.back();
      front.pop_back();
      ++size;
      const int i = int(at % d.x), j = int(at / d.x % d.y), k = int(at / d.x / d.y);
      for (int dk = -1; dk <= 1; ++dk)
        for (int dj = -1; dj <= 1; ++dj)
          for (int di = -1; di <= 1; ++di) {
            const int x = i + di, y = j + dj, z = k + dk;
            if (x < 0 || y < 0 || z < 0 || x >= d.x || y >= d.y || z >= d.z) continue;
            const std::size_t next = (std::size_t(z) * d.y + y) * d.x + x;
            if (done[next] || labels[next] != labels[seed]) continue;
            done[next] = true;
            front.push_back(next);
          }
    }
    found.emplace(labels[seed], size);
  }
  return found;
}

struct Anatomy {
  const char* name;
  Int3 dims;
  int labels;        // beside the outside
  double particles;  // that the source's data of this size has
};

void PrintTo(const Anatomy& anatomy, std::ostream* out) { *out << anatomy.name; }

class AnatomyTest : public testing::TestWithParam<Anatomy> {};

/// Where particles are 1 voxel apart there are 2 / sqrt(3) = 1.155 of them per unit of area, and up to four times as
/// many in thin and curved positions.
TEST_P(AnatomyTest, HasTheSizeTheLabelsAndTheAreaOfTheSourcesAndNoSpecks) {
  const Volume volume = make_phantom(GetParam().name);
  EXPECT_EQ(volume.dims, GetParam().dims);
  EXPECT_EQ(volume.spacing, Vec3d(1));
  const std::vector<int> labels = labels_of(volume);
  const std::set<int> different(labels.begin(), labels.end());
  EXPECT_EQ(int(different.size()), GetParam().labels + 1);
  EXPECT_EQ(*different.begin(), 0);
  EXPECT_EQ(*different.rbegin(), GetParam().labels);
  const double area = interface_area(volume);
  EXPECT_LT(area * 1.155, GetParam().particles * 1.05);
  EXPECT_GT(area * 1.155, GetParam().particles * 0.35);
  for (const auto& [label, size] : pieces(volume)) EXPECT_GE(size, 64u) << "label " << label;
}

INSTANTIATE_TEST_SUITE_P(All, AnatomyTest,
                         testing::Values(Anatomy{"torso", {136, 136, 136}, 4, 350e3},
                                         Anatomy{"head", {199, 250, 249}, 4, 2.1e6},
                                         Anatomy{"heart", {268, 129, 177}, 1, 80e3},
                                         Anatomy{"lungs", {268, 129, 177}, 1, 74e3},
                                         Anatomy{"ribcage", {268, 129, 177}, 1, 470e3}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Phantoms, AnalyticOnesHaveTheirVolumes) {
  constexpr double pi = 3.14159265358979323846;
  const auto count = [](const std::string& name) {
    std::map<int, double> voxels;
    for (const int label : labels_of(make_phantom(name))) ++voxels[label];
    return voxels;
  };
  const double ball = 4 * pi / 3 * 13 * 13 * 13, cap = pi * 6 * 6 * (3 * 13 - 6) / 3;
  auto voxels = count("two-spheres");
  EXPECT_NEAR(voxels[1], ball - cap, 0.02 * ball);
  EXPECT_EQ(voxels[1], voxels[2]);
  voxels = count("nested-shells");
  EXPECT_NEAR(voxels[3], 4 * pi / 3 * 1000, 60);
  EXPECT_NEAR(voxels[2], 4 * pi / 3 * (14 * 14 * 14 - 1000), 120);
  voxels = count("three-sectors");
  for (int label = 1; label <= 3; ++label) EXPECT_NEAR(voxels[label], 4 * pi / 9 * 18 * 18 * 18, 80);
  voxels = count("ellipsoid");
  EXPECT_NEAR(voxels[1], 4 * pi / 3 * 19 * 13 * 9, 60);
  EXPECT_EQ(count("near-bodies").size(), 3u);
}

TEST(Phantoms, ScalarsAreSmoothAndBetweenZeroAndOne) {
  for (const PhantomInfo& info : phantoms()) {
    if (info.labelled) continue;
    const Volume volume = make_phantom(info.name);
    const auto& values = std::get<VoxelArray<float>>(volume.values);
    float steepest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_TRUE(values[i] >= 0 && values[i] <= 1) << info.name;
      if (i % std::size_t(volume.dims.x) != 0) steepest = std::max(steepest, std::abs(values[i] - values[i - 1]));
    }
    EXPECT_LT(steepest, 0.25f) << info.name << ": tanh(d / 2.5) / 2 rises by 0.2 a voxel";
    EXPECT_GT(steepest, 0.15f) << info.name;
  }
}

TEST(Phantoms, DetailChangesTheVoxelsNotThePlace) {
  for (const PhantomInfo& info : phantoms()) {
    const Volume small = make_phantom(info.name, 24);
    EXPECT_EQ(std::max({small.dims.x, small.dims.y, small.dims.z}), 24) << info.name;
    EXPECT_EQ(volume_statistics(small).integral, info.labelled) << info.name;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(small.spacing[axis] * (small.dims[axis] - 1), info.dims[axis] - 1, 0.51 * small.spacing[axis])
          << info.name;
  }
  const Volume own = make_phantom("two-spheres"), fine = make_phantom("two-spheres", 95);
  ASSERT_EQ(fine.dims, Int3(95));
  const std::vector<int> a = labels_of(own), b = labels_of(fine);
  for (int k = 0; k < 48; ++k)
    for (int i = 0; i < 48; ++i)  // every second voxel lies where one of the other grid does
      EXPECT_EQ(a[(k * 48 + 20) * 48 + i], b[std::size_t((2 * k * 95 + 40) * 95 + 2 * i)]);
}

TEST(Phantoms, OneAndTwoThreadsGiveTheSameVoxels) {
  for (const char* name : {"torso", "head", "ribcage"}) {
    const VolumeValues two = make_phantom(name, 64).values;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(two, make_phantom(name, 64).values) << name;
  }
}

TEST(Phantoms, WrongWordsAreNamed) {
  const auto message = [](const std::string& name, int detail) -> std::string {
    try {
      make_phantom(name, detail);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("torsi", 0).find("torso"), std::string::npos);
  EXPECT_NE(message("torso", 15).find("16 to 1024"), std::string::npos);
  EXPECT_NE(message("torso", 1025).find("16 to 1024"), std::string::npos);
  EXPECT_FALSE(is_phantom("sphere"));
  EXPECT_TRUE(is_phantom("torso"));
}

}  // namespace
}  // namespace nacre
