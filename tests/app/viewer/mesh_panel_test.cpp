// Nacre: the buttons of the tab "result" of a mesh, each clicked where it is found. No OpenGL here.
#include "app/viewer/panel/mesh_panel.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <map>
#include <memory>
#include <set>

#include "app/viewer/panel/imgui_text.hpp"
#include "engine/picture/material_colours.hpp"
#include "engine/run/material_palette.hpp"

namespace nacre {
namespace {

/// Two triangles between three materials, with all figures that the panel shows.
MeshResults small_results() {
  MeshResults results;
  auto volume = std::make_shared<ViewedVolume>();
  volume->input.labels = {0, 4, 7};
  volume->input.names = {"", "liver", ""};
  volume->input.voxels = {50, 20, 30};
  auto mesh = std::make_shared<SurfaceMesh>();
  mesh->points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {10, 0, 0}, {13, 0, 0}, {10, 3, 0}};
  mesh->triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh->materials = {{0, 1}, {1, 2}};
  auto measures = std::make_shared<MeshMeasures>();
  measures->topology.materials.resize(3);
  measures->worst = {{0.11, 1}, {0.42, 0}};
  results.volume = volume;
  results.mesh = mesh;
  results.measures = measures;
  return results;
}

class MeshPanelTest : public testing::Test {
 protected:
  static constexpr int width = 420, height = 900;

  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(width, height);
    io.IniFilename = nullptr;
    unsigned char* pixels;
    int across, down;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &across, &down);
    session_.camera = start_;
    frame(-1, -1, false);
    frame(-1, -1, false);  // sizes are known from the second one on
  }

  void TearDown() override { ImGui::DestroyContext(); }

  /// Draws the panel with the mouse there; true where it is over something.
  bool frame(float x, float y, bool down) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 0.4f;  // no click is a double click
    io.MousePos = ImVec2(x, y);
    io.MouseDown[0] = down;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    panel_.result_tab(session_);
    ImGui::End();
    const bool over = ImGui::IsAnyItemHovered();
    ImGui::EndFrame();
    return over;
  }

  void click(float x, float y) {
    frame(x, y, false);
    frame(x, y, true);
    frame(x, y, false);
  }

  /// Clicks everything that the mouse can be over, each from the same session, and notes what comes of it.
  void click_everything() {
    const Session before = session_;
    for (int y = 4; y < height; y += 8)
      for (int x = 4; x < width; x += 8) {
        if (!frame(float(x), float(y), false)) continue;
        click(float(x), float(y));
        const ViewSettings& look = session_.settings.view;
        hidden_.insert(look.hidden);
        ghosts_.insert(look.ghosts);
        for (const auto& [label, opacity] : parse_label_opacities(look.opacity)) opacities_[label].insert(opacity);
        if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0) {
          ++popups_;
          ImGui::ClosePopupToLevel(0, false);
          frame(-1, -1, false);
        }
        if (*session_.camera != *before.camera) {
          cameras_[session_.camera->target.x] = *session_.camera;
          highlighted_[session_.camera->target.x] = look.worst;
        }
        if (!session_change(before, session_)) click(float(x), float(y));  // a header that has been closed
        session_ = before;
      }
  }

  const Camera start_{{0, 0, 20}, {0, 0, 0}, {0, 1, 0}, 10, false};
  MeshResults results_ = small_results();
  MeshPanel panel_{results_};
  Session session_;
  std::set<std::string> hidden_, ghosts_;
  std::map<std::int64_t, std::set<double>> opacities_;  ///< by label
  int popups_ = 0;
  std::map<double, Camera> cameras_;  ///< by what they look at
  std::map<double, int> highlighted_;
};

TEST_F(MeshPanelTest, MaterialsAreHiddenGhostedAndShownAlone) {
  click_everything();
  EXPECT_EQ(hidden_, (std::set<std::string>{"", "4", "7", "4,7"}));  // "only" hides the other one
  EXPECT_EQ(ghosts_, (std::set<std::string>{"", "4,7"}));
  for (const std::int64_t label : {4, 7}) {  // by a slider each
    ASSERT_FALSE(opacities_[label].empty());
    EXPECT_LT(*opacities_[label].begin(), 0.3);
    EXPECT_GT(*opacities_[label].rbegin(), 0.6);
  }
  EXPECT_GT(popups_, 1);  // swatches that edit
  hidden_.clear(), ghosts_.clear();
  session_.settings.view.hidden = "4";
  session_.settings.view.ghosts = "7";
  click_everything();
  EXPECT_EQ(hidden_, (std::set<std::string>{"4", "", "4,7", "7"}));  // show, hide the other, only the first
  EXPECT_EQ(ghosts_, (std::set<std::string>{"7", "", "4,7"}));
}

