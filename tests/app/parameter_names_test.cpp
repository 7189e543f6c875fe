// Nacre: errors of the numerics name parameters, which the program prints as its options.
#include "app/parameter_names.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "engine/scene/settings/knobs.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

TEST(ParameterNames, AreOptionsOnTheCommandLineAndKnobsInThePanel) {
  const std::string text = "too fine; lower `resolution`, or raise `min_size` and `mesh_subcells`";
  EXPECT_EQ(with_options(text), "too fine; lower --resolution, or raise --min-size and --mesh-subcells");
  EXPECT_EQ(with_knobs(text), "too fine; lower resolution, or raise min_size and mesh_subcells");
}

TEST(ParameterNames, OtherQuotesStay) {
  for (const char* text : {"", "`", "``", "`nacre --knobs` lists them", "a `half", "`Upper`", "many particles"}) {
    EXPECT_EQ(with_options(text), text);
    EXPECT_EQ(with_knobs(text), text);
  }
  EXPECT_EQ(with_options("`a` `b c` `d_e`"), "--a `b c` --d-e");
}

/// What compute names in its errors are knobs, or options that all commands have; and it writes no dashes itself.
TEST(ParameterNames, TheNumericsNameKnobsWithoutDashes) {
  Settings settings;
  std::set<std::string> known{"device", "threads"};
  for (const Knob& knob : knobs(settings)) known.insert(knob.name);
  const std::regex literal(R"("(?:[^"\\\n]|\\.)*")"), name("`([a-z0-9_]+)`"), dashes("--[a-z]");
  int named = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_file("compute"))) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (line.find("//") != line.npos) line.erase(line.find("//"));
      for (std::sregex_iterator text(line.begin(), line.end(), literal), end; text != end; ++text) {
        const std::string arguments = text->str();
        EXPECT_FALSE(std::regex_search(arguments, dashes)) << entry.path() << ": " << arguments;
        for (std::sregex_iterator each(arguments.begin(), arguments.end(), name); each != end; ++each, ++named)
          EXPECT_TRUE(known.contains((*each)[1])) << entry.path() << ": " << arguments;
      }
    }
  }
  EXPECT_GT(named, 20);
}

TEST(ParameterNames, TheProgramPrintsOptions) {
  const Outcome run = nacre({"flow", "--sample", "sphere", "--resolution", "1000000", "--device", "cpu", "--image",
                             (std::filesystem::temp_directory_path() / "unused.png").string()});
  expect_failure(run, 1, {"--resolution 1000000 is too fine", "use --resolution"});
  EXPECT_FALSE(contains(run.err, "`")) << run.err;
}

}  // namespace
}  // namespace nacre::test
