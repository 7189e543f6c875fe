// Nacre: tests of recordings: cameras on their way, events on the clock, and the recording of a replay.
#include "engine/scene/session/recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/scene/settings/knobs.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

constexpr double pi = 3.14159265358979323846;

Camera camera_at(const Vec3d& eye, const Vec3d& up = {0, 0, 1}, double height = 2) {
  Camera camera;
  camera.eye = eye;
  camera.up = up;
  camera.height = height;
  return camera;
}

void expect_near(const Vec3d& a, const Vec3d& b, double error = 1e-12) {
  EXPECT_LT(length(a - b), error) << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
}

TEST(BetweenCameras, EndsAreExact) {
  Camera from = camera_at({3, 1, 2}), to = camera_at({-1, 7, 0.1}, {1, 0, 1}, 5);
  to.target = {0.3, 0.1, 0.7};
  to.orthographic = true;
  EXPECT_EQ(between(from, to, 0), from);
  EXPECT_EQ(between(from, to, 1), to);
  const Camera near_end = between(from, to, 1 - 1e-9);  // and no jump before it
  expect_near(near_end.eye, to.eye, 1e-6);
  expect_near(near_end.forward(), to.forward(), 1e-6);
  expect_near(near_end.right(), to.right(), 1e-6);
  EXPECT_NEAR(near_end.height, to.height, 1e-6);
}

TEST(BetweenCameras, HalfOfAQuarterTurn) {
  const Camera half = between(camera_at({2, 0, 0}), camera_at({0, 2, 0}), 0.5);
  expect_near(half.eye, Vec3d(1, 1, 0) * std::sqrt(2.0));
  expect_near(half.up, {0, 0, 1});
}

TEST(BetweenCameras, DistanceAndHeightGoByRatios) {
  Camera to = camera_at({16, 0, 0}, {0, 0, 1}, 18);
  to.target = {0, 0, 0};
  const Camera half = between(camera_at({1, 0, 0}), to, 0.5);
  expect_near(half.eye, {4, 0, 0});
  EXPECT_NEAR(half.height, 6, 1e-12);
}

TEST(BetweenCameras, OppositeOnesTurnByHalfACircle) {
  for (const Vec3d& eye : {Vec3d(2, 0, 0), Vec3d(0, 2, 0), Vec3d(1, 1, 0)}) {
    const Camera from = camera_at(eye), to = camera_at(-eye);
    Vec3d last = from.forward();
    double turned = 0;
    for (int k = 1; k <= 100; ++k) {
      const Camera camera = between(from, to, k / 100.0);
      EXPECT_NEAR(length(camera.eye), length(eye), 1e-9);
      EXPECT_NEAR(dot(camera.right(), camera.forward()), 0, 1e-9);
      turned += std::acos(std::min(1.0, dot(camera.forward(), last)));
      last = camera.forward();
    }
    EXPECT_NEAR(turned, pi, 1e-4);
  }
  // The same position, the other way up.
  const Camera half = between(camera_at({2, 0, 0}), camera_at({2, 0, 0}, {0, 0, -1}), 0.5);
  expect_near(half.eye, {2, 0, 0}, 1e-9);
  EXPECT_NEAR(std::fabs(dot(half.right(), Vec3d(0, 0, 1))), 1, 1e-9);
}

TEST(BetweenCameras, SameCameraStays) {
  const Camera camera = camera_at({3, 1, 2});
  expect_near(between(camera, camera, 0.3).eye, camera.eye);
}

TEST(BetweenCameras, OrthographicOnesKeepTheirKind) {
  Camera from = camera_at({2, 0, 0}), to = camera_at({0, 2, 0}, {0, 0, 1}, 8);
  from.orthographic = to.orthographic = true;
  const Camera half = between(from, to, 0.5);
  EXPECT_TRUE(half.orthographic);
  EXPECT_NEAR(half.height, 4, 1e-12);
}

SessionEvent knob_event(double time, const std::string& name, const std::string& text) {
  SessionEvent event;
  event.time = time;
  event.knobs[name] = text;
  return event;
}

SessionEvent camera_event(double time, const Camera& camera, double over = 0) {
  SessionEvent event;
  event.time = time;
  event.camera = camera;
  event.over = over;
  return event;
}

