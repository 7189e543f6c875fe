// Nacre: the program run as a child, as other people's scripts run it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/scene/surface/surface.hpp"
#include "engine/system/child_process.hpp"
#include "tests/engine/io/temporary_folder.hpp"
#include "tests/paths.hpp"

namespace nacre::test {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

struct Outcome {
  int status = -1;  ///< exit status; 128 + the signal where one ended it; -1 where it was killed for its time
  std::string out, err;
};

inline Outcome run(const fs::path& program, const Arguments& arguments) {
  const ChildResult result = run_child(program, arguments, std::chrono::seconds(480));
  const int status = result.timed_out ? -1 : result.signal != 0 ? 128 + result.signal : result.exit_status;
  return {status, result.output, result.errors};
}

inline Outcome nacre(const Arguments& arguments) { return run(program_path, arguments); }

/// The program under a limit of the shell: `ulimit` takes e.g. "-f 16" (KiB blocks of 1024 in bash).
inline Outcome nacre_limited(const std::string& ulimit, Arguments arguments) {
  arguments.insert(arguments.begin(), {"-c", "ulimit " + ulimit + " && exec \"$0\" \"$@\"", program_path});
  return run("/bin/bash", arguments);
}

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A run of a second at most: a coarse sphere, few cells, two steps.
inline const Arguments small_flow = {"flow",         "--sample", "sphere",  "--detail", "24",
                                     "--resolution", "64",       "--steps", "2",        "--quiet"};

/// A .vtp or .png without what it says of how it was made, to compare the results of two command lines.
inline std::string without_origin(std::string bytes) {
  if (const std::size_t comment = bytes.find("<!-- {\"Nacre origin\""); comment != bytes.npos)
    bytes.erase(comment, bytes.find("-->\n", comment) + 4 - comment);
  if (const std::size_t chunk = bytes.find("tEXtSource"); chunk != bytes.npos) {
    std::size_t length = 0;
    for (std::size_t i = 4; i > 0; --i) length = length << 8 | static_cast<unsigned char>(bytes[chunk - i]);
    bytes.erase(chunk - 4, length + 12);
  }
  return bytes;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

/// Lines of `text` that begin with `start`.
inline int lines_with(const std::string& text, const std::string& start) {
  int count = 0;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    count += text.compare(at, start.size(), start) == 0;
    if (text.find('\n', at) == text.npos) break;
  }
  return count;
}

/// One line "nacre: ..." that holds each of `parts`, this status, and no result.
inline void expect_failure(const Outcome& run, int status, const Arguments& parts) {
  EXPECT_EQ(run.status, status) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(lines_with(run.err, "nacre: "), 1) << run.err;
  for (const std::string& part : parts) EXPECT_TRUE(contains(run.err, part)) << part << "\n" << run.err;
}

class AppTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  bool exists(const std::string& name) const { return fs::exists(folder_ / name); }
  std::string content(const std::string& name) const { return read_all(folder_ / name); }
  std::string bare(const std::string& name) const { return without_origin(content(name)); }
  nlohmann::json read_json(const std::string& name) const { return nlohmann::json::parse(content(name)); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return path(name);
  }

  /// Names in the folder, sorted: to see that nothing else is left behind.
  Arguments names() const {
    Arguments found;
    for (const auto& entry : fs::directory_iterator(folder_.path())) found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }

  TemporaryFolder folder_;
};

}  // namespace nacre::test
