// Nacre: parts of the viewer that need no picture: what is taken back, what was opened last, where the picture lies.
#include <gtest/gtest.h>

#include <fstream>

#include "app/viewer/camera_control.hpp"
#include "app/viewer/recent_files.hpp"
#include "app/viewer/session_clock.hpp"
#include "app/viewer/undo.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

Session with_ttl(int ttl) {
  Session session;
  session.settings.flow.ttl = ttl;
  return session;
}

TEST(Undo, TakesChangesBackAndMakesThemAgain) {
  Undo undo;
  Session now = with_ttl(4);
  undo.note(now, false);
  EXPECT_FALSE(undo.can_undo());
  now.settings.flow.ttl = 5;
  undo.note(now, false);
  now.settings.flow.ttl = 6;
  undo.note(now, false);
  undo.undo(now);
  EXPECT_EQ(now.settings.flow.ttl, 5);
  undo.note(now, false);
  undo.undo(now);
  EXPECT_EQ(now.settings.flow.ttl, 4);
  EXPECT_FALSE(undo.can_undo());
  undo.redo(now);
  undo.redo(now);
  EXPECT_EQ(now.settings.flow.ttl, 6);
  EXPECT_FALSE(undo.can_redo());
}

TEST(Undo, OneStepForAllThatASliderDoes) {
  Undo undo;
  Session now = with_ttl(4);
  undo.note(now, false);
  for (int ttl = 5; ttl < 9; ++ttl) now.settings.flow.ttl = ttl, undo.note(now, true);
  undo.note(now, false);
  undo.undo(now);
  EXPECT_EQ(now.settings.flow.ttl, 4);
}

TEST(Undo, AnotherChangeForgetsWhatWasTakenBack) {
  Undo undo;
  Session now = with_ttl(4);
  undo.note(now, false);
  now.settings.flow.ttl = 5;
  undo.note(now, false);
  undo.undo(now);
  now.settings.flow.ttl = 7;
  undo.note(now, false);
  EXPECT_FALSE(undo.can_redo());
}

TEST(Undo, CamerasStayUnlessTheInputChanges) {
  Undo undo;
  Session now = with_ttl(4);
  now.sample = "torus";
  now.camera = Camera();
  undo.note(now, false);
  now.settings.flow.ttl = 5;
  undo.note(now, false);
  now.camera->eye = {5, 5, 5};
  undo.note(now, false);
  undo.undo(now);
  EXPECT_EQ(now.settings.flow.ttl, 4);
  EXPECT_EQ(now.camera->eye.x, 5);
  now.sample = "sphere";
  now.camera.reset();
  undo.note(now, false);
  undo.undo(now);
  EXPECT_EQ(now.sample, "torus");
  EXPECT_TRUE(now.camera);
}

TEST(Undo, WhatTheWindowDoesItselfIsNoChange) {
  Undo undo;
  Session now = with_ttl(4);
  undo.note(now, false);
  now.settings.width = 300;
  now.settings.look.play = false;
  now.settings.look.tab = "knobs";
  undo.note(now, false);
  EXPECT_FALSE(undo.can_undo());
}

TEST(RecentFiles, TheLatestFirstAndKept) {
  TemporaryFolder folder;
  std::vector<fs::path> files;
  for (int k = 0; k < 12; ++k) std::ofstream(files.emplace_back(folder / ("f" + std::to_string(k)))) << k;
  const fs::path list = folder / "state" / "recent";
  RecentFiles recent(list);
  EXPECT_TRUE(recent.files().empty());
  for (const fs::path& file : files) recent.add(file);
  recent.add(files[5]);
  const RecentFiles again(list);
  ASSERT_EQ(again.files().size(), 10u);
  EXPECT_EQ(again.files()[0], files[5]);
  EXPECT_EQ(again.files()[1], files[11]);
  EXPECT_EQ(again.files(), recent.files());
  fs::remove(files[11]);
  EXPECT_EQ(RecentFiles(list).files()[1], files[10]);
}

TEST(RecentFiles, AFolderThatCannotBeWrittenIsNoMatter) {
  RecentFiles recent(fs::path("/proc/nowhere/recent"));
  recent.add("/etc/hostname");
  EXPECT_EQ(recent.files().size(), 1u);
}

TEST(SessionClock, AVideoRunsOnFromWhereTheWindowWas) {
  SessionClock clock(10);
  clock.add_seconds(0.7, 25);
  clock.set_fps(5);
  EXPECT_DOUBLE_EQ(clock.seconds(), 0.7);
  clock.add_frame();
  clock.add_frame();
  EXPECT_DOUBLE_EQ(clock.seconds(), 1.1);
}

/// What an orbit turns by.
TEST(SessionClock, FramesOfAVideoPassAsFastInAWindowWhateverItsRate) {
  for (const double frame : {0.005, 0.04, 0.5}) {
    SessionClock clock(25);
    double frames = 0;
    while (clock.seconds() < 2 - 1e-9) frames += clock.add_seconds(frame, 25);
    EXPECT_NEAR(frames, 50, 1e-6) << frame;
  }
  SessionClock clock(25);
  double frames = 0;
  while (clock.seconds() < 2 - 1e-9) frames += clock.add_frame();
  EXPECT_EQ(frames, 50);
}

TEST(FreeArea, PlacesRunFromTheLeftLowerCorner) {
  const FreeArea area{100, 20, 400, 200};
  EXPECT_EQ(place_in(area, 100, 220), (std::array<double, 2>{-1, -1}));
  EXPECT_EQ(place_in(area, 300, 120), (std::array<double, 2>{0, 0}));
  EXPECT_EQ(place_in(area, 500, 20), (std::array<double, 2>{1, 1}));
}

}  // namespace
}  // namespace nacre::test
