// Nacre: the layout with three slices: how the picture is cut, how slices lie, outlines of a mesh, the mouse.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "app/viewer/mesh/mesh_outline.hpp"
#include "app/viewer/mesh/ortho_slice.hpp"
#include "app/viewer/panel/slice_mouse.hpp"
#include "app/viewer/scene/clip_drag.hpp"
#include "app/viewer/scene/layout.hpp"
#include "tests/app/imgui_frames.hpp"

namespace nacre::test {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double most) {
  EXPECT_LT(length(a - b), most) << a.x << ' ' << a.y << ' ' << a.z << " for " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(Layout, TheCrosshairIsWrittenAsItIsRead) {
  EXPECT_EQ(parse_crosshair("0.25 0 1"), Vec3d(0.25, 0, 1));
  EXPECT_EQ(crosshair_text(parse_crosshair("0.25 0 1")), "0.25 0 1");
  EXPECT_EQ(parse_crosshair("-3 0.5 7"), Vec3d(0, 0.5, 1));
  EXPECT_EQ(parse_crosshair("here"), Vec3d(0.5));
}

TEST(Layout, FourPartsCoverTheArea) {
  const FreeArea area{100, 20, 641, 481};
  const ViewAreas areas = view_areas(ViewLayout::slices, true, area);
  int pixels = areas.view.width * areas.view.height;
  for (const FreeArea& part : areas.slices) {
    pixels += part.width * part.height;
    EXPECT_GE(part.x, area.x);
    EXPECT_LE(part.x + part.width, area.x + area.width);
    EXPECT_LE(part.y + part.height, area.y + area.height);
  }
  EXPECT_EQ(pixels, 641 * 481);
  EXPECT_EQ(view_areas(ViewLayout::slices, false, area).view.width, 641) << "a flow has no slices";
  EXPECT_EQ(view_areas(ViewLayout::single, true, area).view.height, 481);
  const ViewAreas alone = view_areas(ViewLayout::y, true, area);
  EXPECT_FALSE(alone.has_view);
  EXPECT_EQ(alone.slices[1].width, 641);
  EXPECT_EQ(alone.slices[0].width, 0);
}

/// 10 by 20 by 30 voxels, whose axes run along y, -z and x of the world.
ViewedVolume turned_volume(const std::string& space) {
  ViewedVolume v;
  v.input.dims = {10, 20, 30};
  v.input.spacing = {1, 2, 1};
  v.input.origin = {5, 6, 7};
  v.input.axes = {Vec3d(0, 1, 0), Vec3d(0, 0, -1), Vec3d(1, 0, 0)};
  v.input.labels = {0, 1};
  v.input.unit = "mm";
  v.material.assign(6000, 1);
  Volume volume;
  volume.space = space;
  v.volumes = std::make_shared<const std::vector<Volume>>(std::vector<Volume>{volume});
  return v;
}

TEST(OrthoSlice, LiesAcrossTheAxisOfTheVolumeThatRunsMostAlongThatOfTheWorld) {
  const ViewedVolume v = turned_volume("");
  EXPECT_EQ(volume_axes(v.input), (std::array<int, 3>{2, 0, 1}));
  const Vec3d shares = crosshair_shares(v.input, {3, 4, 25});
  EXPECT_EQ(crosshair_voxel(v.input, shares), Int3(3, 4, 25));
  EXPECT_EQ(crosshair_voxel(v.input, crosshair_shares(v.input, {-7, 99, 25.4})), Int3(0, 19, 25));
  const OrthoSlice x = ortho_slice(v, shares, 0), z = ortho_slice(v, shares, 2);
  EXPECT_EQ(x.axis, 2);
  EXPECT_EQ(x.layer, 25);
  expect_near(x.right, {0, 1, 0}, 1e-12);
  expect_near(x.up, {0, 0, 1}, 1e-12);
  EXPECT_NEAR(x.width, 10, 1e-12);
  EXPECT_NEAR(x.height, 40, 1e-12);
  EXPECT_NEAR(x.plane.corner.x, 5 + 25, 1e-12) << "through the centres of voxels";
  expect_near(z.right, {1, 0, 0}, 1e-12);
  expect_near(z.up, {0, 1, 0}, 1e-12);
  const SliceCaption caption = ortho_caption(v, z, 2);
  EXPECT_EQ(caption.position, "z = -1 mm, voxel 4 of 0 to 19");
  EXPECT_EQ(caption.left + caption.right + caption.bottom + caption.top, "-x+x-y+y");
}

TEST(OrthoSlice, IsHeldAsRadiologistsDoWhereTheFileNamesDirections) {
  for (const char* space : {"right-anterior-superior", "left-posterior-superior"}) {
    const ViewedVolume v = turned_volume(space);
    const std::array<std::string, 3> wanted{"APIS", "RLIS", "RLPA"};
    for (int k = 0; k < 3; ++k) {
      const SliceCaption c = ortho_caption(v, ortho_slice(v, Vec3d(0.5), k), k);
      EXPECT_EQ(c.left + c.right + c.bottom + c.top, wanted[std::size_t(k)]) << space;
    }
  }
}

TEST(OrthoSlice, ItsCameraSeesAllOfItFromTheFront) {
  const ViewedVolume v = turned_volume("");
  for (int k = 0; k < 3; ++k)
    for (const double aspect : {0.5, 1.0, 3.0}) {
      const OrthoSlice slice = ortho_slice(v, Vec3d(0.3), k);
      const Camera camera = slice.camera(aspect);
      expect_near(camera.right(), slice.right, 1e-9);
      PictureArea picture{camera, {0, 0, int(600 * aspect), 600}};
      for (const Vec3d& corner : {slice.plane.corner, slice.plane.corner + slice.plane.across + slice.plane.up}) {
        const auto at = picture.pixel_of(corner);
        ASSERT_TRUE(at);
        EXPECT_TRUE((*at)[0] > 0 && (*at)[0] < 600 * aspect && (*at)[1] > 0 && (*at)[1] < 600) << k << ' ' << aspect;
      }
    }
}

/// A ball of `rings` by 2 `rings` quadrilaterals, of material 1 in the outside.
SurfaceMesh ball(double radius, int rings) {
  SurfaceMesh mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / around;
      mesh.points.push_back(
          {radius * std::sin(a) * std::cos(b), radius * std::sin(a) * std::sin(b), radius * std::cos(a)});
    }
  const auto at = [&](int i, int j) { return std::uint32_t(i * around + j % around); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  mesh.materials.assign(mesh.triangles.size(), {0, 1});
  return mesh;
}

TEST(MeshOutline, OfABallIsACircle) {
  const SurfaceMesh mesh = ball(5, 100);
  const Vec3d normal = normalized(Vec3d(1, 2, 2)), origin = normal * 3;
  const auto outline = mesh_outline(mesh, normal, origin, {false, true});
  ASSERT_EQ(outline.size(), 1u);
  double around = 0;
  for (const auto& [from, to] : outline.at(1)) {
    around += double(length(to - from));
    EXPECT_NEAR(dot(Vec3d(from), normal), 0, 1e-5) << "on the plane";
    EXPECT_NEAR(length(Vec3d(from)), 4, 0.01) << "3, 4, 5";
  }
  EXPECT_NEAR(around, 2 * std::numbers::pi * 4, 0.02);
  EXPECT_TRUE(mesh_outline(mesh, normal, normal * 5.1, {false, true}).empty());
  EXPECT_TRUE(mesh_outline(mesh, normal, origin, {false, false}).empty()) << "it is hidden";
}

TEST(MeshOutline, IsClosedWhereVerticesLieOnThePlane) {
  SurfaceMesh mesh = ball(5, 4);
  const auto outline = mesh_outline(mesh, {0, 0, 1}, {0, 0, 0}, {false, true});
  double around = 0;
  for (const auto& [from, to] : outline.at(1)) around += double(length(to - from));
  EXPECT_NEAR(around, 8 * 2 * 5 * std::sin(std::numbers::pi / 8), 1e-4) << "an octagon, once";
}

TEST(MeshOutline, OfAMillionTrianglesIsMadeAtOnce) {
  const SurfaceMesh mesh = ball(5, 500);
  ASSERT_EQ(mesh.triangles.size(), 1000000u);
  double best = 1;
  for (int k = 0; k < 5; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(mesh_outline(mesh, {1, 0, 0}, {0.37, 0, 0}, {false, true}).size(), 1u);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  RecordProperty("milliseconds", std::to_string(1e3 * best));
  std::cout << "outline of a million triangles: " << 1e3 * best << " ms\n";
  EXPECT_LT(best, 0.2) << "it is made while a slice is dragged";
}

/// Slices that say what was asked of them.
class ToldSlices : public SliceViews {
 public:
  mutable std::vector<std::string> told;
  Camera camera(int, double) const override {
    Camera camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 2, true};
    return camera;
  }
  void draw(int, const View&) override {}
  SliceCaption caption(int) const override { return {}; }
  std::string crosshair_at(int k, const Vec3d& p) const override {
    told.push_back(fmt::format("{}: {:.2f} {:.2f}", k, p.x + 0.0, p.y + 0.0));
    return "0.1 0.2 0.3";
  }
  std::string crosshair_after(int k, int steps) const override {
    told.push_back(fmt::format("{} by {}", k, steps));
    return "0.4 0.5 0.6";
  }
  std::optional<ProbeResult> probe(int k, const Vec3d& from, const Vec3d& along) const override {
    return ProbeResult{from + along * 2.0, {fmt::format("slice: {}", k)}};
  }
};

class SliceMouseTest : public ImGuiFrames {
 protected:
  void SetUp() override {
    begin(800, 600);
    view_.layout = ViewLayout::slices;
    for (int k = 0; k < 3; ++k) frame();
  }
  void draw() override { mouse_.draw(view_, slices_, view_areas(view_.layout, true, {0, 0, 800, 600})); }

