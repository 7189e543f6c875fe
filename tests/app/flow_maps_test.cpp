// Nacre: flow maps and Lyapunov exponents of `nacre flow`, as a user gets them.
#include <algorithm>
#include <cmath>

#include "engine/io/reader.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Words small_flow_maps = {"--resolution", "64", "--steps", "2", "--size", "192x192", "--no-legend"};

class FlowMaps : public AppTest {
 protected:
  /// A sphere with vectors by `field`.
  std::string sphere(const std::string& name, const std::function<Vec3d(const Vec3d&)>& field, double radius = 1) {
    Surface s = make_sample("sphere", 48).load(0);
    PointArray velocity{"velocity", 3, {}};
    for (Vec3d& p : s.points) {
      p = normalized(p) * radius;
      for (int k = 0; k < 3; ++k) velocity.values.push_back(float(field(p)[k]));
    }
    s.arrays = {velocity};
    write_surface(path(name), s);
    return path(name);
  }
  /// From the pole -z to the pole z: they attract and repel, each with the eigenvalue 1 there.
  std::string poles() {
    return sphere("poles.vtp", [](const Vec3d& p) { return Vec3d(0, 0, 1) - p * p.z; });
  }
};

TEST_F(FlowMaps, AreWrittenAndReported) {
  for (const std::string duration : {"1", "-1"}) {
    const Outcome done = nacre(Words{"flow", poles(), "--quiet", "--ftle-time=" + duration} + small_flow_maps +
                               Words{"--ftle-out", path("f.vtp"), "--report", path("r.json")});
    ASSERT_EQ(done.status, 0) << done.err;
    const json report = json::parse(content("r.json"));
    EXPECT_EQ(report["outputs"], json({path("f.vtp")}));
    EXPECT_EQ(report["flow_map"]["duration"], std::stod(duration));
    EXPECT_EQ(report["flow_map"]["left"], 0);
    EXPECT_EQ(report["flow_map"]["unknown"], 0);
    EXPECT_NEAR(report["flow_map"]["ftle"]["max"].get<double>(), 1, 0.03);
    EXPECT_NEAR(report["flow_map"]["ftle"]["min"].get<double>(), -1, 0.03);
    const Surface written = open_surface({path("f.vtp")}).load(0);
    const PointArray *ftle = written.find("FTLE"), *end = written.find("flow_map"), *time = written.find("ftle_time");
    ASSERT_TRUE(ftle && end && time);
    const double sign = std::stod(duration);
    for (std::size_t i = 0; i < written.points.size(); ++i) {
      // atanh z grows as time; meridians stay, so that the stretch is the ratio of the distances from the axis.
      const Vec3d& p = written.points[i];
      if (std::fabs(p.z) > 0.99) continue;
      const double z = std::tanh(std::atanh(p.z) + sign), stretch = std::sqrt((1 - z * z) / (1 - p.z * p.z));
      ASSERT_NEAR(end->values[3 * i + 2], z, 0.01);
      ASSERT_NEAR(ftle->values[i], std::log(stretch), 0.05) << p.z;
      ASSERT_EQ(time->values[i], 1);
    }
  }
}

TEST_F(FlowMaps, ColourPictures) {
  const Words words = Words{"flow", poles(), "--quiet", "--camera", "+x", "--ftle-time", "1"} + small_flow_maps;
  ASSERT_EQ(nacre(words + Words{"--colormap", "gray", "--color", "FTLE", "--image", path("f.png")}).status, 0);
  const Image image = read_png(path("f.png"));
  const auto brightness = [&](int middle) {  // of a patch above or below
    double sum = 0;
    for (int y = middle - 8; y < middle + 8; ++y)
      for (int x = 88; x < 104; ++x) sum += image.at(x, y)[1];
    return sum / 256;
  };
  EXPECT_GT(brightness(150), 1.5 * brightness(42)) << "the lower pole repels";
}

TEST_F(FlowMaps, OfASurfaceThatGrowsAreItsStretch) {
  const auto nothing = [](const Vec3d&) { return Vec3d(); };
  const Outcome done = nacre(Words{"flow", sphere("g_0.vtp", nothing), sphere("g_1.vtp", nothing, 2),
                                   sphere("g_2.vtp", nothing, 3), "--relative", "off", "--quiet"} +
                             small_flow_maps + Words{"--ftle-out", path("f.vtp"), "--report", path("r.json")});
  ASSERT_EQ(done.status, 0) << done.err;
  const json report = json::parse(content("r.json"));
  EXPECT_NEAR(report["flow_map"]["ftle"]["min"].get<double>(), std::log(3.0) / 2, 1e-4);
  EXPECT_NEAR(report["flow_map"]["ftle"]["max"].get<double>(), std::log(3.0) / 2, 1e-4);
}

TEST_F(FlowMaps, BadInputIsNamed) {
  const Words to_file = Words{"--quiet", "--ftle-out", path("f.vtp")} + small_flow_maps;
  expect_failure(nacre(Words{"flow", "--quiet", "--sample", "sphere", "--ftle-out", path("t.png")} + small_flow_maps),
                 2, {"--ftle-out", ".vtp"});
  expect_failure(nacre(Words{"flow", sphere("zero.vtp", [](const Vec3d&) { return Vec3d(); })} + to_file), 1,
                 {"velocity", "zero everywhere"});
  expect_failure(nacre(Words{"flow", poles(), "--ftle-time", "1e9"} + to_file), 1, {"--ftle-time", "too long"});
  const Words two = {"flow", sphere("s_0.vtp", [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); }),
                     sphere("s_1.vtp", [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); })};
  expect_failure(nacre(two + Words{"--ftle-time", "3"} + to_file), 1, {"--ftle-time 3", "beyond the data", "--period"});
  EXPECT_EQ(nacre(two + Words{"--ftle-time", "3", "--period", "2"} + to_file).status, 0);
  Surface other = make_sample("sphere", 24).load(0);
  other.arrays = {{"velocity", 3, std::vector<float>(3 * other.points.size(), 1)}};
  write_surface(path("o_1.vtp"), other);
  expect_failure(nacre(Words{"flow", poles(), path("o_1.vtp")} + to_file), 1, {"flow map", "same triangles"});
}

}  // namespace
}  // namespace nacre::test
