// Nacre: a fitted camera stays fitted until somebody moves it.
#include "app/viewer/framing.hpp"

#include <gtest/gtest.h>

#include "engine/picture/legend.hpp"
#include "engine/render/camera_motion.hpp"

namespace nacre::test {
namespace {

/// Corners, and nothing else.
class Corners : public Scene {
 public:
  std::vector<Vec3d> points;
  std::uint64_t version = 1;
  bool legend = false;

  Corners(const Vec3d& low, const Vec3d& high) { set(low, high); }
  void set(const Vec3d& low, const Vec3d& high) {
    points.clear();
    for (int k = 0; k < 8; ++k)
      points.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
    ++version;
  }

  const std::vector<Vec3d>& corners() const override { return points; }
  std::uint64_t seen_version() const override { return version; }
  bool has_legend() const override { return legend; }

  void advance(double) override {}
  bool advance_and_wait(const std::atomic<bool>&, double) override { return true; }
  void set_settings(const Settings&) override {}
  void cancel() override {}
  void resume() override {}
  bool halted() const override { return false; }
  void draw(const View&) override {}
  Image overlay(int, int) override { return {}; }
  std::uint64_t overlay_version() const override { return 0; }
  void data_panel(Session&) override {}
  void result_panel(Session&) override {}
  std::optional<Probed> probe(const Vec3d&, const Vec3d&) override { return {}; }
  void write_result(const std::filesystem::path&) override {}
  void begin_write(const std::filesystem::path&) override {}
  std::optional<std::string> take_written() override { return {}; }
  std::vector<std::string> result_formats() const override { return {}; }
  bool complete() const override { return true; }
  bool settled() const override { return true; }
  std::string title() const override { return ""; }
  std::string state() const override { return ""; }
  SceneProgress progress() const override { return {}; }
  const std::string& failure() const override { return nothing_; }
  const std::vector<std::string>& warnings() const override { return none_; }
  std::string remark() const override { return ""; }
  int steps() const override { return 0; }
  std::uint64_t copied_bytes() const override { return 0; }
  StageTimers timers() const override { return {}; }
  std::size_t peak_bytes() const override { return 0; }
  const Device& device() const override { return *device_; }
  void finish() override {}

 private:
  std::string nothing_;
  std::vector<std::string> none_;
  std::unique_ptr<Device> device_ = make_cpu_device();
};

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

  Corners scene_{{-3, -1, -1}, {3, 1, 1}};  // lies across, and under a legend
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