TEST_F(MeshPanelTest, AClickOnOneOfTheWorstLooksAtIt) {
  click_everything();
  ASSERT_EQ(cameras_.size(), 2u);
  for (const WorstTriangle& worst : results_.measures->worst) {
    const Triangle& t = results_.mesh->triangles[worst.triangle];
    const std::vector<Vec3d>& p = results_.mesh->points;
    const Vec3d middle = (p[t.a] + p[t.b] + p[t.c]) / 3.0;
    ASSERT_TRUE(cameras_.contains(middle.x));
    const Camera& camera = cameras_[middle.x];
    EXPECT_NEAR(length(camera.target - middle), 0, 1e-12);
    EXPECT_LT(dot(camera.forward(), Vec3d(0, 0, 1)), -0.9);  // from in front of it
    EXPECT_LE(camera.height, start_.height);
  }
  EXPECT_EQ(hidden_, (std::set<std::string>{"", "4", "7", "4,7"}));
}

/// As a CT's labels are: more than can be seen at once.
MeshResults many_materials() {
  MeshResults results;
  auto volume = std::make_shared<ViewedVolume>();
  for (std::int64_t label = 0; label <= 62; ++label) {
    volume->input.labels.push_back(label);
    volume->input.names.push_back(label % 20 == 5 ? fmt::format("Vertebra {}", label) : "organ");
    volume->input.voxels.push_back(std::size_t(1000 + (label * 37) % 62));
  }
  results.volume = volume;
  return results;
}

TEST_F(MeshPanelTest, OfManyMaterialsThoseThatAreFoundAreHiddenAtOnce) {
  results_ = many_materials();
  frame(-1, -1, false);
  click_everything();
  EXPECT_FALSE(hidden_.contains("5,25,45"));
  float field = 4;  // to find one in
  for (; field < height; field += 8) {
    frame(30, field, false);
    if (ImGui::GetMouseCursor() == ImGuiMouseCursor_TextInput) break;
  }
  ASSERT_LT(field, height);
  click(30, field);
  for (const char letter : std::string("vERT")) {
    ImGui::GetIO().AddInputCharacter(unsigned(letter));
    frame(-1, -1, false);
  }
  hidden_.clear(), ghosts_.clear();
  click_everything();
  EXPECT_TRUE(hidden_.contains("5,25,45"));
  EXPECT_TRUE(ghosts_.contains("5,25,45"));
}

TEST(MaterialColours, SixtyDiffer) {
  double nearest = 1;
  for (int a = 1; a <= 62; ++a)
    for (int b = 1; b < a; ++b) {
      const Color p = material_colour(a), q = material_colour(b);
      nearest = std::min(nearest, double(std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2])));
    }
  EXPECT_GT(nearest, 0.04);  // ten shades of a screen's 256, over its three colours
}

TEST(Arguments, LongNumbersAreGrouped) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(-1234567), "-1,234,567");
  EXPECT_EQ(grouped(-999), "-999");
}

TEST_F(MeshPanelTest, OuterTrianglesAreSeenFromOutsideAndStandOut) {
  session_.camera->eye = {3, 4, -20};
  click_everything();
  ASSERT_EQ(cameras_.size(), 2u);
  EXPECT_LT(cameras_.begin()->second.forward().z, -0.3) << "one to the outside, which was behind it";
  EXPECT_GT(cameras_.rbegin()->second.forward().z, 0.3) << "one between two materials";
  EXPECT_EQ(highlighted_.begin()->second, 2) << "the second of the list";
  EXPECT_EQ(highlighted_.rbegin()->second, 1);
}

TEST_F(MeshPanelTest, FlatViewsAreTurnedTowardsTheTriangle) {
  session_.camera->eye = {20, 0, 0};  // along its plane
  click_everything();
  ASSERT_EQ(cameras_.size(), 2u);
  for (const auto& [x, camera] : cameras_) EXPECT_GT(std::abs(camera.forward().z), 0.3) << x;
}

}  // namespace
}  // namespace nacre
