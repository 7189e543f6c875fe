// Nacre: tests of keyframes: a recording that is edited plays as its list says.
#include "engine/scene/session/keyframes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/scene/session/window_knobs.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "tests/paths.hpp"

namespace nacre {
namespace {

Camera seen_from(const Vec3d& eye, double height = 2) {
  Camera camera;
  camera.eye = eye;
  camera.up = {0, 0, 1};
  camera.height = height;
  return camera;
}
const Camera front_view = seen_from({0, -5, 0}), side_view = seen_from({5, 0, 0}), top_view = seen_from({0, -1, 6}, 4);

Session showing(const Camera& camera) {
  Session session;
  session.sample = "torus";
  session.camera = camera;
  return session;
}

/// Begins at the front.
Keyframes list_at_front() {
  Keyframes list;
  list.begin(showing(front_view));
  return list;
}

/// At the front, at 2 s at the side, at 4 s above with edges.
Keyframes three_views() {
  Keyframes list = list_at_front();
  Session now = showing(side_view);
  list.add(2, now);
  now.camera = top_view;
  now.settings.view.edges = true;
  list.add(4, now);
  return list;
}

std::string text_of(const Keyframes& list) { return session_text(list.recording()); }

/// What is seen of two sessions is the same.
void expect_seen(const Session& a, const Session& b) {
  const std::optional<SessionEvent> change = shown_change(a, b);
  EXPECT_FALSE(change) << (change->camera ? "camera " : "")
                       << (change->knobs.empty() ? "" : change->knobs.begin()->first);
}

TEST(Keyframes, TheFirstOneIsTheBeginning) {
  Keyframes list;
  EXPECT_FALSE(list.begun());
  EXPECT_EQ(list.add(3, showing(front_view)), Keyframes::beginning);
  EXPECT_TRUE(list.begun());
  EXPECT_FALSE(list.unsaved()) << "a beginning alone is nothing to lose";
  EXPECT_EQ(list.recording().camera, front_view);
  EXPECT_EQ(list.duration(), 0);
  EXPECT_FALSE(list.recording().settings.view.panel) << "what is made of it shows no panels";
  EXPECT_FALSE(list.add(3, showing(front_view))) << "nothing differs";
}

TEST(Keyframes, TheListIsLikeTheSessionAtTheTimeOfAnAddedOne) {
  const Keyframes list = three_views();
  ASSERT_EQ(list.events().size(), 3u);
  EXPECT_EQ(list.duration(), 4);
  expect_seen(list.state_at(0), showing(front_view));
  expect_seen(list.state_at(2), showing(side_view));
  Session end = showing(top_view);
  end.settings.view.edges = true;
  expect_seen(list.state_at(4), end);
  EXPECT_FALSE(list.state_at(3.9).settings.view.edges);
  EXPECT_NE(list.state_at(3).camera, side_view) << "it is under way";
  EXPECT_TRUE(list.unsaved());
}

TEST(Keyframes, ACameraLeavesTwoSecondsBeforeItArrives) {
  Keyframes list = list_at_front();
  const std::optional<int> row = list.add(7, showing(side_view));
  ASSERT_EQ(row, 0);
  EXPECT_EQ(list.events()[0].time, 5);
  EXPECT_EQ(list.events()[0].over, 2);
  EXPECT_EQ(list.state_at(4.9).camera, front_view);
}

TEST(Keyframes, ACameraThatIsUnderWayStopsOver) {
  Keyframes list = list_at_front();
  list.add(4, showing(top_view));
  SessionEvent whole = list.events()[0];
  whole.time = 0;
  whole.over = 4;
  list.replace(0, whole);
  EXPECT_EQ(list.add(1, showing(side_view)), 0);
  ASSERT_EQ(list.events().size(), 2u);
  EXPECT_EQ(list.state_at(1).camera, side_view);
  EXPECT_EQ(list.state_at(4).camera, top_view);
  EXPECT_EQ(list.events()[1].over, 3);
  EXPECT_NE(list.state_at(3).camera, top_view);
}

TEST(Keyframes, AddingWhereOneIsChangesIt) {
  Keyframes list = three_views();
  const std::size_t events = list.events().size();
  Session now = list.state_at(2);
  now.camera = seen_from({4, 4, 0});
  list.add(2, now);
  EXPECT_EQ(list.events().size(), events);
  expect_seen(list.state_at(2), now);
  EXPECT_EQ(list.state_at(4).camera, top_view);
  now = list.state_at(4);
  now.settings.flow.ttl = 7;
  list.add(4, now);
  EXPECT_EQ(list.events().size(), events) << "the knobs of that time are one keyframe";
  expect_seen(list.state_at(4), now);
  Session begin = list.state_at(0);
  begin.camera = top_view;
  EXPECT_EQ(list.add(0, begin), Keyframes::beginning);
  expect_seen(list.start(), begin);
}

TEST(Keyframes, WhatIsAddedAtAnyTimeIsSeenThere) {
  Keyframes list = list_at_front();
  for (int k = 0; k < 60; ++k) {
    const double time = (k * 27 % 100) / 10.0;
    Session now = list.state_at(time);
    now.camera = seen_from({std::cos(double(k)) * 5, std::sin(double(k)) * 5, 0.1 * k});
    if (k % 3 == 0) now.settings.flow.ttl = 1 + k % 7;
    SCOPED_TRACE(time);
    list.add(time, now);
    expect_seen(list.state_at(time), now);
  }
}

TEST(Keyframes, StatesAreThoseOfAPlayer) {
  const Keyframes list = three_views();
  Session now = list.start();
  SessionPlayer player(list.recording());
  for (int k = 0; k <= 100; ++k) {
    player.advance(k / 25.0, now);
    const Session state = list.state_at(k / 25.0);
    EXPECT_LT(length(state.camera->eye - now.camera->eye), 1e-9) << k;
    EXPECT_EQ(knob_values(state.settings), knob_values(now.settings));
  }
}

TEST(Keyframes, AnotherInputIsAKeyframe) {
  Keyframes list = three_views();
  Session other = showing(side_view);
  other.sample = "train";
  const std::optional<int> row = list.add(6, other);
  ASSERT_EQ(row, 3);
  EXPECT_EQ(list.events()[3].input->sample, "train");
  expect_seen(list.state_at(6), other);
  EXPECT_FALSE(list.update(3, showing(front_view))) << "the torus is shown";
  other.camera = front_view;
  EXPECT_TRUE(list.update(3, other));
  expect_seen(list.state_at(6), other);
  other.camera = top_view;
  list.add(6.5, other);  // the camera does not leave before it is there
  EXPECT_EQ(list.events()[4].time, 6);
  expect_seen(list.state_at(6), [&] {
    Session at = other;
    at.camera = front_view;
    return at;
  }());
}

TEST(Keyframes, UpdateTakesOverWhatIsSeen) {
  Keyframes list = three_views();
  Session now = list.state_at(2);
  now.camera = seen_from({1, 1, 9});
  now.settings.colormap = "ember";
  now.settings.view.theme = Theme::light;
  now.settings.view.tab = PanelTab::look;
  EXPECT_TRUE(list.update(0, now));
  EXPECT_EQ(list.events()[0].time, 0);
  EXPECT_EQ(list.events()[0].over, 2);
  EXPECT_EQ(list.events()[0].knobs, (std::map<std::string, std::string>{{"colormap", "ember"}})) << "and no panels";
  expect_seen(list.state_at(2), now);
  now.settings.legend = false;
  EXPECT_TRUE(list.update(Keyframes::beginning, now));
  expect_seen(list.start(), now);
  EXPECT_FALSE(list.start().settings.view.panel);
  const int picture = list.add_screenshot(9, {"/a.png", 1, false, false});
  EXPECT_TRUE(list.update(picture, list.state_at(9))) << "the picture is left";
  EXPECT_TRUE(list.events()[std::size_t(picture)].screenshot);
}

TEST(Keyframes, StaySortedAndKnowTheirRow) {
  Keyframes list = three_views();
  SessionEvent first = list.events()[0];
  first.time = 10;
  EXPECT_EQ(list.replace(0, first), 2);
  EXPECT_EQ(list.events()[2].camera, side_view);
  EXPECT_EQ(list.duration(), 12) << "it ends with the last one";
  first.time = -3;
  EXPECT_EQ(list.replace(2, first), 0);
  EXPECT_EQ(list.events()[0].time, 0);
  first.time = list.events()[2].time;
  EXPECT_EQ(list.replace(0, first), 2) << "of two at one time, the one that came last wins";
  first.time = std::nan("");
  list.replace(2, first);
  EXPECT_EQ(list.events()[0].time, 0);
  first.time = std::numeric_limits<double>::infinity();
  list.replace(0, first);
  EXPECT_NO_THROW(parse_session(text_of(list)));
}

TEST(Keyframes, AreDuplicatedAndRemoved) {
  Keyframes list = three_views();
  EXPECT_EQ(list.duplicate(0), 2);  // beside the other one of that time
  EXPECT_EQ(list.events()[2].camera, side_view);
  EXPECT_EQ(list.events()[2].time, 2);
  list.remove(2);
  EXPECT_EQ(text_of(list), text_of(three_views()));
  SessionEvent edges = list.events()[2];
  edges.knobs.clear();
  EXPECT_EQ(list.replace(2, edges), 1) << "one that does nothing goes";
  EXPECT_EQ(list.events().size(), 2u);
  EXPECT_EQ(list.duration(), 4);
  list.remove(1);
  list.remove(0);
  EXPECT_TRUE(list.events().empty());
  EXPECT_EQ(list.duration(), 0);
}

TEST(Keyframes, OnlyACameraTakesTime) {
  Keyframes list = three_views();
  SessionEvent edges = list.events()[2];
  edges.over = 3;
  list.replace(2, edges);
  EXPECT_EQ(list.events()[2].over, 0);
  SessionEvent camera = list.events()[0];
  camera.over = -1;
  list.replace(0, camera);
  EXPECT_EQ(list.events()[0].over, 0) << "it jumps";
}

TEST(Keyframes, ADurationIsKeptBeyondTheLast) {
  Keyframes list = three_views();
  list.set_duration(6);
  list.add(5, [&] {
    Session now = list.state_at(5);
    now.camera = front_view;
    return now;
  }());
  EXPECT_EQ(list.duration(), 6);
  list.set_duration(1);
  EXPECT_EQ(list.duration(), 5);
}

TEST(Keyframes, EachEditCanBeUndone) {
  Keyframes list = list_at_front();
  std::vector<std::string> texts{text_of(list)};
  const auto note = [&] { texts.push_back(text_of(list)); };
  list.add(2, showing(side_view)), note();
  list.add_screenshot(1, {"/a.png", 1, false, false}), note();
  list.duplicate(0), note();
  list.update(0, showing(top_view)), note();
  list.remove(1), note();
  list.set_duration(9), note();
  list.open(showing(top_view), true), note();
  for (std::size_t k = texts.size() - 1; k-- > 0;) {
    EXPECT_TRUE(list.can_undo());
    list.undo();
    EXPECT_EQ(text_of(list), texts[k]);
  }
  for (std::size_t k = 1; k < texts.size(); ++k) {
    EXPECT_TRUE(list.can_redo());
    list.redo();
    EXPECT_EQ(text_of(list), texts[k]);
  }
  EXPECT_FALSE(list.can_redo());
}

TEST(Keyframes, KnowWhetherTheyAreSaved) {
  Keyframes list = three_views();
  list.note_saved();
  EXPECT_FALSE(list.unsaved());
  list.remove(0);
  EXPECT_TRUE(list.unsaved());
  list.undo();
  EXPECT_FALSE(list.unsaved());
  list.open(showing(front_view), true);
  EXPECT_FALSE(list.unsaved());
  list.open(showing(front_view), false);
  EXPECT_TRUE(list.unsaved());
}

TEST(Keyframes, GoThroughAFile) {
  Keyframes list = three_views();
  list.add_screenshot(3, {"/pictures/a.png", 2, false, true});
  Keyframes again;
  again.open(parse_session(text_of(list)), true);
  EXPECT_EQ(text_of(again), text_of(list));
  for (double time = 0; time < 5; time += 0.5) expect_seen(again.state_at(time), list.state_at(time));
}

TEST(Keyframes, KeepKnobsOfTheWindowThatARecordingHas) {
  Session recording = showing(front_view);
  recording.settings.view.panel = true;
  recording.settings.width = 640;
  SessionEvent event;
  event.time = 1;
  event.knobs = {{"tab", "look"}, {"edges", "true"}};
  recording.events.push_back(event);
  recording.duration = 2;
  Keyframes list;
  list.open(recording, true);
  EXPECT_EQ(text_of(list), session_text(recording));
  Session now = list.state_at(1);
  now.settings.view.tab = PanelTab::data;
  now.camera = side_view;
  EXPECT_TRUE(list.update(0, now));
  EXPECT_EQ(list.events()[0].knobs, event.knobs);
  const Session played = played_in_window(list.recording(), Settings());
  EXPECT_EQ(played.settings.width, Settings().width);
  EXPECT_FALSE(played.events[0].knobs.contains("tab"));
  EXPECT_TRUE(played.events[0].knobs.contains("edges"));
}

/// Cameras and knobs of each frame.
void expect_same_frames(const Session& one, const Session& other) {
  SessionPlayer first(one), second(other);
  Session a = one, b = other;
  for (int frame = 0; frame <= one.duration * one.settings.fps; ++frame) {
    first.advance(double(frame) / one.settings.fps, a);
    second.advance(double(frame) / one.settings.fps, b);
    EXPECT_EQ(a.camera, b.camera) << frame;
    EXPECT_EQ(knob_values(a.settings), knob_values(b.settings)) << frame;
  }
}

/// They are made with it: each state is added when it is reached, and cameras get their time.
TEST(Keyframes, MakeTheTours) {
  for (const char* name : {"flow_demo", "mesh_demo", "moving_demo"}) {
    const Session tour = read_session(test::source_file(std::string("assets/") + name + ".json"));
    Keyframes list;
    list.begin(tour);
    for (const SessionEvent& event : tour.events) {
      Session reached = list.state_at(event.time + event.over);
      apply_event(event, reached);
      const std::optional<int> row = list.add(event.time + event.over, reached);
      ASSERT_TRUE(row) << name << " " << event.time;
      SessionEvent timed = list.events()[std::size_t(*row)];
      timed.time = event.time;
      timed.over = event.over;
      list.replace(*row, timed);
    }
    list.set_duration(tour.duration);
    SCOPED_TRACE(name);
    ASSERT_EQ(list.events().size(), tour.events.size());
    EXPECT_EQ(list.duration(), tour.duration);
    expect_same_frames(tour, list.recording());
  }
}

/// The recordings that come with the program are edited and saved without a change of what they show.
TEST(Keyframes, HoldTheToursAsTheyAre) {
  for (const char* name : {"flow_demo", "mesh_demo", "moving_demo"}) {
    const Session tour = read_session(test::source_file(std::string("assets/") + name + ".json"));
    Keyframes list;
    list.open(tour, true);
    EXPECT_EQ(text_of(list), session_text(tour)) << name;
    list.replace(0, [&] {
      SessionEvent later = list.events()[0];
      later.time += 1;
      return later;
    }());
    list.undo();
    const Session saved = parse_session(text_of(list));
    SCOPED_TRACE(name);
    ASSERT_EQ(saved.events.size(), tour.events.size());
    EXPECT_EQ(saved.duration, tour.duration);
    expect_same_frames(tour, saved);
  }
}

}  // namespace
}  // namespace nacre
