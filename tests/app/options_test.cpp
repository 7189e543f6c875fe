// Nacre: tests of the arguments of a command line, exit statuses, and who may write where.
#include <cctype>
#include <sstream>
#include <thread>

#include "engine/scene/settings/knobs.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

const std::vector<std::string> all_commands = {"flow", "mesh", "view", "sample", "bench", "info"};

class OptionsInFiles : public AppTest {};

/// Does the help begin a line with this option, alone or in a list such as "-h,--help"? `--color` is not in
/// `--colormap`.
bool offers(const std::string& help, const std::string& option) {
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; };
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == line.npos || line[begin] != '-') continue;
    const std::string names = line.substr(begin, line.find(' ', begin) - begin) + " ";
    for (std::size_t at = names.find(option); at != names.npos; at = names.find(option, at + 1))
      if ((at == 0 || !in_name(names[at - 1])) && !in_name(names[at + option.size()])) return true;
  }
  return false;
}

TEST(Arguments, HelpVersionAndKnobs) {
  const Outcome help = nacre({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const std::string& command : all_commands) EXPECT_EQ(lines_with(help.out, "  " + command + " "), 1) << command;
  EXPECT_EQ(help.err, "");

  const Outcome version = nacre({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.rfind("nacre ", 0), 0u) << version.out;

  for (const std::string& command : all_commands) EXPECT_EQ(nacre({command, "--version"}).out, version.out) << command;

  const Outcome knobs = nacre({"--knobs"});
  EXPECT_EQ(knobs.status, 0);
  for (const char* knob : {"resolution", "refine", "ttl", "steps", "step_cells", "seed", "colormap", "camera"})
    EXPECT_EQ(lines_with(knobs.out, std::string(knob) + " "), 1) << knob;
  EXPECT_TRUE(contains(knobs.out, "16..16384")) << "ranges are printed";
  const std::size_t defaults = knobs.out.find("default");
  std::istringstream lines(knobs.out);
  for (std::string line; std::getline(lines, line);) {
    ASSERT_GT(line.size(), defaults) << line;
    EXPECT_EQ(line[defaults - 1], ' ') << "columns are aligned: " << line;
  }
}

TEST(Arguments, HelpOfFlowHasEveryOptionOfTheContract) {
  const Outcome help = nacre({"flow", "--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* option :
       {"--vectors", "--method",     "--radius",    "--resolution", "--refine", "--ttl",    "--steps",
        "--time",    "--step-cells", "--color",     "--colormap",   "--image",  "--size",   "--camera",
        "--frames",  "--video",      "--no-legend", "--no-time",    "--out",    "--sample", "--device",
        "--threads", "--seed",       "--report",    "--quiet",      "--set",    "--session"})
    EXPECT_TRUE(offers(help.out, option)) << option;
}

TEST(Arguments, CommonOptionsAreThoseOfEveryCommand) {
  for (const std::string& command : all_commands) {
    const Outcome help = nacre({command, "--help"});
    EXPECT_EQ(help.status, 0);
    for (const char* option :
         {"--device", "--threads", "--seed", "--report", "--quiet", "--set", "--session", "--version", "--help"})
      EXPECT_TRUE(offers(help.out, option)) << command << " " << option;
    if (command == "view") continue;  // which a build may lack
    expect_failure(nacre({command, "--set", "rsolution=3"}), 2, {"did you mean resolution"});
    expect_failure(nacre({command, "--seed", "-1"}), 2, {"--seed"});
  }
}

TEST(Arguments, NoMoreThreadsThanProcessors) {
  const TemporaryFolder folder;
  const std::string file = (folder / "r.json").string();
  const Outcome run = nacre(small_flow + Arguments{"--device", "cpu", "--threads", "4096", "--report", file});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "") << "oneTBB complains where it is asked for more";
  EXPECT_LE(nlohmann::json::parse(read_all(file))["device"]["threads"],
            std::max(1u, std::thread::hardware_concurrency()));
}

TEST(Arguments, EveryKnobIsAnOptionOfTheViewer) {
  const std::string help = nacre({"view", "--help"}).out;
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    EXPECT_TRUE(contains(help, "  " + knob.option() + " ") || contains(help, "  " + knob.option() + ",")) << knob.name;
    for (const std::string& old : knob.old_options()) EXPECT_FALSE(contains(help, "  " + old + " ")) << old;
  }
  EXPECT_TRUE(contains(help, "  --edges,--no-edges "));
  EXPECT_TRUE(contains(help, "  --time-stamp,--no-time "));
}

TEST_F(OptionsInFiles, FlagsTurnKnobsOnAndOff) {
  const auto knobs_after = [&](const Arguments& arguments) {
    const Outcome run = nacre(small_flow + arguments + Arguments{"--report", path("r.json"), "--steps", "1"});
    EXPECT_EQ(run.status, 0) << run.err;
    return read_json("r.json").at("parameters");
  };
  EXPECT_EQ(knobs_after({"--neighbour-index"}).at("neighbour_index"), true);
  EXPECT_EQ(knobs_after({"--neighbour-index", "--no-neighbour-index"}).at("neighbour_index"), false);
  EXPECT_EQ(knobs_after({"--no-time-stamp"}).at("time_stamp"), false);
  EXPECT_EQ(knobs_after({"--set", "legend=false", "--no-time"}).at("legend"), false);
  EXPECT_EQ(knobs_after({"--crease", "20"}).at("crease_angle"), 20) << "an old name";
  EXPECT_EQ(knobs_after({"--set", "crease=30"}).at("crease_angle"), 30);
}

TEST(Arguments, CommonOptionsOfSampleAndInfo) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.vtp").string(), session = (folder / "s.json").string();
  const auto report = [&](const char* name) { return (folder / name).string(); };
  const Arguments common = {"--device", "cpu", "--threads", "1", "--seed", "3", "--quiet", "--set", "ttl=3"};
  std::ofstream(session) << R"({"nacre": "session 1", "sample": "sphere", "detail": 16})";
  const Outcome written =
      nacre(Arguments{"sample", "--session", session, "--out", file, "--report", report("a.json")} + common);
  ASSERT_EQ(written.status, 0) << written.err;
  EXPECT_EQ(written.out, file + "\n");
  EXPECT_EQ(written.err, "");
  const nlohmann::json sample = nlohmann::json::parse(read_all(report("a.json")));
  EXPECT_EQ(sample["command"], "sample");
  EXPECT_EQ(sample["input"], (nlohmann::json{{"sample", "sphere"}, {"detail", 16}}));
  EXPECT_EQ(sample["outputs"], nlohmann::json({file}));
  EXPECT_EQ(sample["device"]["threads"], 1);

  std::ofstream(session) << R"({"nacre": "session 1", "inputs": ["a.vtp"]})";
  const Outcome looked = nacre(Arguments{"info", "--session", session, "--report", report("b.json")} + common);
  ASSERT_EQ(looked.status, 0) << looked.err;
  EXPECT_EQ(looked.out, nacre({"info", file}).out);
  const nlohmann::json info = nlohmann::json::parse(read_all(report("b.json")));
  EXPECT_EQ(info["command"], "info");
  EXPECT_EQ(info["input"]["files"][0], nlohmann::json::parse(nacre({"info", "--json", file}).out));
  EXPECT_EQ(info["stages"][0]["name"], "read");

  expect_failure(nacre({"sample", "--session", session, "--out", file}), 2, {"has no sample"});
  expect_failure(nacre({"sample", "--out", file}), 2, {"name a sample"});
}

