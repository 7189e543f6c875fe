// Nacre: tests of the JSON report and of session files.
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

/// The names in the first column of `nacre --knobs`.
std::vector<std::string> knob_names() {
  std::istringstream table(nacre({"--knobs"}).out);
  std::vector<std::string> names;
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) names.push_back(line.substr(0, line.find(' ')));
  return names;
}

class Report : public AppTest {};

TEST_F(Report, HasEveryKeyOfTheContract) {
  const Outcome run =
      nacre(small_flow + Arguments{"--threads", "2", "--seed", "7", "--report", path("r.json"), "--image",
                                   path("a.png"), "--size", "64x48", "--out", path("a.vtp")});
  ASSERT_EQ(run.status, 0) << run.err;
  const json r = json::parse(content("r.json"));
  EXPECT_TRUE(r["nacre"].is_string());
  EXPECT_EQ(r["command"], "flow");
  EXPECT_TRUE(r["device"]["backend"] == "cpu" || r["device"]["backend"] == "cuda");
  EXPECT_TRUE(r["device"]["name"].is_string());
  EXPECT_TRUE(r["device"]["threads"].is_number_integer());
  EXPECT_EQ(r["input"]["name"], "sphere");
  EXPECT_EQ(r["input"]["vectors"], "velocity");
  EXPECT_GT(r["memory"]["peak_bytes"], 1 << 20);
  EXPECT_GT(r["memory"]["device_peak_bytes"], 1 << 20);
  EXPECT_EQ(r["outputs"], json({path("a.png"), path("a.vtp")}));

  const json& e = r["embedding"];
  EXPECT_EQ(e["kind"], "grid");
  EXPECT_EQ(e["dimensions"].size(), 3u);
  EXPECT_EQ(*std::max_element(e["dimensions"].begin(), e["dimensions"].end()), 64);
  for (const char* key : {"cells", "surface_cells", "bytes", "dense_bytes"}) EXPECT_GT(e[key], 0) << key;
  EXPECT_GT(e["cells"], e["surface_cells"]) << "stored cells include those beside the surface";
  EXPECT_NEAR(double(e["sparseness_percent"]), 100 * (1 - double(e["bytes"]) / double(e["dense_bytes"])), 1e-9);

  EXPECT_EQ(r["flow"]["steps"], 2);
  const json& s = r["flow"]["seconds_per_step"];
  EXPECT_GT(s["min"], 0.0);
  EXPECT_LE(s["min"], s["median"]);
  EXPECT_LE(s["median"], s["max"]);
}

TEST_F(Report, StageNamesAreTheFixedOnes) {
  ASSERT_EQ(
      nacre(small_flow + Arguments{"--report", path("r.json"), "--image", path("a.png"), "--size", "64x48"}).status, 0);
  const json stages = json::parse(content("r.json"))["stages"];
  std::vector<std::string> names;
  for (const json& stage : stages) {
    names.push_back(stage["name"]);
    EXPECT_GE(stage["seconds"], 0.0);
    EXPECT_GE(stage["calls"], 1);
    EXPECT_EQ(stage["launches"] > 0, stage["name"] != "read" && stage["name"] != "write") << stage["name"];
  }
  for (const char* name : {"read", "embed", "refine", "advect", "deposit", "filter", "render", "write"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST_F(Report, ParametersAreTheKnobsAsSet) {
  ASSERT_EQ(nacre(small_flow + Arguments{"--report", path("r.json"), "--seed", "7", "--set", "step_cells=3.5", "--ttl",
                                         "2", "--no-legend", "--colormap", "gray"})
                .status,
            0);
  const json parameters = json::parse(content("r.json"))["parameters"];
  const std::vector<std::string> knobs = knob_names();
  EXPECT_GT(knobs.size(), 20u);
  for (const std::string& name : knobs) EXPECT_TRUE(parameters.contains(name)) << name;
  EXPECT_EQ(parameters.size(), knobs.size());
  EXPECT_EQ(parameters["seed"], 7);
  EXPECT_EQ(parameters["step_cells"], 3.5);
  EXPECT_EQ(parameters["ttl"], 2);
  EXPECT_EQ(parameters["resolution"], 64);
  EXPECT_EQ(parameters["legend"], false);
  EXPECT_EQ(parameters["colormap"], "gray");
}

class SessionFile : public AppTest {};

TEST_F(SessionFile, RoundTripGivesTheSameBytes) {
  ASSERT_EQ(nacre({"sample", "sphere", "--detail", "16", "--out", path("s.pvd")}).status, 0);
  const auto outputs = [&](const std::string& name) {
    return Arguments{"--quiet", "--out", path(name + ".vtp"), "--image", path(name + ".png")};
  };
  const Arguments flow = {
      "flow",   path("s.pvd"), "--resolution", "48",    "--steps",  "2",  "--seed",         "11",
      "--size", "96x72",       "--set",        "ttl=2", "--camera", "+x", "--save-session", path("session.json")};
  ASSERT_EQ(nacre(flow + outputs("a")).status, 0);
  const Outcome again = nacre(Arguments{"flow", "--session", path("session.json")} + outputs("b"));
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(content("a.vtp"), content("b.vtp"));
  EXPECT_EQ(content("a.png"), content("b.png"));
  ASSERT_EQ(nacre(Arguments{"flow", "--session", path("session.json"), "--seed", "12"} + outputs("c")).status, 0);
  EXPECT_NE(bare("a.vtp"), bare("c.vtp")) << "arguments on the command line go over the session's";
}

TEST_F(SessionFile, BadOnesAreNamed) {
  const auto with = [&](const std::string& file) { return nacre({"flow", "--quiet", "--session", file}); };
  expect_failure(with(path("none.json")), 1, {"none.json"});
  expect_failure(with(write("text.json", "no json")), 1, {"text.json"});
  expect_failure(with(write("list.json", "[1]")), 1, {"list.json"});
  expect_failure(with(write("knob.json", R"({"sample":"sphere","knobs":{"rsolution":3}})")), 1, {"resolution"});
  expect_failure(with(write("range.json", R"({"sample":"sphere","knobs":{"ttl":999}})")), 1, {"ttl", "1..16"});
  expect_failure(with(write("type.json", R"({"sample":5})")), 1, {"type.json"});
  expect_failure(with(write("knobs.json", R"({"sample":"sphere","knobs":7})")), 1, {"knobs"});
}

}  // namespace
}  // namespace nacre::test
