// Nacre: the bar that is drawn on a terminal: what it tells, and that it stays in one line.
#include "engine/system/child_process.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

/// What a run of the program draws on a terminal of so many columns, one string for each time that it is drawn.
Arguments drawn(int columns, const std::string& arguments) {
  const std::string command = "stty cols " + std::to_string(columns) + "; '" + program_path + "' " + arguments;
  const Outcome run = test::run("/usr/bin/script", {"-qec", command, "/dev/null"});
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  const std::string begin = "\r\033[K";
  Arguments lines;
  for (std::size_t at = run.out.find(begin), next; at != run.out.npos; at = next) {
    next = run.out.find(begin, at + begin.size());
    lines.push_back(run.out.substr(at + begin.size(), next - at - begin.size()));
  }
  return lines;
}

TEST(Progress, ABarTellsStageIterationEnergyAndTimeInOneLine) {
  if (find_program("script").empty()) GTEST_SKIP() << "no program `script` to make a terminal";
  const Outcome terminal = run("/usr/bin/script", {"-qec", "true", "/dev/null"});
  if (terminal.status != 0) GTEST_SKIP() << "no pseudo-terminals here: " << terminal.out << terminal.err;
  for (const int columns : {40, 80, 160}) {
    int told = 0;
    Arguments lines = drawn(columns, "mesh --sample torso --detail 40 --threads 1");
    ASSERT_GT(lines.size(), 3u);
    lines.pop_back();  // what the program says when the bar is gone
    for (const std::string& line : lines) {
      EXPECT_LT(line.size(), std::size_t(columns)) << line;
      told += contains(line, "relax ") && contains(line, " particles, energy 0.") &&
              (columns < 80 || (contains(line, "[#") && contains(line, " s left")));
    }
    EXPECT_GT(told, columns < 80 ? 0 : 2) << columns;
  }
}

}  // namespace
}  // namespace nacre::test
