// Nacre: another input is read beside the scene that is shown; what cannot be read leaves it as it was.
#include "engine/io/surface_writer.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

TEST_F(LongUserAtTheWindow, WhatCannotBeOpenedLeavesAllAsItWas) {
  const fs::path whole = folder / "whole.vtp", damaged = folder / "damaged.vtp", done = folder / "done.json";
  write_surface(whole, make_sample("torus", 24).load(0));
  fs::copy_file(whole, damaged);
  fs::resize_file(damaged, fs::file_size(whole) / 2);
  const Outcome window = run("/bin/bash", {source_file("tests/app/view_beside.sh"), program_path, damaged.string(),
                                           whole.string(), done.string()});
  if (window.status == 77) GTEST_SKIP() << window.err;
  ASSERT_EQ(window.status, 0) << window.err;
  EXPECT_TRUE(contains(window.err, "damaged.vtp was not opened: ")) << window.err;
  const nlohmann::json recorded = read_json(done);
  EXPECT_EQ(recorded.at("sample"), "sphere");
  EXPECT_FALSE(contains(recorded.dump(), "damaged.vtp")) << "it has never been the session's";
  EXPECT_TRUE(contains(recorded.dump(), "whole.vtp"));
}

}  // namespace
}  // namespace nacre::test
