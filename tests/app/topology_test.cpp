// Nacre: critical points and separatrices of `nacre flow`, as a user gets them.
#include <algorithm>
#include <cmath>

#include "engine/io/surface_writer.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Arguments small_topology = {"--resolution", "64", "--steps", "2", "--size", "192x192", "--no-legend"};

/// A sphere with the gradient of x^2 + 2 y^2 + 3 z^2: two sources, saddles and sinks, on the axes x, y and z.
class Topology : public AppTest {
 protected:
  std::string six_points() {
    Surface s = make_sample("sphere", 64).load(0);
    PointArray gradient{"gradient", 3, {}};
    for (const Vec3d& p : s.points) {
      const Vec3d n = normalized(p), g(2 * n.x, 4 * n.y, 6 * n.z), v = g - n * dot(g, n);
      for (int k = 0; k < 3; ++k) gradient.values.push_back(float(v[k]));
    }
    s.arrays = {gradient};
    write_surface(path("six.vtp"), s);
    return path("six.vtp");
  }
};

TEST_F(Topology, IsReportedAndWritten) {
  const Outcome done = nacre(Arguments{"flow", six_points(), "--quiet"} + small_topology +
                             Arguments{"--topology-out", path("t.vtp"), "--report", path("r.json")});
  ASSERT_EQ(done.status, 0) << done.err;
  const json report = json::parse(content("r.json"));
  EXPECT_EQ(report["outputs"], json({path("t.vtp")}));
  const json& topology = report["topology"];
  EXPECT_EQ(topology["counts"]["source"], 2);
  EXPECT_EQ(topology["counts"]["saddle"], 2);
  EXPECT_EQ(topology["counts"]["sink"], 2);
  ASSERT_EQ(topology["points"].size(), 6u);
  for (const json& point : topology["points"]) {
    const int axis = point["kind"] == "source" ? 0 : point["kind"] == "saddle" ? 1 : 2;
    double length = 0;
    for (int k = 0; k < 3; ++k) length += std::pow(point["position"][std::size_t(k)].get<double>(), 2);
    EXPECT_NEAR(std::fabs(point["position"][std::size_t(axis)].get<double>()) / std::sqrt(length), 1, 0.001);
  }
  EXPECT_EQ(topology["index_sum"], 2);
  EXPECT_EQ(topology["euler_characteristic"], 2);
  EXPECT_EQ(topology["rims"]["count"], 0);
  EXPECT_EQ(topology["separatrices"]["count"], 8);
  EXPECT_EQ(topology["separatrices"]["to_critical_point"], 8);
  const std::string file = content("t.vtp");
  EXPECT_EQ(topology["closed_orbits"], (json{{"attracting", 0}, {"repelling", 0}}));
  const int lines = 8 + topology["separation_lines"].get<int>() + topology["attachment_lines"].get<int>();
  EXPECT_TRUE(contains(file, "NumberOfVerts=\"6\" NumberOfLines=\"" + std::to_string(lines) + "\""))
      << file.substr(0, 600);
}

TEST_F(Topology, IsDrawnWhereTheCameraSeesIt) {
  const Arguments from_x =
      Arguments{"flow", six_points(), "--quiet", "--camera", "+x", "--color", "none"} + small_topology;
  ASSERT_EQ(nacre(from_x + Arguments{"--image", path("with.png"), "--topology"}).status, 0);
  ASSERT_EQ(nacre(from_x + Arguments{"--image", path("without.png")}).status, 0);
  const Image with = read_png(path("with.png")), without = read_png(path("without.png"));
  const auto coloured = [](const Image& image) {  // one source of +x, gray elsewhere
    int red = 0, blue = 0, far_red = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.at(x, y);
        const bool is_red = p[0] > 200 && p[1] < 80 && p[2] < 80;
        red += is_red;
        far_red += is_red && std::hypot(x - 96, y - 96) > 8;
        blue += p[2] > 200 && p[0] < 80;
      }
    return std::array{red, far_red, blue};
  };
  EXPECT_EQ(coloured(without), (std::array{0, 0, 0}));
  EXPECT_GT(coloured(with)[0], 5);
  EXPECT_EQ(coloured(with)[1], 0);  // the one behind is hidden
}

TEST_F(Topology, StreamlinesAreWritten) {
  const auto lines_at = [&](const std::string& spacing) {
    const Outcome done = nacre(Arguments{"flow", six_points(), "--quiet", "--line-spacing", spacing} + small_topology +
                               Arguments{"--streamlines-out", path("s.vtp"), "--report", path("r.json")});
    EXPECT_EQ(done.status, 0) << done.err;
    const json report = json::parse(content("r.json"));
    EXPECT_EQ(report["outputs"], json({path("s.vtp")}));
    const int count = report["streamlines"]["count"].get<int>();
    EXPECT_TRUE(contains(content("s.vtp"), "NumberOfLines=\"" + std::to_string(count) + "\""));
    return count;
  };
  const int few = lines_at("0.1"), many = lines_at("0.05");
  EXPECT_GT(few, 20);
  EXPECT_GT(many, few);
}

