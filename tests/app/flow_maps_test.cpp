// Nacre: flow maps, Lyapunov exponents and dye of `nacre flow`, as a user gets them.
#include <algorithm>
#include <cmath>

#include "engine/io/reader.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Arguments small_flow_maps = {"--resolution", "64", "--steps", "2", "--size", "192x192", "--no-legend"};

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
    const Outcome done = nacre(Arguments{"flow", poles(), "--quiet", "--ftle-time=" + duration} + small_flow_maps +
                               Arguments{"--ftle-out", path("f.vtp"), "--report", path("r.json")});
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
  const Arguments arguments =
      Arguments{"flow", poles(), "--quiet", "--camera", "+x", "--ftle-time", "1"} + small_flow_maps;
  ASSERT_EQ(nacre(arguments + Arguments{"--colormap", "gray", "--color", "FTLE", "--image", path("f.png")}).status, 0);
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
  const Outcome done = nacre(Arguments{"flow", sphere("g_0.vtp", nothing), sphere("g_1.vtp", nothing, 2),
                                       sphere("g_2.vtp", nothing, 3), "--relative", "off", "--quiet"} +
                             small_flow_maps + Arguments{"--ftle-out", path("f.vtp"), "--report", path("r.json")});
  ASSERT_EQ(done.status, 0) << done.err;
  const json report = json::parse(content("r.json"));
  EXPECT_NEAR(report["flow_map"]["ftle"]["min"].get<double>(), std::log(3.0) / 2, 1e-4);
  EXPECT_NEAR(report["flow_map"]["ftle"]["max"].get<double>(), std::log(3.0) / 2, 1e-4);
}

TEST_F(FlowMaps, BadInputIsNamed) {
  const Arguments to_file = Arguments{"--quiet", "--ftle-out", path("f.vtp")} + small_flow_maps;
  expect_failure(
      nacre(Arguments{"flow", "--quiet", "--sample", "sphere", "--ftle-out", path("t.png")} + small_flow_maps), 2,
      {"--ftle-out", ".vtp"});
  expect_failure(nacre(Arguments{"flow", sphere("zero.vtp", [](const Vec3d&) { return Vec3d(); })} + to_file), 1,
                 {"velocity", "zero everywhere"});
  expect_failure(nacre(Arguments{"flow", poles(), "--ftle-time", "1e9"} + to_file), 1, {"--ftle-time", "too long"});
  const Arguments two = {"flow", sphere("s_0.vtp", [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); }),
                         sphere("s_1.vtp", [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); })};
  expect_failure(nacre(two + Arguments{"--ftle-time", "3"} + to_file), 1,
                 {"--ftle-time 3", "beyond the data", "--period"});
  EXPECT_EQ(nacre(two + Arguments{"--ftle-time", "3", "--period", "2"} + to_file).status, 0);
  Surface other = make_sample("sphere", 24).load(0);
  other.arrays = {{"velocity", 3, std::vector<float>(3 * other.points.size(), 1)}};
  write_surface(path("o_1.vtp"), other);
  expect_failure(nacre(Arguments{"flow", poles(), path("o_1.vtp")} + to_file), 1, {"flow map", "same triangles"});
}

TEST_F(FlowMaps, DyeThatNothingMovesIsRefusedUnlessItDiffuses) {
  const Arguments run = Arguments{"flow",        sphere("still.vtp", [](const Vec3d&) { return Vec3d(); }),
                                  "--quiet",     "--dye",
                                  "0,0,1,0.3",   "--report",
                                  path("r.json")} +
                        small_flow_maps;
  const Outcome refused = nacre(run);
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("would stay where it is"), std::string::npos) << refused.err;
  for (const char* much : {"0.01", "1"}) {
    const Outcome done = nacre(run + Arguments{"--dye-diffusion", much});
    EXPECT_EQ(done.status, 0) << done.err;
  }
}

const Arguments few_dyed = {"--resolution", "64", "--size", "192x192", "--no-legend"};

class DyeOfFlow : public AppTest {
 protected:
  /// The unit sphere, turning about z by a radian in the data's unit of time; with an array that is 3 where x > 0.7.
  std::string turning(const std::string& name, double radius = 1) {
    Surface s = make_sample("sphere", 48).load(0);
    PointArray velocity{"velocity", 3, {}}, part{"part", 1, {}};
    for (Vec3d& p : s.points) {
      p = normalized(p);
      part.values.push_back(p.x > 0.7 ? 3.0f : 0.0f);
      p *= radius;
      for (const double each : {-p.y, p.x, 0.0}) velocity.values.push_back(float(each));
    }
    s.arrays = {velocity, part};
    write_surface(path(name), s);
    return path(name);
  }
  json dyes() { return json::parse(content("r.json"))["dye"]["dyes"]; }
  json dye_report() { return dyes()[0]; }
};

