// Nacre: clip planes: what the knobs say, where they cut a box, what dragging does. No OpenGL here.
#include "app/viewer/scene/clip.hpp"

#include <imgui_internal.h>

#include <cmath>

#include "app/viewer/panel/clip_panel.hpp"
#include "app/viewer/scene/clip_drag.hpp"
#include "tests/app/imgui_frames.hpp"

namespace nacre::test {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double most, const char* what = "") {
  EXPECT_LT(length(a - b), most) << what << ": " << a.x << ' ' << a.y << ' ' << a.z << " for " << b.x << ' ' << b.y
                                 << ' ' << b.z;
}

const std::vector<Vec3d> box_points{{-1, -2, -3}, {1, 2, 3}};
const BoxCorners box = bounding_corners(box_points);

TEST(Clip, PlanesAreWrittenAsTheyAreRead) {
  const std::vector<WorldPlane> planes = parse_clip_planes("0 0 2 1 2 3;nonsense;0 0 0 1 1 1;-1 0 0 4 5 6; 1 1");
  ASSERT_EQ(planes.size(), 2u);
  EXPECT_EQ(planes[0].normal, Vec3d(0, 0, 1)) << "a unit vector";
  EXPECT_EQ(planes[1].point, Vec3d(4, 5, 6));
  EXPECT_EQ(clip_planes_text(planes), "0 0 1 1 2 3;-1 0 0 4 5 6");
  std::string many;
  for (int k = 0; k < 9; ++k) many += "1 0 0 0 0 0;";
  EXPECT_EQ(parse_clip_planes(many).size(), most_clip_planes);
}

TEST(Clip, ThePlaneOfTheAxisAndTheOthersCutTogether) {
  ViewSettings view;
  EXPECT_TRUE(clip_planes(view, box_points).empty());
  view.clip = PlaneAxis::y;
  view.clip_at = 0.75;
  view.clip_planes = "1 1 0 0 0 0;0 0 -1 0 0 2";
  const ClipPlanes planes = clip_planes(view, box_points);
  ASSERT_EQ(planes.all().size(), 3u);
  EXPECT_FALSE(planes.cut({0, 1.5, 0}));
  EXPECT_TRUE(planes.cut({0, 0.5, 0})) << "below y = 1";
  EXPECT_TRUE(planes.cut({-1.8, 1.5, 0})) << "x + y < 0";
  EXPECT_TRUE(planes.cut({0, 1.5, 2.5})) << "above z = 2";
  view.clip_back = true;
  EXPECT_TRUE(clip_planes(view, box_points).cut({0, 1.5, 0}));
  EXPECT_EQ(clip_planes(view, {}).all().size(), 2u) << "there is no box for the axis";
}