TEST_F(Topology, PointsAreFollowedThroughTheSteps) {
  const Outcome done = nacre(Arguments{"flow", "--quiet", "--sample", "torus", "--detail", "32", "--tracks-out",
                                       path("t.vtp"), "--report", path("r.json")} +
                             small_topology);
  ASSERT_EQ(done.status, 0) << done.err;
  const json report = json::parse(content("r.json"));
  const json tracks = report["tracks"];
  EXPECT_GT(tracks["count"], 0);
  EXPECT_GE(tracks["longest"], 2);
  EXPECT_LE(tracks["longest"], tracks["times"]);
  EXPECT_LE(tracks["through_all_times"].get<int>() + tracks["appear"].get<int>(), tracks["count"].get<int>());
  const std::string file = content("t.vtp");
  for (const char* name : {"track", "time", "kind", "index", "persistence"})
    EXPECT_TRUE(contains(file, "Name=\"" + std::string(name) + "\"")) << name;
  EXPECT_EQ(report["outputs"], json({path("t.vtp")}));
  expect_failure(nacre(Arguments{"flow", six_points(), "--quiet", "--tracks-out", path("t.vtp")} + small_topology), 1,
                 {"followed in time", "one time only"});
}

TEST_F(Topology, TracksAreDrawn) {
  // A saddle and its companions that turn with the field about z by a quarter of a circle.
  const auto turned = [&](const std::string& name, double angle) {
    Surface s = make_sample("sphere", 64).load(0);
    PointArray gradient{"gradient", 3, {}};
    const double c = std::cos(angle), d = std::sin(angle);
    for (const Vec3d& p : s.points) {
      const Vec3d n = normalized(p), m(c * n.x + d * n.y, -d * n.x + c * n.y, n.z), h(2 * m.x, 4 * m.y, 6 * m.z);
      const Vec3d g(c * h.x - d * h.y, d * h.x + c * h.y, h.z), v = g - n * dot(g, n);
      for (int k = 0; k < 3; ++k) gradient.values.push_back(float(v[k]));
    }
    s.arrays = {gradient};
    write_surface(path(name), s);
    return path(name);
  };
  Arguments run = {"flow"};
  for (int k = 0; k <= 6; ++k) run.push_back(turned("g_" + std::to_string(k) + ".vtp", 0.25 * k));
  const auto yellow = [&](const Arguments& more) {
    const Outcome done =
        nacre(run + Arguments{"--quiet", "--camera", "+x", "--color", "none", "--image", path("t.png")} +
              small_topology + more);
    EXPECT_EQ(done.status, 0) << done.err;
    const Image image = read_png(path("t.png"));
    int count = 0;
    for (int i = 0; i < image.width * image.height; ++i) {
      const std::uint8_t* p = image.at(i % image.width, i / image.width);
      count += p[0] > p[2] + 80 && p[1] > p[2] + 60;
    }
    return count;
  };
  EXPECT_EQ(yellow({}), 0);
  EXPECT_GT(yellow({"--tracks"}), 30);
  expect_failure(
      nacre(Arguments{"flow", six_points(), "--quiet", "--tracks", "--image", path("t.png")} + small_topology), 1,
      {"followed in time", "one time only"});
}

TEST_F(Topology, ProbesTellTheTimesOfPoints) {
  const Arguments run = {"flow", "--quiet", "--sample", "pulse", "--detail", "24", "--report", path("r.json")};
  ASSERT_EQ(nacre(run + small_topology + Arguments{"--probe", "1,0,0;0,1,0", "--color", "speed"}).status, 0);
  const json probes = json::parse(content("r.json"))["probes"];
  ASSERT_EQ(probes.size(), 2u);
  for (const json& probe : probes) {
    EXPECT_GT(probe["times"].size(), 4u);
    EXPECT_EQ(probe["times"].size(), probe["speeds"].size());
    EXPECT_EQ(probe["colors"]["array"], "speed");
    double most = 0;
    for (std::size_t k = 0; k < probe["speeds"].size(); ++k) {
      const json& v = probe["vectors"][k];
      const double length = std::hypot(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
      EXPECT_LE(probe["speeds"][k].get<double>(), length + 1e-5);
      EXPECT_NEAR(probe["colors"]["values"][k].get<double>(), probe["speeds"][k].get<double>(), 0.1 * length + 1e-5);
      most = std::max(most, length);
    }
    EXPECT_GT(most, 0);
  }
  expect_failure(nacre(run + small_topology + Arguments{"--probe", "1,2"}), 2, {"--probe", "1,2", "three numbers"});
  expect_failure(nacre(run + small_topology + Arguments{"--probe", "99,0,0"}), 1, {"--probe", "not on the surface"});
}

TEST_F(Topology, BadInputIsNamed) {
  expect_failure(
      nacre(Arguments{"flow", "--quiet", "--sample", "sphere", "--topology-out", path("t.png")} + small_topology), 2,
      {"--topology-out", ".vtp"});
  expect_failure(nacre(Arguments{"flow", "--quiet", "--sample", "sphere", "--persistence", "2"} + small_topology), 2,
                 {"--persistence"});
}

}  // namespace
}  // namespace nacre::test
