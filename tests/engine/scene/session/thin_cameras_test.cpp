// Nacre: tests of fewer cameras for the same way.
#include "engine/scene/session/thin_cameras.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/session/recording.hpp"

namespace nacre {
namespace {

constexpr int frame_rate = 25;

Camera turned(double angle, double height = 2) {
  Camera camera;
  camera.eye = {5 * std::cos(angle), 5 * std::sin(angle), 1};
  camera.up = {0, 0, 1};
  camera.height = height;
  return camera;
}

/// One camera for each frame from `begin` on.
template <class CameraAt>
void drag(Session& recording, double begin, int frames, const CameraAt& camera_at) {
  for (int k = 1; k <= frames; ++k) {
    SessionEvent event;
    event.time = begin + double(k) / frame_rate;
    event.camera = camera_at(double(k) / frames);
    recording.events.push_back(event);
    recording.duration = event.time;
  }
}

Session recording_at(double angle) {
  Session recording;
  recording.sample = "torus";
  recording.settings.fps = frame_rate;
  recording.camera = turned(angle);
  return recording;
}

/// The largest shift between the two in any frame.
double largest_shift(const Session& a, const Session& b) {
  SessionPlayer first(a), second(b);
  Session x = a, y = b;
  double most = 0;
  for (int frame = 0; frame <= int(a.duration * frame_rate) + 1; ++frame) {
    first.advance(double(frame) / frame_rate, x);
    second.advance(double(frame) / frame_rate, y);
    most = std::max(most, shift_in_picture(*x.camera, *y.camera));
  }
  return most;
}

Session thinned(const Session& recording, double tolerance) {
  Session thin = recording;
  thin.events = thin_cameras(recording, tolerance);
  return thin;
}

TEST(ShiftInPicture, IsAShareOfTheHeight) {
  const Camera camera = turned(0);
  EXPECT_EQ(shift_in_picture(camera, camera), 0);
  Camera moved = camera;
  moved.eye.z += 0.2, moved.target.z += 0.2;
  EXPECT_NEAR(shift_in_picture(camera, moved), 0.1, 0.03);
  Camera nearer = camera;
  nearer.height = 1;
  EXPECT_NEAR(shift_in_picture(camera, nearer), 0.5, 0.02) << "the border is twice as far out";
  Camera flat = camera;
  flat.orthographic = true;
  EXPECT_GT(shift_in_picture(camera, flat), 1e9);
}

TEST(ThinCameras, ACameraThatMovedSmoothlyIsOneAgain) {
  Session recording = recording_at(0);
  drag(recording, 1, 50, [](double share) { return between(turned(0), turned(1.5, 3), eased(share)); });
  const Session thin = thinned(recording, 0.005);
  ASSERT_EQ(thin.events.size(), 1u);
  EXPECT_NEAR(thin.events[0].time, 1, 1e-9);
  EXPECT_NEAR(thin.events[0].over, 2, 1e-9);
  EXPECT_EQ(thin.events[0].camera, recording.events.back().camera);
  EXPECT_LT(largest_shift(recording, thin), 0.005);
}

TEST(ThinCameras, StaysWithinItsTolerance) {
  Session recording = recording_at(0);
  drag(recording, 0.48, 60, [](double share) { return turned(1.2 * share + 0.2 * std::sin(9 * share)); });
  const Camera last = *recording.events.back().camera;
  drag(recording, 4, 40, [&](double share) {
    Camera camera = last;
    camera.height = 2 - share;
    return camera;
  });
  std::size_t left = recording.events.size();
  for (const double tolerance : {0.001, 0.005, 0.02, 0.1}) {
    const Session thin = thinned(recording, tolerance);
    EXPECT_LE(largest_shift(recording, thin), tolerance * 1.0001);
    EXPECT_LE(thin.events.size(), left);
    left = thin.events.size();
    EXPECT_EQ(thinned(thin, tolerance).events.size(), left) << "once is enough";
    EXPECT_EQ(SessionPlayer(thin).plays(), true);
  }
  EXPECT_LT(left, 12u);
}

TEST(ThinCameras, LeavesWhatElseHappens) {
  Session recording = recording_at(0);
  drag(recording, 0, 50, [](double share) { return between(turned(0), turned(1.5), eased(share)); });
  recording.events[20].knobs["edges"] = "true";
  SessionEvent picture;
  picture.time = recording.events[30].time;
  picture.screenshot = Screenshot{"/a.png", 1, false, false};
  recording.events.insert(recording.events.begin() + 31, picture);
  const Session thin = thinned(recording, 0.005);
  ASSERT_EQ(thin.events.size(), 3u);
  EXPECT_EQ(thin.events[1].time, recording.events[20].time);
  EXPECT_EQ(thin.events[1].knobs.at("edges"), "true");
  EXPECT_FALSE(thin.events[1].camera);
  EXPECT_TRUE(thin.events[2].screenshot);
  EXPECT_LT(largest_shift(recording, thin), 0.005);
}

TEST(ThinCameras, LeavesJumpsAndSmoothOnesAndWhatIsOpened) {
  Session recording = recording_at(0);
  for (int k = 1; k <= 4; ++k) {  // jumps
    SessionEvent event;
    event.time = k;
    event.camera = turned(k);
    recording.events.push_back(event);
  }
  SessionEvent smooth;
  smooth.time = 5;
  smooth.camera = turned(0);
  smooth.over = 1;
  recording.events.push_back(smooth);
  SessionEvent opens;
  opens.time = 7;
  opens.input = SessionInput{{}, "train", 0};
  opens.camera = turned(1);
  recording.events.push_back(opens);
  Session thin = thinned(recording, 0.005);
  recording.duration = thin.duration = 8;
  EXPECT_EQ(session_text(thin), session_text(recording));
}

TEST(ThinCameras, BeginWithTheFirstWhereNoneIsKnownBefore) {
  Session recording = recording_at(0);
  recording.camera.reset();
  drag(recording, 0, 50, [](double share) { return between(turned(0), turned(1.5), eased(share)); });
  const Session thin = thinned(recording, 0.01);
  EXPECT_EQ(thin.events.front().over, 0);
  EXPECT_LT(thin.events.size(), 6u);
  EXPECT_EQ(thin.events.back().camera, recording.events.back().camera);
}

}  // namespace
}  // namespace nacre