TEST_F(DyeOfFlow, IsReportedInMass) {
  const std::string sphere = turning("s.vtp");
  const Arguments run = Arguments{"flow", sphere, "--quiet", "--steps", "5", "--report", path("r.json")} + few_dyed;
  for (const std::string source :
       {"1,0,0,0.77", "1,0,0/1,0,0/1,0,0,0.77", "0.7,-2,-2:2,2,2", "part", "part=3", "1,0,0,0.4;part"}) {
    ASSERT_EQ(nacre(run + Arguments{"--dye", source}).status, 0) << source;
    const json dye = dye_report();
    ASSERT_EQ(dye["steps"].size(), 6u);
    const double begun = dye["steps"][0]["mass"].get<double>();
    EXPECT_NEAR(begun, 2 * 3.1416 * 0.3, 0.15) << source;
    EXPECT_NEAR(dye["steps"][5]["mass"].get<double>(), begun, 1e-9);
    EXPECT_EQ(dye["steps"][5]["left"], 0);
  }
  ASSERT_EQ(nacre(run + Arguments{"--dye", "1,0,0/0,1,0,0.3"}).status, 0);
  const double along_a_curve = dye_report()["steps"][0]["mass"].get<double>();
  ASSERT_EQ(nacre(run + Arguments{"--dye", "1,0,0,0.3"}).status, 0);
  EXPECT_GT(along_a_curve, 1.5 * dye_report()["steps"][0]["mass"].get<double>());
  ASSERT_EQ(nacre(run + Arguments{"--dye", "part", "--dye-release", "always"}).status, 0);
  const json dye = dye_report();
  EXPECT_GT(dye["steps"][5]["mass"].get<double>(), 1.01 * dye["steps"][0]["mass"].get<double>());
  EXPECT_NEAR(dye["steps"][5]["mass"].get<double>(), dye["steps"][5]["released"].get<double>(), 1e-9);
}

TEST_F(DyeOfFlow, IsOneOfSeveralWithRegionsAndATimeOfResidence) {
  const Arguments pair = {"flow", turning("t_0.vtp"), turning("t_1.vtp"), "--quiet", "--steps", "4"};
  const Arguments run = pair + few_dyed + Arguments{"--dye", "part | -1,0,0,0.5 ; 0,0,1,0.3", "--dye-regions", "part"};
  const Arguments seen = {"--camera", "+x", "--color", "none", "--report", path("r.json"), "--out", path("v.vtp")};
  ASSERT_EQ(nacre(run + seen + Arguments{"--image", path("both.png")}).status, 0);
  ASSERT_EQ(dyes().size(), 2u);
  EXPECT_EQ(dyes()[1]["sources"], "-1,0,0,0.5;0,0,1,0.3");
  EXPECT_NE(dyes()[0]["color"], dyes()[1]["color"]);
  const json first = dyes()[0]["steps"][0], last = dyes()[0]["steps"][4];
  EXPECT_EQ(first["regions"]["3"], first["mass"]) << "it begins in its region,";
  EXPECT_LT(last["regions"]["3"].get<double>(), 0.7 * first["mass"].get<double>()) << "and is carried out of it";
  EXPECT_NEAR(last["regions"]["3"].get<double>() + last["regions"]["0"].get<double>(), last["mass"].get<double>(),
              1e-9);
  EXPECT_NEAR(dyes()[0]["residence_time"].get<double>(), 1, 1e-9) << "nothing leaves in a time of 1";
  EXPECT_EQ(dyes()[0]["washout"], 0);
  const RawMesh values = read_raw(path("v.vtp")).mesh;
  std::vector<std::string> names;
  for (const RawArray& array : values.point_arrays) names.push_back(array.name);
  EXPECT_EQ(std::count(names.begin(), names.end(), "dye") + std::count(names.begin(), names.end(), "dye_2"), 2);
  ASSERT_EQ(nacre(pair + few_dyed + seen + Arguments{"--dye", "part", "--image", path("one.png")}).status, 0);
  const auto green = [&](const std::string& name) {
    const Image image = read_png(path(name));
    int count = 0;
    for (int i = 0; i < image.width * image.height; ++i) {
      const std::uint8_t* p = image.at(i % image.width, i / image.width);
      count += p[1] > p[0] + 30;
    }
    return count;
  };
  EXPECT_EQ(green("one.png"), 0);
  EXPECT_GT(green("both.png"), 50) << "the second dye has another colour";
}

