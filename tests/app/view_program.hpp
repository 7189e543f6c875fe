// Nacre: runs of `nacre view`.
#pragma once

#include "tests/app/program.hpp"

namespace nacre::test {

/// Why the viewer cannot run here; empty: it can.
inline std::string no_viewer() {
  static const std::string why = [] {
    const Outcome tried = nacre({"view", "--offscreen", "--sample", "sphere", "--detail", "24", "--resolution", "32",
                                 "--frames-count", "1", "--quiet"});
    return tried.status == 1 && (contains(tried.err, "no viewer") || contains(tried.err, "no OpenGL")) ? tried.err : "";
  }();
  return why;
}

/// `nacre view` in a window, on a display of its own, begun by a shell in which `first` has been done. Status 77: there
/// is no Xvfb.
inline Outcome in_window(const Arguments& arguments, const std::string& first = ":") {
  return run("/bin/bash", Arguments{source_file("tests/app/on_display.sh"), "/bin/bash", "-c",
                                    first + "; exec \"$0\" view --quiet \"$@\"", program_path} +
                              arguments);
}

inline nlohmann::json read_json(const fs::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

class ViewTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!no_viewer().empty()) GTEST_SKIP() << no_viewer();
  }
  TemporaryFolder folder;
};

using LongUserAtTheWindow = ViewTest;
using UserAtTheWindow = ViewTest;  ///< who acts at their own pace: little else runs beside these tests

}  // namespace nacre::test
