// Nacre: tests of the .vtp of values: one point per surface cell, and the same bytes for the same seed.
#include <cmath>
#include <set>
#include <span>
#include <tuple>

#include "engine/io/registry.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

const RawArray& array(const RawMesh& mesh, const std::string& name, int components) {
  for (const RawArray& a : mesh.point_arrays)
    if (a.name == name) {
      EXPECT_EQ(a.components, components) << name;
      EXPECT_EQ(a.items(), mesh.points.size()) << name;
      return a;
    }
  throw std::runtime_error("no array " + name);
}

Vec3d vector(const RawArray& a, std::size_t i) { return {a.values[3 * i], a.values[3 * i + 1], a.values[3 * i + 2]}; }

class Values : public AppTest {
 protected:
  void flow(const Arguments& arguments) {
    const Outcome run = nacre(arguments + Arguments{"--out", path("a.vtp"), "--report", path("r.json"), "--quiet"});
    ASSERT_EQ(run.status, 0) << run.err;
    mesh_ = read_raw(folder_ / "a.vtp").mesh;
    cell_ = read_json("r.json")["embedding"]["cell_size"];
  }

  RawMesh mesh_;
  double cell_ = 0;  ///< edge of a texture cell
};

TEST_F(Values, OnePointPerSurfaceCellAndNothingElse) {
  flow(small_flow);
  EXPECT_EQ(mesh_.points.size(), read_json("r.json")["embedding"]["surface_cells"].get<std::size_t>());
  EXPECT_EQ(mesh_.polygons(), 0u);
  EXPECT_TRUE(mesh_.cell_arrays.empty());
  std::set<std::string> names;
  for (const RawArray& a : mesh_.point_arrays) names.insert(a.name);
  EXPECT_EQ(names, (std::set<std::string>{"value", "velocity", "normal", "closest_point"}));
  EXPECT_EQ(mesh_.point_arrays.size(), 4u);
  EXPECT_TRUE(contains(content("a.vtp"), "type=\"Float64\" Name=\"closest_point\"")) << "as exact as the centres";
  // A sphere of diameter 2 at 64 cells: cells that it passes through are 1.5 times its area in cells (mean of the
  // normal's absolute components).
  const double area = 4 * 3.14159265 / (cell_ * cell_);
  EXPECT_NEAR(double(mesh_.points.size()) / area, 1.5, 0.15);
}

