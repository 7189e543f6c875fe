// Nacre: tests of damaged, odd and empty input: a result with a warning, or one clear line; never half a file.
#include <limits>

#include "engine/io/vtp_writer.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// A square of 8 x 8 quads in the plane z = 0, with the vectors (1, 0.5, 0).
Surface square() {
  Surface surface;
  PointArray velocity{"velocity", 3, {}};
  for (int y = 0; y <= 8; ++y)
    for (int x = 0; x <= 8; ++x) {
      surface.points.push_back({x / 8.0, y / 8.0, 0});
      velocity.values.insert(velocity.values.end(), {1, 0.5, 0});
    }
  for (std::uint32_t y = 0; y < 8; ++y)
    for (std::uint32_t x = 0; x < 8; ++x) {
      const std::uint32_t a = 9 * y + x;
      surface.triangles.push_back({a, a + 1, a + 10});
      surface.triangles.push_back({a, a + 10, a + 9});
    }
  surface.arrays.push_back(velocity);
  return surface;
}

class BadInput : public AppTest {
 protected:
  std::string save(const std::string& name, const Surface& surface) const {
    write_vtp(path(name), std::span<const Vec3d>(surface.points), surface.triangles, surface.arrays);
    return path(name);
  }

  /// A small run into `a.png` and `a.vtp`.
  Outcome flow(const std::string& file, const Arguments& more = {}) const {
    return nacre(Arguments{"flow", file, "--resolution", "48", "--steps", "1", "--size", "64x48", "--image",
                           path("a.png"), "--out", path("v.vtp")} +
                 more);
  }

  /// Both outputs are there, and one warning holds each of `parts`.
  void expect_warning(const Outcome& run, const Arguments& parts) const {
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(exists("a.png") && exists("v.vtp"));
    EXPECT_GE(lines_with(run.err, "warning: "), 1) << run.err;
    for (const std::string& part : parts) EXPECT_TRUE(contains(run.err, part)) << part << "\n" << run.err;
  }

  void expect_clear_failure(const Outcome& run, int status, const Arguments& parts) const {
    expect_failure(run, status, parts);
    for (const std::string& name : names())
      EXPECT_TRUE(name != "a.png" && name != "v.vtp" && name[0] != '.') << name << " is left behind";
  }
};