TEST(Clip, AnOutlineIsWhereThePlaneCutsTheBox) {
  const std::vector<Vec3d> across = plane_outline({{0, 0, 1}, {7, 7, 0.5}}, box);
  ASSERT_EQ(across.size(), 4u);
  double around = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(across[k].z, 0.5, 1e-12);
    around += length(across[(k + 1) % 4] - across[k]);
  }
  EXPECT_NEAR(around, 12, 1e-9) << "in their order around it";
  const BoxCorners cube = bounding_corners(std::vector<Vec3d>{{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(plane_outline({normalized(Vec3d(1, 1, 1)), {0.5, 0.5, 0.5}}, cube).size(), 6u);
  EXPECT_EQ(plane_outline({normalized(Vec3d(1, 1, 1)), {0.1, 0, 0}}, cube).size(), 3u);
  EXPECT_TRUE(plane_outline({{1, 0, 0}, {1.5, 0, 0}}, cube).empty());
  EXPECT_EQ(offset_range({0, -1, 0}, box), (std::array<double, 2>{-2, 2}));
}

PictureArea picture_of(bool orthographic) {
  PictureArea picture;
  picture.camera = {{3, -14, 5}, {0, 0, 0}, {0, 0, 1}, 10, orthographic};
  picture.area = {100, 50, 400, 300};
  return picture;
}

TEST(ClipDrag, APlaneIsPushedToWhereTheMouseIs) {
  for (const bool orthographic : {false, true}) {
    const PictureArea picture = picture_of(orthographic);
    const WorldPlane plane{normalized(Vec3d(1, 0.3, 0.2)), {0, 0, 0}};
    const auto wanted = picture.pixel_of(plane.normal * 0.7);
    ASSERT_TRUE(wanted);
    const WorldPlane moved = pushed_to(plane, box, picture, (*wanted)[0], (*wanted)[1]);
    EXPECT_EQ(moved.normal, plane.normal);
    expect_near(moved.point, plane.normal * 0.7, 1e-6);
    const auto far = picture.pixel_of(plane.normal * 30);
    const WorldPlane last = pushed_to(plane, box, picture, (*far)[0], (*far)[1]);
    EXPECT_NEAR(last.offset(), offset_range(plane.normal, box)[1], 1e-9) << "not out of the box";
  }
}

TEST(ClipDrag, APlaneThatIsSeenFromTheFrontGoesAwayUpwards) {
  const PictureArea picture = picture_of(true);
  const Vec3d forward = picture.camera.forward();
  for (const double side : {1.0, -1.0}) {
    const WorldPlane plane{forward * side, {0, 0, 0}};
    const auto seen = picture.pixel_of(plane.point);
    const WorldPlane moved = pushed_to(plane, box, picture, (*seen)[0], (*seen)[1] - 30);
    expect_near(moved.point, forward * (30 * 10 / 300.0), 1e-9);
  }
}

TEST(ClipDrag, APlaneIsTurnedToWhereTheMouseIs) {
  for (const bool orthographic : {false, true}) {
    const PictureArea picture = picture_of(orthographic);
    for (const Vec3d& start : {Vec3d(1, -0.5, 0.2), Vec3d(1, 2, 0.2)}) {  // towards the eye, and away from it
      const WorldPlane plane{normalized(start), {0.2, 0.1, 0}};
      const Vec3d wanted = normalized(start + Vec3d(-0.3, 0, 0.5));
      const auto tip = picture.pixel_of(plane.point + wanted * 1.5);
      const WorldPlane turned = turned_to(plane, 1.5, picture, (*tip)[0], (*tip)[1]);
      expect_near(turned.normal, wanted, 1e-6);
      EXPECT_EQ(turned.point, plane.point);
      const WorldPlane aside = turned_to(plane, 1.5, picture, 480, 200);  // the arrow does not reach so far
      EXPECT_NEAR(length(aside.normal), 1, 1e-12);
      EXPECT_NEAR(dot(aside.normal, picture.ray_through(480, 200).along), 0, 1e-9);
    }
  }
}

TEST(ClipDrag, TheHandleIsInTheBox) {
  const auto inside = handle_of({{0, 0, 1}, {0.5, 0.5, 1}}, box), outside = handle_of({{0, 0, 1}, {9, 0, 1}}, box);
  ASSERT_TRUE(inside && outside);
  EXPECT_EQ(*inside, Vec3d(0.5, 0.5, 1));
  expect_near(*outside, {0, 0, 1}, 1e-9);
  EXPECT_FALSE(handle_of({{0, 0, 1}, {0, 0, 4}}, box));
}

class ClipPanelTest : public ImGuiFrames {
 protected:
  static constexpr float wide = 300, width = 900, height = 600;

  void SetUp() override {
    begin(width, height);
    picture_.camera = {{0, -14, 0}, {0, 0, 0}, {0, 0, 1}, 10, true};
    picture_.area = {300, 0, 600, 600};
    panel_.add_facing(settings_, box_points, picture_.camera);
    for (int k = 0; k < 3; ++k) frame();
  }

  void draw() override {
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(wide, height));
    if (in_sight_) {
      ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBringToFrontOnFocus);
      panel_.draw(settings_, box_points, picture_.camera);
      ImGui::End();
    }
    panel_.draw_handle(settings_.view, box_points, picture_);
  }

  WorldPlane plane(std::size_t k = 0) const { return parse_clip_planes(settings_.view.clip_planes).at(k); }
  /// Frames of the mouse down at one pixel and up at another; busy: in all of them until it is up.
  void drag(const std::array<double, 2>& from, const std::array<double, 2>& to) {
    move(float(from[0]), float(from[1]));
    frame();
    ImGui::GetIO().MouseDown[0] = true;
    frame();
    EXPECT_TRUE(ImGui::IsAnyItemActive()) << "what undo takes for one change";
    EXPECT_TRUE(ImGui::GetIO().WantCaptureMouse) << "the camera does not move";
    for (const double share : {0.5, 1.0}) {
      move(float(from[0] + share * (to[0] - from[0])), float(from[1] + share * (to[1] - from[1])));
      frame();
      EXPECT_TRUE(ImGui::IsAnyItemActive());
    }
    ImGui::GetIO().MouseDown[0] = false;
    frame();
    frame();
    EXPECT_FALSE(ImGui::IsAnyItemActive());
  }
  std::array<double, 2> pixel(const Vec3d& p) const { return *picture_.pixel_of(p); }

  bool in_sight_ = true;
  Settings settings_;
  ClipPanel panel_;
  PictureArea picture_;
};