TEST(Arguments, PicturesThatNoFileCanHoldAreRefusedBeforeTheWork) {
  const TemporaryFolder folder;
  const Arguments large = {"--size", "16384x16384"};
  const std::string picture = (folder / "a.png").string(), limit = "268435455 pixels";
  for (const char* option : {"--image", "--frames"})
    expect_failure(nacre(small_flow + large + Arguments{option, picture}), 2, {limit});
  expect_failure(nacre(small_flow + large + Arguments{"--video", (folder / "a.mp4").string()}), 2,
                 {"268 million pixels"});
  expect_failure(nacre({"mesh", "--sample", "two-spheres", "--size", "16384x16384", "--image", picture}), 2, {limit});
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(Arguments, WrongOnesEndWithTwo) {
  expect_failure(nacre({"--nonsense"}), 2, {"--nonsense"});
  expect_failure(nacre({"flow"}), 2, {"--sample", "FILE"});
  expect_failure(nacre({"flow", "a.obj", "--sample", "sphere"}), 2, {"not both"});
  expect_failure(nacre({"info"}), 2, {"FILE"});
  expect_failure(nacre(small_flow + Arguments{"--rsolution", "3"}), 2, {"--rsolution"});
  expect_failure(nacre(small_flow + Arguments{"--ttl", "99"}), 2, {"--ttl 99", "1..16"});
  expect_failure(nacre(small_flow + Arguments{"--ttl", "two"}), 2, {"two"});
  expect_failure(nacre(small_flow + Arguments{"--set", "rsolution=3"}), 2, {"did you mean resolution"});
  expect_failure(nacre(small_flow + Arguments{"--set", "ttl"}), 2, {"KNOB=VALUE"});
  expect_failure(nacre(small_flow + Arguments{"--size", "12"}), 2, {"--size"});
  expect_failure(nacre(small_flow + Arguments{"--device", "abacus"}), 2, {"abacus"});
  expect_failure(nacre(small_flow + Arguments{"--method", "sponge"}), 2, {"sponge", "grid"});
  expect_failure(nacre(small_flow + Arguments{"--background", "greenish"}), 2, {"#rrggbb"});
  expect_failure(nacre(small_flow + Arguments{"--time", "2:1"}), 2, {"--time"});
  expect_failure(nacre({"sample", "sphere"}), 2, {"--out"});
  expect_failure(nacre({"sample", "sphere", "--detail", "-3", "--out", "a.vtp"}), 2, {"-3", "0 to 1048576"});
  expect_failure(nacre(small_flow + Arguments{"--image", "a.jpg"}), 2, {"--image", ".png", "a.jpg"});
  expect_failure(nacre(small_flow + Arguments{"--image", "/dev/null"}), 2, {"--image", ".png", "/dev/null"});
  expect_failure(nacre(small_flow + Arguments{"--out", "a.ply"}), 2, {"--out", ".vtp", "a.ply"});
  EXPECT_EQ(nacre({}).status, 2);
}

TEST(Arguments, UnknownNamesGetAListOrAGuess) {
  expect_failure(nacre({"flow", "--sample", "sphre"}), 2, {"did you mean 'sphere'", "torus"});
  expect_failure(nacre({"sample", "trian", "--out", "a.vtp"}), 2, {"did you mean 'train'"});
  expect_failure(nacre(small_flow + Arguments{"--colormap", "vridis"}), 2, {"vridis", "gray"});
  expect_failure(nacre(small_flow + Arguments{"--camera", "top"}), 2, {"top", "iso", "+x"});
  expect_failure(nacre(small_flow + Arguments{"--vectors", "@swrl"}), 2, {"@swirl", "@rotation"});
  // What a file holds is not known from the arguments: these are failures of the work.
  expect_failure(nacre(small_flow + Arguments{"--vectors", "vlocity"}), 1, {"vlocity", "velocity"});
  expect_failure(nacre(small_flow + Arguments{"--color", "pressure"}), 1, {"pressure", "velocity"});
}

TEST(Arguments, ASampleOfTheOtherKindSaysWhoTakesIt) {
  expect_failure(nacre({"flow", "--sample", "torso", "--quiet"}), 2, {"'torso' is a volume", "nacre mesh"});
  expect_failure(nacre({"mesh", "--sample", "torus", "--quiet"}), 2, {"'torus' is a surface", "nacre flow"});
  expect_failure(nacre({"mesh", "--sample", "trso", "--quiet"}), 2, {"did you mean 'torso'"});
}

TEST(Arguments, AFileMayFollowAKnob) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.vtp").string(), report = (folder / "r.json").string();
  ASSERT_EQ(nacre({"sample", "sphere", "--detail", "16", "--out", file}).status, 0);
  const Outcome run =
      nacre({"flow", "--set", "resolution=32", "--set", "steps=1", file, "--quiet", "--report", report});
  ASSERT_EQ(run.status, 0) << run.err;
  const nlohmann::json knobs = nlohmann::json::parse(read_all(report))["parameters"];
  EXPECT_EQ(knobs["resolution"], 32);
  EXPECT_EQ(knobs["steps"], 1);
}