TEST_F(Values, AListOfPiecesHoldsTheSame) {
  const Arguments dyed = small_flow + Arguments{"--dye", "1,0,0,0.4"};
  flow(dyed);
  const Outcome run = nacre(dyed + Arguments{"--out", path("b.pvtp"), "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, path("b.pvtp") + "\n");
  EXPECT_EQ(names(), (Arguments{"a.vtp", "b.pvtp", "b_0.vtp", "r.json"}));
  EXPECT_TRUE(without_origin(content("b_0.vtp")) == without_origin(content("a.vtp")));
  const RawMesh listed = read_raw(folder_ / "b.pvtp").mesh;
  EXPECT_EQ(listed.points, mesh_.points);
  for (const RawArray& a : mesh_.point_arrays) {
    EXPECT_EQ(array(listed, a.name, a.components).values, a.values) << a.name;
    const std::string entry = "Name=\"" + a.name + "\" NumberOfComponents=\"" + std::to_string(a.components) + "\"/>";
    EXPECT_TRUE(contains(content("b.pvtp"), entry)) << entry;
  }
  EXPECT_EQ(nacre({"rerun", path("r.json"), "--out", path("c.pvtp"), "--quiet"}).status, 0);
  EXPECT_TRUE(content("c_0.vtp") == content("b_0.vtp"));
  for (const char* name : {"b.pvtp", "b_0.vtp"}) {
    const Outcome compared = nacre({"rerun", path(name)});
    EXPECT_EQ(compared.status, 1);
    EXPECT_TRUE(contains(compared.err, "give --out FILE.vtp")) << compared.err;
    EXPECT_EQ(nacre({"rerun", path(name), "--out", path("whole.vtp"), "--quiet"}).status, 0);
    EXPECT_TRUE(content("whole.vtp") == content("a.vtp"));
  }
}

TEST_F(Values, WherePartsCannotBeWrittenTheOlderOnesStay) {
  const Arguments all = small_flow + Arguments{"--out", path("b.pvtp")};
  write("b.pvtp", "an older list");
  write("b_0.vtp", "an older part");
  expect_failure(nacre_limited("-f 16", all), 1, {"b_0.vtp"});
  EXPECT_EQ(content("b.pvtp") + content("b_0.vtp"), "an older listan older part");
  EXPECT_EQ(names(), (Arguments{"b.pvtp", "b_0.vtp"}));
}

TEST_F(Values, CentresLieOnALatticeAndAreDistinct) {
  flow(small_flow);
  std::set<std::tuple<long, long, long>> cells;
  const Vec3d origin = mesh_.points[0];
  for (const Vec3d& p : mesh_.points) {
    const Vec3d q = (p - origin) / cell_;
    for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(q[axis], std::round(q[axis]), 1e-3);
    cells.insert({std::lround(q.x), std::lround(q.y), std::lround(q.z)});
  }
  EXPECT_EQ(cells.size(), mesh_.points.size());
}

TEST_F(Values, ArraysMeanWhatTheyAreCalled) {
  flow(small_flow);
  const RawArray& value = array(mesh_, "value", 1);
  const RawArray& velocity = array(mesh_, "velocity", 3);
  const RawArray& normal = array(mesh_, "normal", 3);
  const RawArray& closest = array(mesh_, "closest_point", 3);
  double low = 1, high = 0, fastest = 0, farthest = 0, off_sphere = 0;
  for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
    low = std::min(low, double(value.values[i]));
    high = std::max(high, double(value.values[i]));
    const Vec3d v = vector(velocity, i), n = vector(normal, i), c = vector(closest, i);
    fastest = std::max(fastest, length(v));
    ASSERT_NEAR(length(n), 1, 1e-4);
    ASSERT_LE(std::abs(dot(v, n)), 1e-3 * (length(v) + 1e-3));
    ASSERT_GT(dot(n, normalized(c)), 0.95) << "normals of a sphere point away from its centre";
    off_sphere = std::max(off_sphere, std::abs(length(c) - 1));
    farthest = std::max(farthest, length(mesh_.points[i] - c));
  }
  EXPECT_GE(low, 0);
  EXPECT_LE(high, 1);
  EXPECT_GT(high - low, 0.2) << "the frame is not constant";
  EXPECT_GT(fastest, 0.5);
  EXPECT_LE(off_sphere, 0.02) << "on the facets of a sphere with 24 edges across";
  EXPECT_LE(farthest, 0.5 * std::sqrt(3.0) * cell_ * 1.001) << "within half a cell's diagonal";
}

TEST_F(Values, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  const auto bytes = [&](const std::string& name, const Arguments& arguments) {
    EXPECT_EQ(
        nacre(small_flow + arguments + Arguments{"--size", "64x48", "--out", path(name), "--image", path("a.png")})
            .status,
        0);
    return content(name) + content("a.png");
  };
  const std::string one = bytes("1.vtp", {"--threads", "1", "--seed", "5"});
  EXPECT_GT(one.size(), 100000u);
  EXPECT_EQ(one, bytes("2.vtp", {"--threads", "2", "--seed", "5"}));
  EXPECT_EQ(one, bytes("3.vtp", {"--threads", "3", "--seed", "5"}));
  EXPECT_NE(without_origin(one), without_origin(bytes("4.vtp", {"--threads", "1", "--seed", "6"})));
}

TEST_F(Values, ClosestPointsLieOnAFlatMesh) {
  // The plane z = x / 4 over a square: every closest point and normal is known.
  write("plane.obj", "v 0 0 0\nv 1 0 0.25\nv 1 1 0.25\nv 0 1 0\nf 1 2 3 4\n");
  flow({"flow", path("plane.obj"), "--vectors", "@rotation", "--resolution", "40", "--steps", "1"});
  const RawArray& normal = array(mesh_, "normal", 3);
  const RawArray& closest = array(mesh_, "closest_point", 3);
  const Vec3d expected = normalized(Vec3d(-0.25, 0, 1));
  double farthest = 0;
  for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
    const Vec3d c = vector(closest, i);
    ASSERT_NEAR(c.z, c.x / 4, 1e-5);
    ASSERT_NEAR(std::abs(dot(vector(normal, i), expected)), 1, 1e-5);
    farthest = std::max(farthest, length(mesh_.points[i] - c));
  }
  EXPECT_LE(farthest, 0.5 * std::sqrt(3.0) * cell_ * 1.001) << "within half a cell's diagonal";
  EXPECT_GT(mesh_.points.size(), 1600u);
}

}  // namespace
}  // namespace nacre::test
