// Nacre: tests of too little memory, of disks that are full or may not be written, and of Ctrl-C.
#include <csignal>
#include <filesystem>
#include <thread>

#include "engine/picture/png.hpp"
#include "tests/app/program.hpp"
#include "tests/engine/picture/small_disk.hpp"

namespace nacre::test {
namespace {

using Clock = std::chrono::steady_clock;

class Limits : public AppTest {};

/// The number after "use --resolution ".
std::string advised_resolution(const std::string& line) {
  const std::string advice = "use --resolution ";
  const std::size_t at = line.find(advice);
  if (at == line.npos) return "";
  const std::size_t begin = at + advice.size();
  return line.substr(begin, line.find_first_not_of("0123456789", begin) - begin);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Limits, WhatDoesNotFitInMemoryIsNamedWithWhatDoes) {
  const std::string limit = "-v 600000";  // KiB of address space
  const Arguments arguments = {"flow", "--sample", "sphere", "--detail", "24",     "--steps", "1",       "--ttl",
                               "1",    "--warmup", "0",      "--quiet",  "--size", "64x48",   "--image", path("a.png")};
  for (const Arguments& method :
       {Arguments{}, Arguments{"--method", "octree"}, Arguments{"--method", "octree", "--octree", "source"}}) {
    const Outcome refused = nacre_limited(limit, arguments + method + Arguments{"--resolution", "4000"});
    expect_failure(refused, 1, {"--resolution 4000", "GiB"});
    EXPECT_EQ(names(), Arguments{});
    const std::string fits = advised_resolution(refused.err);
    ASSERT_NE(fits, "") << refused.err;
    EXPECT_GE(std::stoi(fits), 64);
    const Outcome run = nacre_limited(limit, arguments + method + Arguments{"--resolution", fits});
    EXPECT_EQ(run.status, 0) << fits << ": " << run.err;
    EXPECT_EQ(names(), Arguments{"a.png"});
    std::filesystem::remove(path("a.png"));
  }
}

TEST_F(Limits, TrianglesThatFitAtNoResolutionAreSaidToBeTooMany) {
  const Outcome run =
      nacre_limited("-v 600000", {"flow", "--sample", "sphere", "--detail", "200", "--method", "octree", "--resolution",
                                  "64", "--steps", "1", "--quiet", "--image", path("a.png")});
  expect_failure(run, 1, {"--resolution 64", "GiB", "fewer triangles"});
}
#endif

TEST_F(Limits, OutputsThatCannotBeWritten) {
  write("file", "x");
  for (const Arguments& output : {Arguments{"--image", path("none/a.png")},
                                  {"--out", path("none/a.vtp")},
                                  {"--report", path("none/r.json")},
                                  {"--video", path("none/a.mp4")},
                                  {"--frames", path("file/f")},
                                  {"--image", folder_.path().string()},
                                  {"--save-session", path("none/s.json")}})
    expect_failure(nacre(small_flow + output), 1, {output[1]});
  // Found out before the data are read, which would fail for another reason.
  for (const Arguments& output : {Arguments{"--image", path("none/a.png")},
                                  {"--out", path("none/a.vtp")},
                                  {"--report", path("none/r.json")},
                                  {"--video", path("none/a.mp4")},
                                  {"--frames", path("file/f")},
                                  {"--save-session", path("none/s.json")}})
    expect_failure(nacre(small_flow + output + Arguments{"--color", "pressure"}), 1, {output[1]});
  expect_failure(nacre(small_flow + Arguments{"--frames", path("f"), "--color", "pressure"}), 1, {"pressure"});
  expect_failure(nacre(small_flow + Arguments{"--video", path("a.txt")}), 2, {"a.txt", ".mp4"});
  expect_failure(nacre({"sample", "sphere", "--detail", "16", "--out", path("a.xyz")}), 2, {"a.xyz"});
  expect_failure(nacre({"sample", "head", "--out", path("a.nii")}), 2, {"a.nii", ".nrrd"});
  EXPECT_EQ(names(), Arguments{"file"});
}

TEST_F(Limits, AFileSizeLimitLeavesNothingBehind) {
  write("old.vtp", "an older result");
  for (const Arguments& output : {Arguments{"--out", path("old.vtp")}, {"--image", path("a.png"), "--size", "640x480"}})
    expect_failure(nacre_limited("-f 64", small_flow + output), 1, {output[1], "File too large"});
  EXPECT_EQ(names(), Arguments{"old.vtp"});
  EXPECT_EQ(content("old.vtp"), "an older result");
}

TEST_F(Limits, AFullDiskLeavesNothingBehind) {
  expect_failure(nacre(small_flow + Arguments{"--out", "/dev/full"}), 1, {"/dev/full", "No space left"});
  fs::create_directory(path("disk"));
  const SmallDisk disk(path("disk"), 64 << 10);
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small disk";
  expect_failure(nacre(small_flow + Arguments{"--out", path("disk/a.vtp")}), 1, {"a.vtp", "No space left"});
  EXPECT_TRUE(fs::is_empty(path("disk")));
}

/// What the program does when it gets `signal` after `seconds`, and how long it takes from there.
struct Stopped {
  Outcome run;
  double seconds_after = 0;
};

Stopped interrupt(const Arguments& arguments, double seconds) {
  const auto before = Clock::now();
  const Outcome result = run("/usr/bin/timeout", Arguments{"--foreground", "--preserve-status", "-s", "INT", "-k", "30",
                                                           std::to_string(seconds), program_path} +
                                                     arguments);
  return {result, std::chrono::duration<double>(Clock::now() - before).count() - seconds};
}

class CtrlC : public AppTest, public ::testing::WithParamInterface<double> {
 protected:
  /// Minutes of work, in which every kind of output is open.
  Arguments long_run() const {
    Arguments arguments = {"flow",    "--sample",    "sphere", "--detail",    "64",       "--resolution",
                           "1500",    "--steps",     "1000",   "--size",      "160x120",  "--quiet",
                           "--image", path("a.png"), "--out",  path("a.vtp"), "--report", path("r.json")};
    if (!find_program("ffmpeg").empty()) arguments = arguments + Arguments{"--video", path("a.mp4")};
    return arguments;
  }
};

TEST_P(CtrlC, StopsWithinTwoSecondsAndLeavesNothing) {
  const Stopped stopped = interrupt(long_run(), GetParam());
  EXPECT_EQ(stopped.run.status, 130) << stopped.run.err;
  EXPECT_LT(stopped.seconds_after, 2);
  EXPECT_EQ(stopped.run.out, "");
  EXPECT_EQ(names(), Arguments{});
}

INSTANTIATE_TEST_SUITE_P(After, CtrlC, ::testing::Values(0.3, 1.5, 4.0));

TEST_F(CtrlC, ASecondOneLeavesNothingEither) {
  // Both come before the work looks up; two of one kind might be delivered as one.
  const std::string script = R"("$0" "$@" & sleep 2; kill -INT $!; kill -TERM $!; wait $!)";
  for (int k = 0; k < 3; ++k) {
    const Outcome stopped = run("/bin/bash", Arguments{"-c", script, program_path} + long_run());
    EXPECT_TRUE(stopped.status == 130 || stopped.status == 143) << stopped.status << stopped.err;
    EXPECT_EQ(names(), Arguments{});
  }
}

TEST_F(CtrlC, FramesWrittenSoFarAreWhole) {
  const Stopped stopped = interrupt({"flow", "--sample", "sphere", "--detail", "24", "--resolution", "64", "--steps",
                                     "100000", "--size", "96x72", "--quiet", "--frames", path("f")},
                                    2.5);
  EXPECT_EQ(stopped.run.status, 130) << stopped.run.err;
  EXPECT_LT(stopped.seconds_after, 2);
  for (const auto& entry : fs::directory_iterator(path("f"))) {
    EXPECT_EQ(entry.path().extension(), ".png");
    EXPECT_EQ(read_png(entry.path()).width, 96) << entry.path();
  }
}

}  // namespace
}  // namespace nacre::test