SessionEvent picture_event(double time, const std::string& file) {
  SessionEvent event;
  event.time = time;
  event.screenshot = Screenshot{file, 2, false, true};
  return event;
}

SessionEvent input_event(double time, const std::string& sample) {
  SessionEvent event;
  event.time = time;
  event.input = SessionInput{{}, sample, 32};
  return event;
}

/// What a viewer does with a session on a clock, without any scene: it is played, a camera is fitted where there is
/// none, and it is recorded.
struct Replay {
  Session session;
  SessionPlayer player;
  SessionRecorder recorder;
  int fps, frames = 0;
  std::vector<std::pair<double, Screenshot>> pictures;

  explicit Replay(const Session& script, int rate = 10)
      : session(script), player(script), recorder(script, rate), fps(rate) {}

  void frame(double time) {
    const std::vector<Screenshot> wanted = player.advance(time, session);
    if (!session.camera) session.camera = camera_at({double(session.sample.size()) + 1, 0, 0});
    recorder.note(time, session, wanted);
    for (const Screenshot& each : wanted) pictures.emplace_back(time, each);
    ++frames;
  }

  Session run() {
    for (double time = 0; !player.ended(); time = double(frames) / fps) frame(time);
    return recorder.recording();
  }
};

Session through_text(const Session& session) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "s.json") << session_text(session);
  return read_session(folder / "s.json");
}

/// Recorded, replayed, recorded again, also through a file, and at another moment of writing.
void expect_same_again(const Session& script) {
  const Session first = Replay(script).run();
  const std::string text = session_text(first);
  EXPECT_EQ(session_text(Replay(first).run()), text);
  EXPECT_EQ(session_text(Replay(through_text(first)).run()), text);
}

Session script_of(std::vector<SessionEvent> events, double duration) {
  Session script;
  script.sample = "torus";
  script.events = std::move(events);
  script.duration = duration;
  return script;
}

TEST(SessionPlayer, EventsAreShownByTheFirstFrameAtOrAfterThem) {
  Session now;
  SessionPlayer player(script_of({knob_event(0.25, "ttl", "3"), knob_event(0.3, "ttl", "5")}, 1));
  player.advance(0.2, now);
  EXPECT_EQ(now.settings.flow.ttl, Settings().flow.ttl);
  player.advance(3 * 0.1, now);  // is a little more than 0.3
  EXPECT_EQ(now.settings.flow.ttl, 5);
}

TEST(SessionPlayer, LastFrameIsThatOfTheDuration) {
  EXPECT_EQ(Replay(script_of({}, 1.2)).run().duration, 1.2);
  Replay replay(script_of({picture_event(1, "/a.png")}, 1));
  replay.run();
  EXPECT_EQ(replay.frames, 11);
  ASSERT_EQ(replay.pictures.size(), 1u);
  EXPECT_EQ(replay.pictures[0].first, 1);
  Replay at_once(script_of({knob_event(0, "ttl", "3")}, 0));
  at_once.run();
  EXPECT_EQ(at_once.frames, 1);
  SessionPlayer nothing(script_of({}, 0));
  nothing.advance(100, at_once.session);
  EXPECT_FALSE(nothing.ended());
}

TEST(SessionPlayer, WhatHappensAtTheEndBetweenTwoFramesIsShown) {
  Replay replay(script_of({picture_event(0.97, "/a.png"), knob_event(0.97, "ttl", "3")}, 0.97));
  EXPECT_EQ(replay.run().duration, 1);
  EXPECT_EQ(replay.frames, 11);
  EXPECT_EQ(replay.pictures.size(), 1u);
  EXPECT_EQ(replay.session.settings.flow.ttl, 3);
  expect_same_again(script_of({picture_event(0.97, "/a.png")}, 0.97));
}

TEST(SessionPlayer, CameraGlidesFromRestToRest) {
  const Camera from = camera_at({2, 0, 0}), to = camera_at({0, 2, 0});
  Session now;
  now.camera = from;
  SessionPlayer player(script_of({camera_event(1, to, 2)}, 4));
  player.advance(0.9, now);
  EXPECT_EQ(now.camera, from);
  player.advance(1, now);
  EXPECT_EQ(now.camera, from);
  player.advance(2, now);
  expect_near(now.camera->eye, Vec3d(1, 1, 0) * std::sqrt(2.0));
  player.advance(3, now);
  EXPECT_EQ(now.camera, to);
}

