// Nacre: parts of the viewer that need no picture: what is taken back, what was opened last, where the picture lies.
#include <gtest/gtest.h>

#include <fstream>

#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/window/recent_files.hpp"
#include "app/viewer/window/session_clock.hpp"
#include "app/viewer/window/undo.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

Session with_ttl(int ttl) {
  Session session;
  session.settings.flow.ttl = ttl;
  return session;
}

/// Frames of the loop: what is changed in one is noted in the next.
struct Frames {
  Undo undo;
  Session now, before;

  explicit Frames(const Session& begin) : now(begin), before(begin) {}
  void next(bool busy = false) {
    const std::optional<SessionEvent> change = session_change(before, now);
    undo.note(change ? &*change : nullptr, before, now, busy);
    before = now;
  }
  int& ttl() { return now.settings.flow.ttl; }
};

TEST(Undo, TakesChangesBackAndMakesThemAgain) {
  Frames frames(with_ttl(4));
  frames.next();
  EXPECT_FALSE(frames.undo.can_undo());
  frames.ttl() = 5;
  frames.next();
  frames.ttl() = 6;
  frames.next();
  frames.undo.undo(frames.now);
  EXPECT_EQ(frames.ttl(), 5);
  frames.next();
  frames.undo.undo(frames.now);
  EXPECT_EQ(frames.ttl(), 4);
  EXPECT_FALSE(frames.undo.can_undo());
  frames.next();
  frames.undo.redo(frames.now);
  frames.next();
  frames.undo.redo(frames.now);
  frames.next();
  EXPECT_EQ(frames.ttl(), 6);
  EXPECT_FALSE(frames.undo.can_redo());
}

TEST(Undo, OneStepForAllThatASliderDoes) {
  Frames frames(with_ttl(4));
  for (int ttl = 5; ttl < 9; ++ttl) frames.ttl() = ttl, frames.next(true);
  frames.next();
  frames.undo.undo(frames.now);
  EXPECT_EQ(frames.ttl(), 4);
}

TEST(Undo, LeavesTheCrosshairWhereItIs) {
  Frames frames(with_ttl(4));
  frames.now.settings.view.crosshair = "0.1 0.2 0.3";
  frames.next();
  EXPECT_FALSE(frames.undo.can_undo());
}

TEST(Undo, ASliderThatIsBackWhereItWasIsNoChange) {
  Frames frames(with_ttl(4));
  for (const int ttl : {5, 6, 4}) frames.ttl() = ttl, frames.next(true);
  frames.next();
  EXPECT_FALSE(frames.undo.can_undo());
}

TEST(Undo, AnotherChangeForgetsWhatWasTakenBack) {
  Frames frames(with_ttl(4));
  frames.ttl() = 5;
  frames.next();
  frames.undo.undo(frames.now);
  frames.next();
  frames.ttl() = 7;
  frames.next();
  EXPECT_FALSE(frames.undo.can_redo());
}

TEST(Undo, CamerasStayUnlessTheInputChanges) {
  Frames frames(with_ttl(4));
  frames.now.sample = "torus";
  frames.now.camera = Camera();
  frames.next();
  frames.ttl() = 5;
  frames.next();
  frames.now.camera->eye = {5, 5, 5};
  frames.next();
  frames.undo.undo(frames.now);
  EXPECT_EQ(frames.ttl(), 4);
  EXPECT_EQ(frames.now.camera->eye.x, 5);
  frames.next();
  frames.now.sample = "sphere";
  frames.now.camera.reset();
  frames.next();
  frames.undo.undo(frames.now);
  EXPECT_EQ(frames.now.sample, "torus");
  EXPECT_TRUE(frames.now.camera);
}

TEST(Undo, WhatTheWindowDoesItselfIsNoChange) {
  Frames frames(with_ttl(4));
  frames.now.settings.width = 300;
  frames.now.settings.view.play = false;
  frames.now.settings.view.tab = PanelTab::knobs;
  frames.next();
  EXPECT_FALSE(frames.undo.can_undo());
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
  EXPECT_EQ(position_in(area, 100, 220), (std::array<double, 2>{-1, -1}));
  EXPECT_EQ(position_in(area, 300, 120), (std::array<double, 2>{0, 0}));
  EXPECT_EQ(position_in(area, 500, 20), (std::array<double, 2>{1, 1}));
}

}  // namespace
}  // namespace nacre::test
