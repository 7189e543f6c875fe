// Nacre: the list of critical points in the panel of a flow. No OpenGL here.
#include "app/viewer/panel/flow_panel.hpp"

#include <algorithm>
#include <memory>

#include "tests/app/imgui_frames.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre::test {
namespace {

/// A sphere with a sink in front, a source behind and a saddle at the right. Seen along -y.
class FlowPanelTest : public ImGuiFrames {
 protected:
  void SetUp() override {
    const Surface sphere = icosphere(2);
    results_.data.array = "velocity";
    results_.tree = std::make_shared<TriangleTree>(sphere.points, sphere.triangles);
    auto lines = std::make_shared<FlowLines>();
    add(*lines, CriticalKind::saddle, {1, 0, 0}, 0.5);
    add(*lines, CriticalKind::source, {0, 1, 0}, 0.9);
    add(*lines, CriticalKind::sink, {0, -1, 0}, 0.7);
    results_.lines = lines;
    session_.settings.topology = true;
    session_.camera = Camera{{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 3};
    begin(400, 600);
    frame();
    frame();
  }

  void add(FlowLines& lines, CriticalKind kind, const Vec3d& at, double persistence) {
    const auto hit = results_.tree->first(at * 2.0, -at);
    CriticalPoint point;
    point.kind = kind;
    point.position = hit->position;
    point.triangle = hit->triangle;
    point.persistence = persistence;
    lines.skeleton.topology.points.push_back(point);
  }

  void draw() override {
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(400, 600));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    panel_.result_tab(session_);
    ImGui::End();
  }

  /// All cameras that clicks into the panel lead to, from below to above: the header over the list closes it.
  std::vector<Camera> cameras() {
    std::vector<Camera> found;
    const Camera start = *session_.camera;
    for (float y = 598; y > 0; y -= 4) {
      session_.camera = start;
      click(60, y);
      if (length(session_.camera->target - start.target) > 0.1 &&
          (found.empty() || length(found.back().target - session_.camera->target) > 0.1))
        found.push_back(*session_.camera);
    }
    return found;
  }

  FlowResults results_;
  FlowPanel panel_{results_};
  Session session_;
};

TEST_F(FlowPanelTest, AClickOnACriticalPointGoesToWhereItIsSeen) {
  std::vector<Camera> found = cameras();
  std::reverse(found.begin(), found.end());
  ASSERT_EQ(found.size(), 3u);
  EXPECT_LT(length(found[0].target - Vec3d(0, 1, 0)), 0.05) << "the most persistent is the first";
  EXPECT_GT(found[0].eye.y, 1) << "it lies behind: the camera goes round";
  EXPECT_LT(length(found[1].target - Vec3d(0, -1, 0)), 0.05);
  EXPECT_LT(found[1].eye.y, -1);
  EXPECT_LT(length(found[2].target - Vec3d(1, 0, 0)), 0.05);
  EXPECT_GT(found[2].eye.x, 1) << "not along the surface";
  for (const Camera& camera : found) EXPECT_LT(camera.height, 3);
}

TEST_F(FlowPanelTest, ProbesArePlottedAndRemoved) {
  session_.settings.topology = false;
  session_.settings.probe = "0,1,0";
  FlowProbe probe;
  probe.times = {0, 1, 2};
  probe.speeds = {1, 3, 2};
  results_.probes = {probe};
  for (float y = 598; y > 0 && !session_.settings.probe.empty(); y -= 4) click(60, y);
  EXPECT_EQ(session_.settings.probe, "") << "there is a button below the plot";
}

TEST_F(FlowPanelTest, NoListWhereTopologyIsOff) {
  session_.settings.topology = false;
  EXPECT_TRUE(cameras().empty());
}

}  // namespace
}  // namespace nacre::test