TEST(Arguments, TheLastOfSeveralCounts) {
  const TemporaryFolder folder;
  const std::string report = (folder / "r.json").string();
  const Outcome run = nacre(small_flow + Arguments{"--steps", "1", "--ttl", "7", "--ttl", "3", "--report", report});
  ASSERT_EQ(run.status, 0) << run.err;
  const nlohmann::json knobs = nlohmann::json::parse(read_all(report))["parameters"];
  EXPECT_EQ(knobs["steps"], 1);
  EXPECT_EQ(knobs["ttl"], 3);
}

TEST(Arguments, WorkWhoseResultIsNotAskedForIsDoneAloud) {
  Arguments arguments = small_flow;
  std::erase(arguments, "--quiet");
  EXPECT_TRUE(contains(nacre(arguments).err, "nothing will be written"));
  const TemporaryFolder folder;
  const Outcome run = nacre(arguments + Arguments{"--image", (folder / "a.png").string(), "--size", "64x48"});
  EXPECT_FALSE(contains(run.err, "nothing will be written")) << run.err;
}

TEST(Arguments, NothingIsDoneBeforeTheyAreUnderstood) {
  const TemporaryFolder folder;
  const Arguments outputs = {"--image", (folder / "a.png").string(), "--frames", (folder / "f").string(),
                             "--video", (folder / "a.mp4").string()};
  expect_failure(nacre(small_flow + outputs + Arguments{"--colormap", "none"}), 2, {});
  expect_failure(nacre(small_flow + outputs + Arguments{"--camera", "none"}), 2, {});
  expect_failure(nacre(small_flow + outputs + Arguments{"--time", "7:8"}), 1, {"0:0.95"});
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(Arguments, ResultsGoToStdoutTheRestToStderr) {
  const TemporaryFolder folder;
  const std::string picture = (folder / "a.png").string(), values = (folder / "a.vtp").string();
  Arguments arguments = small_flow + Arguments{"--image", picture, "--out", values, "--size", "64x48"};
  const Outcome quiet = nacre(arguments);
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out, picture + "\n" + values + "\n");
  EXPECT_EQ(quiet.err, "");

  std::erase(arguments, "--quiet");
  const Outcome loud = nacre(arguments);
  EXPECT_EQ(loud.out, quiet.out);
  EXPECT_TRUE(contains(loud.err, "device: ")) << "auto says which device it took";
  EXPECT_TRUE(contains(loud.err, "vectors: velocity")) << "the choice of vectors is said aloud";
  EXPECT_FALSE(contains(loud.err, "\033")) << "no progress bar in a pipe";
}