TEST_F(ClipPanelTest, TheKeyAddsAPlaneThatFacesTheCamera) {
  EXPECT_EQ(settings_.view.tab, PanelTab::look);
  expect_near(plane().normal, {0, 1, 0}, 1e-6);
  expect_near(plane().point, {0, 0, 0}, 1e-6);
  panel_.add_facing(settings_, box_points, picture_.camera);
  EXPECT_EQ(parse_clip_planes(settings_.view.clip_planes).size(), 2u);
}

TEST_F(ClipPanelTest, DraggingTheHandlePushesThePlane) {
  settings_.view.clip_planes = "1 0 0 0 0 0";
  frame();
  frame();
  drag(pixel({0, 0, 0}), pixel({0.5, 0, 0.4}));
  expect_near(plane().point, {0.5, 0, 0}, 1e-3);
  EXPECT_EQ(plane().normal, Vec3d(1, 0, 0));
  drag(pixel({0.5, 0, 0}), pixel({9, 0, 0}));
  expect_near(plane().point, {1, 0, 0}, 1e-3, "not out of the box");
}

TEST_F(ClipPanelTest, DraggingTheArrowsHeadTurnsThePlane) {
  settings_.view.clip_planes = "1 0 0 0 0 0";
  frame();
  frame();
  const double arrow = 5 * double(ImGui::GetFontSize()) * picture_.pixel_size({0, 0, 0});
  const Vec3d wanted = normalized(Vec3d(1, 0, 1));
  drag(pixel({arrow, 0, 0}), pixel(wanted * arrow));
  const Vec3d n = plane().normal;  // whole pixels leave it open how far the tip is towards the eye
  expect_near({n.x, 0, n.z}, wanted, 0.02);
  expect_near(plane().point, {0, 0, 0}, 1e-6);
}

TEST_F(ClipPanelTest, ThePlaneOfTheAxisIsPushedAndNotTurned) {
  settings_.view.clip_planes.clear();
  settings_.view.clip = PlaneAxis::x;
  frame();
  frame();
  drag(pixel({0, 0, 0}), pixel({0.5, 0, 0}));
  EXPECT_NEAR(settings_.view.clip_at, 0.75, 1e-3);
  const double arrow = 5 * double(ImGui::GetFontSize()) * picture_.pixel_size({0, 0, 0});
  const auto head = pixel({0.5 + arrow, 0, 0});
  move(float(head[0]), float(head[1]));
  frame();
  frame();
  EXPECT_FALSE(over_);
}

TEST_F(ClipPanelTest, ThereIsNoHandleWhereTheSectionIsNotSeen) {
  const auto at = pixel({0, 0, 0});
  move(float(at[0]), float(at[1]));
  frame();
  EXPECT_TRUE(over_);
  in_sight_ = false;
  frame();
  frame();
  EXPECT_FALSE(over_);
}

}  // namespace
}  // namespace nacre::test
