// Nacre: text is where it should be and survives any bytes.
#include "engine/picture/text.hpp"

#include <gtest/gtest.h>

#include "engine/picture/plain_text.hpp"
#include "engine/system/utf8.hpp"
#include "tests/engine/picture/test_images.hpp"

namespace nacre {
namespace {

constexpr Rgba white_paper{255, 255, 255, 255}, black{0, 0, 0, 255};

TEST(Utf8, ValidAndBroken) {
  std::string_view text = "a\u00b5\u2212\U0001F600\n";
  const char32_t expected[] = {U'a', 0xB5, 0x2212, 0x1F600, U' '};
  for (const char32_t point : expected) EXPECT_EQ(take_code_point(text), point);
  EXPECT_TRUE(text.empty());
  // A lone continuation, an overlong slash (two bytes), a surrogate (three), and a cut sequence.
  std::string_view broken = "\x80\xC0\xAF\xED\xA0\x80\xE2\x88";
  while (!broken.empty()) EXPECT_EQ(take_code_point(broken), char32_t(0xFFFD));
}

TEST(Utf8, WhatIsCutIsOfWholeCharacters) {
  EXPECT_EQ(in_utf8("d\u00e9coup\u00e9"), "d\u00e9coup\u00e9");
  EXPECT_EQ(in_utf8("d\u00e9coup\u00e9", 8), "d\u00e9coup");
  EXPECT_EQ(in_utf8("caf\xe9\tau lait"), "caf\ufffd au lait") << "Latin-1";
  EXPECT_EQ(in_utf8("\uffff", 2), "") << "no character, and no room to say so";
}

TEST(Text, CapitalsFillTheirHeight) {
  const Image blank = plain_image(100, 60, white_paper);
  Image image = blank;
  draw_text(image, 20, 15, "H", 30, black);
  const int cap = text_cap_height(30), width = text_width("H", 30);
  EXPECT_EQ(cap, 22);
  EXPECT_GT(changed_pixels(blank, image, 20, 15, 20 + width, 15 + cap), cap * 2);
  EXPECT_EQ(changed_pixels(blank, image), changed_pixels(blank, image, 20, 14, 20 + width, 16 + cap));
}

TEST(Text, WidthGrowsWithTextAndSize) {
  EXPECT_EQ(text_width("", 20), 0);
  EXPECT_GT(text_width("speed", 20), text_width("spee", 20));
  EXPECT_NEAR(text_width("velocity magnitude", 40), 2 * text_width("velocity magnitude", 20), 2);
}

TEST(Text, SignsOfScienceAreInTheFont) {
  if (text_width("WiWi", 200) == plain_text_width("WiWi", 200)) GTEST_SKIP() << "built without DejaVu Sans";
  Image missing = plain_image(40, 40, white_paper);
  draw_text(missing, 5, 8, "\U0010FFFD", 20, black);
  for (const char* sign : {"\u00b0", "\u00b7", "\u00b2", "\u00b3", "\u207b", "\u2079", "\u00b5", "\u03bc", "\u2212",
                           "\u00d7", "\u2026", "\u03c9"}) {
    Image image = plain_image(40, 40, white_paper);
    draw_text(image, 5, 8, sign, 20, black);
    EXPECT_GT(changed_pixels(image, plain_image(40, 40, white_paper)), 2) << sign;
    EXPECT_GT(changed_pixels(image, missing), 2) << sign << " is drawn as a missing one";
  }
}

TEST(Text, ReachesOverTheBordersWithoutHarm) {
  for (const auto& [x, y] : {std::pair{-50, -8}, {90, 10}, {5, 95}, {-5000, 0}, {5000, 5000}, {0, -5000}}) {
    Image image = plain_image(100, 100, white_paper);
    draw_text(image, x, y, "velocity", 24, black);
    draw_plain_text(image, x, y, "velocity", 24, black);
  }
  Image nothing;
  draw_text(nothing, 0, 0, "velocity", 24, black);
}

TEST(Text, AnyBytesAreDrawn) {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += char(i);
  Image image = plain_image(400, 40, white_paper);
  draw_text(image, 0, 10, bytes, 12, black);
  draw_plain_text(image, 0, 10, bytes, 12, black);
  EXPECT_GT(text_width(bytes, 12), 100);
  EXPECT_GT(plain_text_width(bytes, 12), 100);
}

TEST(Text, IsCutToFit) {
  EXPECT_EQ(text_to_fit("speed", 20, 500), "speed");
  const std::string cut = text_to_fit("a very long array name \u00b5\u00b5\u00b5\u00b5\u00b5\u00b5", 20, 150);
  EXPECT_LE(text_width(cut, 20), 150);
  EXPECT_EQ(cut.substr(cut.size() - 3), "\u2026");
  EXPECT_EQ(text_to_fit("speed", 20, 3), "");
  EXPECT_LE(text_width(text_to_fit(std::string(1 << 20, 'x'), 12, 200), 12), 200);
}

TEST(PlainText, CapitalsFillTheirHeight) {
  const Image blank = plain_image(60, 60, white_paper);
  Image image = blank;
  draw_plain_text(image, 10, 15, "H", 30, black);
  EXPECT_GT(changed_pixels(blank, image, 10, 15, 40, 38), 30);
  EXPECT_EQ(changed_pixels(blank, image), changed_pixels(blank, image, 9, 14, 40, 39));
  EXPECT_EQ(plain_text_width("\u00d710\u207b\u00b3", 30), plain_text_width("x10^-3", 30));
}

}  // namespace
}  // namespace nacre