TEST(Arguments, SampleListsAndWritesThem) {
  const Outcome list = nacre({"sample"});
  EXPECT_EQ(list.status, 0);
  for (const char* name : {"sphere", "torus", "train", "aircraft", "cylinder", "delta-wing"})
    EXPECT_EQ(lines_with(list.out, std::string(name) + " "), 1) << name;

  const TemporaryFolder folder;
  const std::string file = (folder / "a.vtp").string();
  const Outcome written = nacre({"sample", "sphere", "--detail", "16", "--out", file});
  EXPECT_EQ(written.out, file + "\n") << written.err;
  const Outcome info = nacre({"info", file});
  EXPECT_EQ(info.status, 0);
  EXPECT_TRUE(contains(info.out, "velocity")) << info.out;

  const std::string series = (folder / "A.PVD").string(), report = (folder / "r.json").string();
  const Outcome all = nacre({"sample", "sphere", "--detail", "16", "--out", series, "--report", report});
  ASSERT_EQ(all.status, 0) << all.err;
  const nlohmann::json outputs = nlohmann::json::parse(read_all(report)).at("outputs");
  EXPECT_GT(outputs.size(), 2u);
  EXPECT_EQ(outputs.back(), series);
  for (const nlohmann::json& each : outputs) EXPECT_TRUE(fs::exists(each.get<std::string>())) << each;
}

TEST(Arguments, WhatCannotBePrintedIsAFailure) {
  const Outcome full = run("/bin/bash", {"-c", "exec \"$0\" sample > /dev/full", program_path});
  expect_failure(full, 1, {"standard output", "No space left"});
}

TEST(Arguments, InfoAsJson) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.pvd").string();
  ASSERT_EQ(nacre({"sample", "torus", "--detail", "32", "--out", file}).status, 0);
  const Outcome info = nacre({"info", "--json", file});
  const nlohmann::json json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json["kind"], "series");
  EXPECT_GT(json["times"].size(), 1u);
  EXPECT_GT(json["triangles"], 100);
  EXPECT_EQ(json["arrays"][0]["name"], "velocity");
  EXPECT_EQ(json["arrays"][0]["components"], 3);
}

}  // namespace
}  // namespace nacre::test