  ViewSettings view_;
  ToldSlices slices_;
  SliceMouse mouse_;
};

TEST_F(SliceMouseTest, AClickMovesTheCrosshairAndIsNotTheCameras) {
  click(200, 150);  // the middle of the upper left part: across z
  ASSERT_FALSE(slices_.told.empty());
  EXPECT_EQ(slices_.told[0], "2: 0.00 0.00");
  EXPECT_EQ(view_.crosshair, "0.1 0.2 0.3");
  EXPECT_TRUE(ImGui::GetIO().WantCaptureMouse);
  slices_.told.clear();
  click(200, 300 + 75);  // across y, half-way up
  ASSERT_FALSE(slices_.told.empty());
  EXPECT_EQ(slices_.told[0], "1: 0.00 0.50");
  move(600, 150);  // the view
  frame();
  frame();
  EXPECT_FALSE(ImGui::GetIO().WantCaptureMouse);
  EXPECT_FALSE(mouse_.under());
}

TEST_F(SliceMouseTest, TheWheelGoesThroughTheSlices) {
  move(600, 450);
  frame();
  frame();
  EXPECT_TRUE(mouse_.under());
  slices_.told.clear();
  for (const float turn : {1.0f, 0.5f, 0.5f, -2.0f}) {
    ImGui::GetIO().MouseWheel = turn;
    frame();
  }
  EXPECT_EQ(slices_.told, (std::vector<std::string>{"0 by 1", "0 by 1", "0 by -2"}));
  EXPECT_EQ(view_.crosshair, "0.4 0.5 0.6");
}

TEST_F(SliceMouseTest, ADoubleClickShowsASliceAloneAndBack) {
  const auto twice = [&](float x, float y) {
    move(x, y);
    for (const bool down : {false, true, false, true, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      ImGui::GetIO().DeltaTime = 0.05f;
      ImGui::NewFrame();
      draw();
      ImGui::EndFrame();
    }
  };
  frame();
  twice(600, 450);
  EXPECT_EQ(view_.layout, ViewLayout::x);
  EXPECT_EQ(view_.crosshair, "0.5 0.5 0.5") << "the first click has not moved it for good";
  frame();
  frame();
  frame();
  twice(100, 100);
  EXPECT_EQ(view_.layout, ViewLayout::slices);
}

}  // namespace
}  // namespace nacre::test
