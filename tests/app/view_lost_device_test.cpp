// Nacre: a computing device that stops working while the viewer runs: the window goes on without it.
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

using View = ViewTest;

/// In a window, the fault being due when times are taken for the `when`-th time.
void expect_window_goes_on(const TemporaryFolder& folder, const Arguments& input, const std::string& when) {
  const std::string report = (folder / "r.json").string(), picture = (folder / "p.png").string();
  const Outcome window =
      run("/bin/bash", Arguments{source_file("tests/app/on_display.sh"), "/usr/bin/env",
                                 "NACRE_FAULTS=lost-device@" + when, program_path, "view", "--size", "320x240",
                                 "--frames-count", "12", "--report", report, "--image", picture} +
                           input);
  if (window.status == 77) GTEST_SKIP() << window.err;
  ASSERT_EQ(window.status, 0) << window.err;
  EXPECT_TRUE(contains(window.err, "stopped working")) << window.err;
  EXPECT_TRUE(contains(window.err, "illegal memory access")) << window.err;
  const nlohmann::json told = read_json(report);
  EXPECT_EQ(told.at("device").at("backend"), "cpu");
  EXPECT_GT(told.at("view").at("steps"), 0) << "computed after it";
  EXPECT_TRUE(fs::exists(picture));
}

TEST_F(View, AFlowGoesOnWithoutItsLostDevice) {
  const Arguments input = {"--sample", "sphere", "--detail", "24", "--resolution", "48", "--steps", "4"};
  for (const char* when : {"1", "2", "5"}) expect_window_goes_on(folder, input, when);
}

TEST_F(View, AMeshGoesOnWithoutItsLostDevice) {
  const Arguments input = {"--sample", "two-spheres", "--detail", "16", "--iterations", "10"};
  for (const char* when : {"1", "9"}) expect_window_goes_on(folder, input, when);
}

TEST_F(View, WithoutAWindowALostDeviceIsAnError) {
  for (const Arguments& input :
       {Arguments{"--sample", "sphere", "--detail", "24", "--resolution", "48", "--steps", "4"},
        Arguments{"--sample", "two-spheres", "--detail", "16", "--iterations", "10"}}) {
    const Outcome outcome =
        run("/usr/bin/env", Arguments{"NACRE_FAULTS=lost-device@4", program_path, "view", "--offscreen", "--quiet",
                                      "--image", (folder / "p.png").string(), "--frames-count", "3"} +
                                input);
    expect_failure(outcome, 1, {"illegal memory access"});
  }
}

}  // namespace
}  // namespace nacre::test