TEST(SessionPlayer, AGlideThatIsOvertakenGoesOnFromWhereItIs) {
  const Camera a = camera_at({2, 0, 0}), b = camera_at({0, 2, 0}), c = camera_at({0, 0, 2}, {0, 1, 0});
  const Session script = script_of({camera_event(0, b, 2), camera_event(1, c, 2)}, 4);
  Session fine, coarse;
  fine.camera = coarse.camera = a;
  SessionPlayer fine_player(script), coarse_player(script);
  for (int k = 0; k <= 200; ++k) fine_player.advance(k * 0.01, fine);
  coarse_player.advance(0, coarse);
  coarse_player.advance(2, coarse);  // no frame between the events
  expect_near(fine.camera->eye, coarse.camera->eye, 1e-9);
  EXPECT_GT(length(fine.camera->eye - b.eye), 0.1);
}

TEST(SessionPlayer, AUsersCameraEndsTheGlideAndTheNextEventTakesItBack) {
  const Camera mine = camera_at({0, -5, 0});
  Session now;
  now.camera = camera_at({2, 0, 0});
  SessionPlayer player(script_of({camera_event(0, camera_at({0, 2, 0}), 2), camera_event(3, camera_at({0, 3, 0}))}, 4));
  player.advance(0, now);
  player.advance(0.5, now);
  now.camera = mine;
  player.advance(1, now);
  player.advance(2.5, now);
  EXPECT_EQ(now.camera, mine);
  player.advance(3, now);
  expect_near(now.camera->eye, {0, 3, 0});
}

TEST(SessionPlayer, WhatIsOpenedEndsTheGlide) {
  Replay replay(script_of({camera_event(0.1, camera_at({0, 2, 0}), 2), input_event(0.5, "sphere")}, 1));
  replay.run();
  expect_near(replay.session.camera->eye, {7, 0, 0});
}

TEST(SessionRecorder, WritesWhatChangesWithTheTimeOfItsFrame) {
  Session session = script_of({}, 0);
  SessionRecorder recorder(session, 10);
  recorder.note(0, session);
  session.settings.flow.ttl = 3;
  recorder.note(0.41, session);
  recorder.note(0.55, session);
  const Session recording = recorder.recording();
  ASSERT_EQ(recording.events.size(), 1u);
  EXPECT_EQ(recording.events[0].time, 0.5);
  EXPECT_EQ(recording.events[0].knobs, (std::map<std::string, std::string>{{"ttl", "3"}}));
  EXPECT_EQ(recording.duration, 0.6);
}

TEST(SessionRecorder, ChangesWithinOneFrameAreOneEvent) {
  Session session = script_of({}, 0);
  SessionRecorder recorder(session, 10);
  session.settings.flow.ttl = 3;
  recorder.note(0.41, session);
  session.settings.flow.contrast = 0.1;
  recorder.note(0.42, session);
  session.settings.flow.ttl = Settings().flow.ttl;  // and back again
  recorder.note(0.43, session);
  const Session recording = recorder.recording();
  ASSERT_EQ(recording.events.size(), 1u);
  EXPECT_EQ(recording.events[0].knobs, (std::map<std::string, std::string>{{"contrast", "0.1"}}));
  expect_same_again(recording);
}

TEST(SessionRecorder, NothingChangesAfterAPictureInTheSameFrame) {
  Session session = script_of({}, 0);
  session.camera = camera_at({2, 0, 0});
  SessionRecorder recorder(session, 10);
  recorder.note(0.41, session, {Screenshot{"/a.png", 1, true, false}, Screenshot{"/b.png", 2, false, true}});
  session.settings.flow.ttl = 3;
  recorder.note(0.42, session);
  const Session recording = recorder.recording();
  ASSERT_EQ(recording.events.size(), 3u);
  EXPECT_EQ(recording.events[1].screenshot->file, "/b.png");
  EXPECT_EQ(recording.events[1].time, 0.5);
  EXPECT_EQ(recording.events[2].time, 0.6);
  expect_same_again(recording);
}

