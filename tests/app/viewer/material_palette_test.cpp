// Nacre: tests of the colours of materials: the user's, the file's, the usual ones.
#include "engine/run/material_palette.hpp"

#include <gtest/gtest.h>

#include "engine/picture/material_colours.hpp"

namespace nacre {
namespace {

TEST(MaterialPalette, TheUsersColourGoesBeforeTheFilesAndThatBeforeTheUsualOne) {
  MeshInput input;
  input.labels = {0, 4, 7, 9};
  input.colours = {std::nullopt, Color{1, 0, 0}, Color{0, 1, 0}, std::nullopt};
  const std::vector<Color> palette = material_palette(input, "7:#0000ff, 12:#00ffff,9:blue");
  ASSERT_EQ(palette.size(), 4u);
  EXPECT_EQ(palette[1], (Color{1, 0, 0}));
  EXPECT_EQ(palette[2], (Color{0, 0, 1}));
  EXPECT_EQ(palette[3], material_colour(3));
}

TEST(MaterialPalette, ListsAreWrittenAsTheyAreRead) {
  const std::string colours = "-3:#102030,7:#ffffff", opacities = "-3:0.25,7:0";
  EXPECT_EQ(label_colour_text(parse_label_colours(colours)), colours);
  EXPECT_EQ(label_opacity_text(parse_label_opacities(opacities)), opacities);
  EXPECT_EQ(parse_label_opacities("1:7,2:-1,x:1,3:"), (std::map<std::int64_t, double>{{1, 1}, {2, 0}}));
  EXPECT_TRUE(parse_label_colours("nonsense").empty());
}

}  // namespace
}  // namespace nacre