TEST_F(BadInput, FilesThatCannotBeRead) {
  expect_clear_failure(flow(path("none.vtp")), 1, {"none.vtp"});
  expect_clear_failure(flow(folder_.path().string()), 1, {folder_.path().string()});
  expect_clear_failure(flow(write("empty.vtp", "")), 1, {"empty.vtp"});
  expect_clear_failure(flow(write("a.xyzzy", "what is this\n")), 1, {"a.xyzzy", "known are"});
  expect_clear_failure(flow(write("garbage.ply", std::string(1000, '\x7f'))), 1, {"garbage.ply"});
  expect_clear_failure(flow(write("misnamed.stl", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n")), 1,
                       {"misnamed.stl", "PLY"});
  expect_failure(nacre({"info", path("none.vtp")}), 1, {"none.vtp"});
}

TEST_F(BadInput, TruncatedFiles) {
  const std::string whole = read_all(save("whole.vtp", square()));
  for (const double share : {0.05, 0.5, 0.9, 0.98}) {
    const std::string file = write("cut.vtp", whole.substr(0, std::size_t(share * double(whole.size()))));
    expect_clear_failure(flow(file), 1, {"cut.vtp"});
  }
}

TEST_F(BadInput, CountsThatLie) {
  expect_clear_failure(flow(write("a.ply",
                                  "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                                  "property float y\nproperty float z\nend_header\n")),
                       1, {"a.ply"});
  expect_clear_failure(flow(write("a.off", "OFF\n2000000000 2000000000 0\n0 0 0\n")), 1, {"a.off"});
}

TEST_F(BadInput, NoTriangles) {
  expect_clear_failure(flow(write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), {"--vectors", "@swirl"}), 1,
                       {"points.obj"});
  expect_clear_failure(flow(write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), {"--vectors", "@swirl"}), 1,
                       {"lines.obj"});
  Surface flat = square();
  for (Vec3d& p : flat.points) p.y = 0;
  expect_clear_failure(flow(save("flat.vtp", flat)), 1, {"flat.vtp", "no triangles"});
  for (Vec3d& p : flat.points) p = {infinite, 0, 0};
  expect_clear_failure(flow(save("inf.vtp", flat)), 1, {"inf.vtp", "no triangles"});
}

TEST_F(BadInput, NoVectors) {
  Surface surface = square();
  surface.arrays = {{"pressure", 1, std::vector<float>(81, 1)}};
  expect_clear_failure(flow(save("s.vtp", surface)), 1, {"no vectors", "pressure", "--vectors @swirl"});
  expect_clear_failure(flow(path("s.vtp"), {"--vectors", "pressure"}), 1, {"pressure", "1 component"});
}

TEST_F(BadInput, PositionsThatAreNotFinite) {
  Surface surface = square();
  surface.points[0].x = infinite;                                   // the corner of two triangles
  surface.points[80].z = std::numeric_limits<double>::quiet_NaN();  // and of two more
  expect_warning(flow(save("s.vtp", surface)), {"4 of 128 triangles dropped", "NaN or infinite point"});
}

TEST_F(BadInput, VectorsThatAreNotFinite) {
  Surface surface = square();
  surface.arrays[0].values[30] = not_a_number;
  surface.arrays[0].values[60] = float(infinite);
  expect_warning(flow(save("s.vtp", surface)), {"velocity", "2 of 81 positions"});
}

TEST_F(BadInput, TrianglesWithoutArea) {
  Surface surface = square();
  surface.triangles.push_back({0, 0, 1});
  surface.triangles.push_back({0, 1, 2});
  surface.triangles.push_back({5, 5, 5});
  expect_warning(flow(save("s.vtp", surface)), {"3 of 131 triangles dropped", "zero area"});
}

TEST_F(BadInput, IndicesOutOfRange) {
  Surface surface = square();
  surface.triangles.push_back({0, 1, 81});
  surface.triangles.push_back({0, 1, 4294967295u});
  expect_warning(flow(save("s.vtp", surface)), {"2 of 130 triangles dropped", "out of range"});
}

TEST_F(BadInput, NoVelocityAnywhereStaysGreyNoise) {
  Surface surface = square();
  std::fill(surface.arrays[0].values.begin(), surface.arrays[0].values.end(), 0.0f);
  expect_warning(flow(save("s.vtp", surface)), {"zero everywhere"});
  const Outcome run = nacre({"info", path("v.vtp")});
  EXPECT_FALSE(contains(run.out, "nan")) << run.out;
}

TEST_F(BadInput, VectorsAcrossTheSurfaceAreReported) {
  Surface surface = square();
  for (std::size_t i = 0; i < 81; ++i) surface.arrays[0].values[3 * i + 2] = 10;
  expect_warning(flow(save("s.vtp", surface)), {"normal to the surface"});
}

TEST_F(BadInput, OddScalesAreNoTrouble) {
  for (const double scale : {1e-20, 1e15}) {
    Surface surface = square();
    for (Vec3d& p : surface.points) p = p * scale;
    const Outcome run = flow(save("s.vtp", surface));
    EXPECT_EQ(run.status, 0) << scale << run.err;
  }
}

TEST_F(BadInput, ResolutionsBeyondTheGrid) {
  const auto at = [&, file = save("s.vtp", square())](const std::string& resolution) {
    return nacre({"flow", file, "--image", path("a.png"), "--refine", "1", "--resolution", resolution});
  };
  expect_clear_failure(at("9999999"), 2, {"16..1048576"});
  expect_clear_failure(at("8"), 2, {"16..1048576"});
  expect_clear_failure(at("16384"), 1, {"too fine", "use --resolution"});
}

}  // namespace
}  // namespace nacre::test