TEST(SessionRecorder, FittedCameraBelongsToWhatWasOpened) {
  Session session = script_of({}, 0);
  SessionRecorder recorder(session, 10);
  recorder.note(0, session);  // still reading
  session.camera = camera_at({6, 0, 0});
  recorder.note(0.2, session);
  static_cast<SessionInput&>(session) = {{}, "sphere", 0};
  session.camera.reset();
  recorder.note(0.5, session);  // reading again
  session.settings.flow.ttl = 3;
  recorder.note(0.6, session);
  session.camera = camera_at({7, 0, 0});
  recorder.note(0.8, session);
  session.camera = camera_at({8, 0, 0});  // the user's own
  recorder.note(1, session);
  const Session recording = recorder.recording();
  EXPECT_EQ(recording.camera, camera_at({6, 0, 0}));
  ASSERT_EQ(recording.events.size(), 3u);
  EXPECT_EQ(recording.events[0].input->sample, "sphere");
  EXPECT_EQ(recording.events[0].camera, camera_at({7, 0, 0}));
  EXPECT_FALSE(recording.events[1].camera);
  EXPECT_EQ(recording.events[2].camera, camera_at({8, 0, 0}));
  expect_same_again(recording);
}

TEST(Recordings, OfAReplayAreTheSame) {
  const Camera there = camera_at({0, 2.0 / 3, 0.1}), back = camera_at({0.1, -2, 1.0 / 7}, {0, 0, 1}, 3);
  expect_same_again(script_of({}, 1));
  expect_same_again(script_of({knob_event(0, "ttl", "3"), knob_event(0.33, "contrast", "0.123456789012345678")}, 2));
  expect_same_again(script_of({camera_event(0.1, there, 0.7), camera_event(0.5, back, 0.7)}, 2));
  expect_same_again(
      script_of({input_event(0.31, "sphere"), knob_event(0.35, "ttl", "2"), input_event(0.4, "train")}, 1));
  expect_same_again(script_of({knob_event(0.3, "camera", "+x"), camera_event(0.6, back, 0.2)}, 1));
  expect_same_again(script_of({picture_event(0.2, "/a.png"), picture_event(0.2, "/b.png"), knob_event(0.2, "ttl", "3"),
                               camera_event(0.2, there, 0.5), picture_event(1, "/c.png")},
                              1));
  expect_same_again(script_of({knob_event(0.2, "fps", "50"), camera_event(0.3, there, 0.4)}, 1));
}

TEST(Recordings, OfALiveSessionAreThoseOfTheirReplay) {
  // A display at 60 Hz, a recording at 10: every frame moves something.
  Session session = script_of({}, 0);
  SessionRecorder recorder(session, 10);
  for (int k = 0; k < 200; ++k) {
    const double time = k / 60.0 + 0.003 * std::sin(double(k));
    if (k == 12) session.camera = camera_at({6, 0, 0});
    if (k > 30 && k < 90) session.camera->eye.y += 0.01 * k;
    if (k % 17 == 0) session.settings.flow.contrast = 0.1 + 0.001 * k;
    if (k == 100) static_cast<SessionInput&>(session) = {{}, "train", 0}, session.camera.reset();
    if (k == 117) session.camera = camera_at({1, 2, 3});
    std::vector<Screenshot> pictures;
    if (k % 40 < 2) pictures.push_back({"/" + std::to_string(k) + ".png", 1, k % 2 == 0, false});
    recorder.note(time, session, pictures);
  }
  const Session recording = recorder.recording();
  EXPECT_GT(recording.events.size(), 15u);
  for (std::size_t k = 1; k < recording.events.size(); ++k)
    EXPECT_LE(recording.events[k - 1].time, recording.events[k].time);
  EXPECT_EQ(session_text(Replay(recording).run()), session_text(recording));
  expect_same_again(recording);
}

TEST(Recordings, PlayedAtAnotherRateEndAlike) {
  const Session script = script_of({camera_event(0.1, camera_at({0, 2, 0}), 0.6), knob_event(0.55, "ttl", "3")}, 1);
  Replay slow(script, 7), fast(script, 60);
  slow.run();
  fast.run();
  EXPECT_EQ(slow.session.camera, fast.session.camera);
  EXPECT_EQ(knob_values(slow.session.settings), knob_values(fast.session.settings));
}

}  // namespace
}  // namespace nacre
