// Nacre: tests of rulers, notes and kept cameras. No OpenGL here.
#include "app/viewer/scene/marks.hpp"

#include <gtest/gtest.h>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

TEST(Marks, ARulerMeasuresLengthsAndTheAngleOfThreePoints) {
  const std::vector<Vec3d> points = parse_ruler("0 0 0;3 0 0; nonsense;3 4 0");
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(ruler_lines(points, "mm"), (std::vector<std::string>{"3 mm", "4 mm", "90.0°"}));
  EXPECT_EQ(ruler_lines(std::span(points).first(2), ""), std::vector<std::string>{"3"});
  EXPECT_TRUE(ruler_lines(std::span(points).first(1), "mm").empty());
  EXPECT_EQ(parse_ruler(ruler_text(points)), points);
}

TEST(Marks, NotesAreWrittenAsTheyAreRead) {
  const std::vector<PlacedNote> notes{{{1, 2, 3}, "stagnation; here"}, {{-1, 0, 0}, "b"}};
  const std::vector<PlacedNote> read = parse_notes(notes_text(notes));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].position, notes[0].position);
  EXPECT_EQ(read[0].text, "stagnation, here");  // a semicolon would part it
  EXPECT_EQ(read[1].text, "b");
  EXPECT_TRUE(parse_notes("1 2;1 2 3;").empty());
}

TEST(Marks, CamerasAreWrittenAsTheyAreRead) {
  Camera camera;
  camera.eye = {1, 2, 3};
  camera.height = 7.5;
  camera.orthographic = true;
  const std::vector<SavedCamera> kept = parse_cameras(cameras_text(std::vector<SavedCamera>{{"front: a", camera}}));
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].name, "front  a");
  EXPECT_EQ(kept[0].camera, camera);
  EXPECT_TRUE(parse_cameras("a:1 2 3;:0 0 1 0 0 0 0 1 0 2;b:0 0 0 0 0 0 0 1 0 2").empty());  // looks nowhere
}

TEST(Marks, TheSheetHasThemWhereTheCameraSeesThem) {
  View view;
  view.width = 300, view.height = 200;
  view.camera = {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 4, false};
  const auto middle = pixel_of(view, {0, 0, 0}), right = pixel_of(view, {1, 0, 0});
  ASSERT_TRUE(middle && right);
  EXPECT_NEAR((*middle)[0], 150, 1e-6);
  EXPECT_NEAR((*middle)[1], 100, 1e-6);
  EXPECT_NEAR((*right)[0], 200, 1e-6);  // 4 units are 200 pixels
  EXPECT_FALSE(pixel_of(view, {0, 0, 11}));
  const Image image = marks_sheet(view, "-1 0 0;1 0 0", "", "mm", {255, 255, 255, 255});
  EXPECT_GT(image.at(125, 100)[3], 200);  // the line
  EXPECT_EQ(image.at(125, 60)[3], 0);
  const Image none = marks_sheet(view, "", "", "", {255, 255, 255, 255});
  EXPECT_TRUE(std::all_of(none.pixels.begin(), none.pixels.end(), [](std::uint8_t byte) { return byte == 0; }));
}

}  // namespace
}  // namespace nacre