TEST_F(DyeOfFlow, IsCarriedInTheTimeOfTheData) {
  const Arguments pair = {"flow", turning("t_0.vtp"), turning("t_1.vtp"), "--quiet", "--steps", "4", "--dye", "part"};
  ASSERT_EQ(nacre(pair + few_dyed + Arguments{"--out", path("v.vtp"), "--report", path("r.json")}).status, 0);
  EXPECT_EQ(dye_report()["steps"][4]["time"], 1);
  const RawMesh values = read_raw(path("v.vtp")).mesh;
  const auto dye = std::find_if(values.point_arrays.begin(), values.point_arrays.end(),
                                [](const RawArray& array) { return array.name == "dye"; });
  ASSERT_NE(dye, values.point_arrays.end());
  double whole = 0;
  Vec3d middle{};
  for (std::size_t i = 0; i < values.points.size(); ++i) {
    const Vec3d p = values.points[i];
    const double cells = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);  // as many as an area has, facing that way
    whole += dye->values[i];
    middle += p * (double(dye->values[i]) / cells);
  }
  EXPECT_GT(whole, 100);
  EXPECT_NEAR(std::atan2(middle.y, middle.x), 1, 0.02) << "it has turned by a radian";
}

TEST_F(DyeOfFlow, IsBlendedOverPictures) {
  const Arguments seen =
      Arguments{"flow", turning("s.vtp"), "--quiet", "--steps", "1", "--camera", "+x", "--color", "none"} + few_dyed;
  ASSERT_EQ(nacre(seen + Arguments{"--dye", "1,0,0,0.5", "--image", path("with.png")}).status, 0);
  ASSERT_EQ(nacre(seen + Arguments{"--dye", "-1,0,0,0.5", "--image", path("behind.png")}).status, 0);
  const auto red = [&](const std::string& name) {
    const Image image = read_png(path(name));
    int inside = 0, outside = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.at(x, y);
        if (p[0] > p[1] + 30) ++(std::hypot(x - 96, y - 96) < 70 ? inside : outside);
      }
    return std::array{inside, outside};
  };
  EXPECT_GT(red("with.png")[0], 2000);
  EXPECT_EQ(red("with.png")[1], 0);
  EXPECT_EQ(red("behind.png"), (std::array{0, 0}));
}

TEST_F(DyeOfFlow, StaysWithASurfaceThatGrows) {
  const Arguments growing = {"flow", turning("g_0.vtp"), turning("g_1.vtp", 1.5), "--quiet", "--steps", "3"};
  ASSERT_EQ(nacre(growing + few_dyed + Arguments{"--dye", "part=3", "--report", path("r.json")}).status, 0);
  const json steps = dye_report()["steps"];
  EXPECT_NEAR(steps[3]["mass"].get<double>(), steps[0]["mass"].get<double>(), 1e-9);
}

TEST_F(DyeOfFlow, BadInputIsNamed) {
  const std::string sphere = turning("s.vtp");
  const auto with = [&](const std::string& source) {
    return nacre(Arguments{"flow", sphere, "--quiet", "--steps", "1", "--image", path("a.png"), "--dye", source} +
                 few_dyed);
  };
  for (const std::string text : {"1,2,3", "0,0,0,-1", "0,0:1,1", "=2", "part=x", "0,0/1,0,0,1"})
    expect_failure(with(text), 2, {"--dye", text});
  expect_failure(with("part|part|part|part|part"), 2, {"--dye", "5 dyes"});
  expect_failure(with("9,0,0,1"), 1, {"--dye", "no point of the surface", "7 away"});
  expect_failure(with("part=4"), 1, {"--dye", "no point has such a value"});
  expect_failure(with("labels"), 1, {"--dye", "no array \"labels\""});
  expect_failure(nacre(Arguments{"flow", sphere, "--quiet", "--steps", "1", "--image", path("a.png"), "--dye", "part",
                                 "--dye-diffusion", "1e9"} +
                       few_dyed),
                 1, {"sub-steps", "--dye-diffusion"});
  expect_failure(nacre(Arguments{"flow", sphere, "--quiet", "--steps", "4", "--image", path("a.png"), "--dye", "part",
                                 "--chunk", "1/2"} +
                       few_dyed),
                 1, {"--chunk", "--dye"});
  Surface other = make_sample("sphere", 24).load(0);
  other.arrays = {{"velocity", 3, std::vector<float>(3 * other.points.size(), 1)}};
  write_surface(path("o_1.vtp"), other);
  expect_failure(nacre(Arguments{"flow", sphere, path("o_1.vtp"), "--quiet", "--steps", "1", "--image", path("a.png"),
                                 "--dye", "1,0,0,0.5"} +
                       few_dyed),
                 1, {"--dye", "same triangles"});
}

}  // namespace
}  // namespace nacre::test
