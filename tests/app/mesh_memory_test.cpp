// Nacre: tests of how much memory `nacre mesh` takes, and expects to take.
#include <fstream>

#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

class LongMeshMemory : public MeshTest {
 protected:
  /// A volume of 160 x 150 x 140 voxels with label(x, y, z).
  template <class Label>
  std::string write_volume(const std::string& name, const Label& label) {
    std::ofstream out(path(name), std::ios::binary);
    out << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 160 150 140\nspacings: 1 1 1\nencoding: raw\n\n";
    for (int z = 0; z < 140; ++z)
      for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 160; ++x) out.put(char(label(x, y, z)));
    return path(name);
  }

  /// Memory that the process had at most, over what it expected.
  double over_estimate(const std::string& volume) {
    const Outcome run = nacre({"mesh", volume, "--min-size", "1", "--max-size", "1.5", "--report", path("r.json"),
                               "--out", path("a.ply"), "--quiet"});
    EXPECT_EQ(run.status, 0) << run.err;
    const nlohmann::json memory = read_json("r.json")["memory"];
    return double(memory["peak_bytes"]) / double(memory["estimated_peak_bytes"]);
  }
};

/// A ball, and a volume that is full of boundaries.
TEST_F(LongMeshMemory, IsWhatWasExpected) {
  const auto square = [](double x, double y, double z) { return x * x + y * y + z * z; };
  const double sparse = over_estimate(
      write_volume("ball.nrrd", [&](int x, int y, int z) { return square(x - 80, y - 75, z - 70) < 45 * 45 ? 1 : 0; }));
  const double dense = over_estimate(write_volume("balls.nrrd", [&](int x, int y, int z) {
    return square(x % 20 - 10, y % 20 - 10, z % 20 - 10) < 64 ? 1 + x / 20 + 8 * (y / 75) : 0;
  }));
  for (const double ratio : {sparse, dense}) {
    EXPECT_GT(ratio, 0.55) << "stars take less than the cells that a run may fall back to";
    EXPECT_LT(ratio, 1.5);
  }
}

}  // namespace
}  // namespace nacre::test
