// Nacre: a fitted camera stays fitted until somebody moves it.
#include "app/viewer/scene/framing.hpp"

#include <gtest/gtest.h>

#include "engine/picture/legend.hpp"
#include "engine/render/camera_motion.hpp"
#include "tests/app/viewer/still_scene.hpp"

namespace nacre::test {
namespace {

class KeptInTheFreePart : public testing::Test {
 protected:
  void frame(const FreeArea& area) {
    area_ = area;
    framing_.keep(session_, scene_, area, [](const Settings& settings, const std::vector<Vec3d>& seen, bool legend) {
      const KeptFree kept = legend ? legend_room(settings.width, settings.height) : KeptFree();
      return fit_camera("iso", seen, settings.width, settings.height, kept);
    });
  }

  /// Does the picture end beyond all corners, and the legend's column, where there is one?
  bool all_seen() const {
    const Camera& camera = *session_.camera;
    const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward);
    const KeptFree kept = scene_.legend ? legend_room(area_.width, area_.height) : KeptFree();
    double left = 1, most_right = -1, most = 0;
    for (const Vec3d& p : scene_.points) {
      const Vec3d d = p - camera.eye;
      const double away = camera.orthographic ? 1 : dot(d, forward) / length(camera.target - camera.eye);
      const double x = 2 * dot(d, right) / (away * camera.height * area_.aspect());
      left = std::min(left, x), most_right = std::max(most_right, x);
      most = std::max({most, std::fabs(x), std::fabs(2 * dot(d, up) / (away * camera.height))});
    }
    return most < 1 && most > 0.6 && most_right < 2 * kept.left - 1;
  }

  StillScene scene_{{-3, -1, -1}, {3, 1, 1}};  // lies across, and under a legend
  Session session_;
  Framing framing_;
  FreeArea area_;
};

TEST_F(KeptInTheFreePart, AtEveryWindowSize) {
  for (const bool legend : {true, false}) {
    scene_.legend = legend;
    for (const FreeArea& area :
         {FreeArea{0, 0, 1024, 768}, {380, 20, 640, 700}, {10, 0, 250, 900}, {0, 0, 1600, 260}}) {
      frame(area);
      EXPECT_TRUE(all_seen()) << area.width << " x " << area.height << (legend ? " with a legend" : "");
      session_.camera->orthographic = !session_.camera->orthographic;
      frame(area);
      EXPECT_TRUE(all_seen()) << area.width << " x " << area.height << ", the other projection";
    }
  }
}

TEST_F(KeptInTheFreePart, WhenOtherThingsAreDrawn) {
  frame({0, 0, 800, 600});
  scene_.set({-30, -1, -1}, {3, 1, 40});
  EXPECT_FALSE(all_seen());
  frame({0, 0, 800, 600});
  EXPECT_TRUE(all_seen());
  scene_.legend = true;
  frame({0, 0, 800, 600});
  EXPECT_TRUE(all_seen());
}

TEST_F(KeptInTheFreePart, UntilSomebodyMovesIt) {
  frame({0, 0, 800, 600});
  const Camera moved = turn_table(*session_.camera, 0.1, 0.1);
  session_.camera = moved;
  frame({0, 0, 300, 600});
  EXPECT_TRUE(*session_.camera == moved);
  framing_.fit(session_, scene_, area_);
  EXPECT_TRUE(all_seen());
  EXPECT_NEAR(length(session_.camera->forward() - moved.forward()), 0, 1e-12);
  frame({0, 0, 800, 200});
  EXPECT_TRUE(all_seen()) << "from where it was turned to";
  framing_.look_from("+z", session_, scene_, area_);
  EXPECT_TRUE(all_seen());
  EXPECT_GT(session_.camera->eye.z, 2);
}

TEST_F(KeptInTheFreePart, NotWhereTheSessionSaysFromWhere) {
  const Camera given = fit_camera("+y", scene_.points, 100, 900);
  session_.camera = given;
  frame({0, 0, 800, 600});
  frame({0, 0, 300, 600});
  EXPECT_TRUE(*session_.camera == given);
}

}  // namespace
}  // namespace nacre::test
