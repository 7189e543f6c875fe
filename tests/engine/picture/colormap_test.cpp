// Nacre: colour maps are uniform, as light as they claim, and safe for colour-blind readers.
#include "engine/picture/colormap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/picture/oklab.hpp"

namespace nacre {
namespace {

Color linear_of(const Color& srgb) {
  return {linear_from_srgb(srgb[0]), linear_from_srgb(srgb[1]), linear_from_srgb(srgb[2])};
}

/// CIE L*, which the maps were not built with: an independent judge of lightness.
float cie_lightness(const Color& srgb) {
  const Color c = linear_of(srgb);
  const float y = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
  return y > 216.f / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

float difference(const Color& linear_a, const Color& linear_b) {
  const Color a = oklab_from_linear(linear_a), b = oklab_from_linear(linear_b);
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// What someone without green cones sees (Machado, Oliveira and Fernandes 2009, severity 1), linear light.
Color deuteranope(const Color& srgb) {
  const auto [r, g, b] = linear_of(srgb);
  const Color seen = {0.367322f * r + 0.860646f * g - 0.227968f * b, 0.280085f * r + 0.672501f * g + 0.047413f * b,
                      -0.011820f * r + 0.042940f * g + 0.968881f * b};
  return {std::clamp(seen[0], 0.f, 1.f), std::clamp(seen[1], 0.f, 1.f), std::clamp(seen[2], 0.f, 1.f)};
}

/// Maps that are computed here; the others are what their authors have published.
std::vector<std::string> own_names() {
  std::vector<std::string> names = colormap_names();
  const std::set<std::string> published{"viridis", "cividis", "turbo", "coolwarm", "twilight"};
  std::erase_if(names, [&](const std::string& name) { return published.contains(name); });
  return names;
}

TEST(Oklab, KnownColours) {
  const Color white = oklab_from_linear({1, 1, 1}), red = oklab_from_linear({1, 0, 0});
  EXPECT_NEAR(white[0], 1, 1e-4);
  EXPECT_NEAR(white[1], 0, 1e-4);
  EXPECT_NEAR(white[2], 0, 1e-4);
  EXPECT_NEAR(red[0], 0.628f, 1e-3);
  EXPECT_NEAR(red[1], 0.225f, 1e-3);
  EXPECT_NEAR(red[2], 0.126f, 1e-3);
  const Color back = linear_from_oklab(oklab_from_linear({0.2f, 0.5f, 0.7f}));
  EXPECT_NEAR(back[0], 0.2f, 1e-4);
  EXPECT_NEAR(back[1], 0.5f, 1e-4);
  EXPECT_NEAR(back[2], 0.7f, 1e-4);
  EXPECT_NEAR(srgb_from_linear(linear_from_srgb(0.4f)), 0.4f, 1e-6);
  EXPECT_NEAR(linear_from_srgb(0.5f), 0.21404f, 1e-4);
}

TEST(Colormap, EveryKindIsThereAndTheDefaultIsSequential) {
  const auto names = colormap_names();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(colormap(names[0]).kind, "sequential");
  for (const char* kind : {"sequential", "diverging", "cyclic", "gray"})
    EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const auto& n) { return colormap(n).kind == kind; }))
        << kind;
  for (const std::string& name : names) {
    EXPECT_EQ(colormap(name).name, name);
    ASSERT_EQ(colormap(name).table.size(), 256u);
  }
}

TEST(Colormap, UnknownNameListsTheKnown) {
  try {
    colormap("no such map");
    FAIL() << "no error";
  } catch (const Error& error) {
    for (const std::string& name : colormap_names())
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
  }
}

TEST(Colormap, LiesInsideTheGamut) {
  // A colour that was clipped has a channel at exactly 0 or 1.
  for (const std::string& name : own_names())
    for (std::size_t i = 1; i + 1 < 256; ++i)
      for (const float c : colormap(name).table[i]) {
        EXPECT_GT(c, 0) << name << " " << i;
        EXPECT_LT(c, 1) << name << " " << i;
      }
}

TEST(Colormap, SequentialLightnessRisesNearlyLinearly) {
  for (const std::string& name : own_names()) {
    const Colormap& map = colormap(name);
    if (map.kind != "sequential" && map.kind != "gray") continue;
    const float first = cie_lightness(map.table.front()), last = cie_lightness(map.table.back());
    EXPECT_GT(last - first, 60) << name;
    for (int i = 1; i < 256; ++i) {
      const float lightness = cie_lightness(map.table[i]);
      EXPECT_GT(lightness, cie_lightness(map.table[i - 1])) << name << " " << i;
      EXPECT_NEAR(lightness, first + (last - first) * float(i) / 255, 0.06f * (last - first)) << name << " " << i;
    }
  }
}

TEST(Colormap, NeighboursDifferByTheSame) {
  for (const std::string& name : own_names()) {
    const Colormap& map = colormap(name);
    std::vector<float> steps;
    for (int i = 1; i < 256; ++i) steps.push_back(difference(linear_of(map.table[i]), linear_of(map.table[i - 1])));
    // The two steps across a diverging map's centre turn back towards where they came from.
    if (map.kind == "diverging") steps.erase(steps.begin() + 126, steps.begin() + 129);
    const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
    EXPECT_LT(*most / *least, 1.1f) << name;
  }
}

TEST(Colormap, DivergingIsSymmetricAboutANeutralCentre) {
  for (const std::string& name : own_names()) {
    const Colormap& map = colormap(name);
    if (map.kind != "diverging") continue;
    for (int i = 0; i < 128; ++i)
      EXPECT_NEAR(cie_lightness(map.table[i]), cie_lightness(map.table[255 - i]), 4) << name << " " << i;
    for (int i = 1; i < 128; ++i) EXPECT_GT(cie_lightness(map.table[i]), cie_lightness(map.table[i - 1])) << i;
    const Color centre = oklab_from_linear(linear_of(map.table[127]));
    EXPECT_GT(centre[0], 0.9f);
    EXPECT_LT(std::hypot(centre[1], centre[2]), 0.01f);
    EXPECT_GT(map.table.front()[2], map.table.front()[0]) << "low is blue";
    EXPECT_GT(map.table.back()[0], map.table.back()[2]) << "high is red";
  }
}

TEST(Colormap, CyclicClosesWithOneMoreStep) {
  for (const std::string& name : own_names()) {
    const Colormap& map = colormap(name);
    if (map.kind != "cyclic") continue;
    const float step = difference(linear_of(map.table[0]), linear_of(map.table[1]));
    EXPECT_NEAR(difference(linear_of(map.table[255]), linear_of(map.table[0])), step, 0.1f * step);
  }
}

TEST(Colormap, StaysReadableWithoutGreenCones) {
  // Any two colours a tenth of the map apart must differ, for a deuteranope, by half of what others see or more.
  for (const std::string& name : own_names()) {
    const Colormap& map = colormap(name);
    for (int i = 0; i + 26 < 256; ++i) {
      const bool across_centre = map.kind == "diverging" && i > 101 && i < 128;
      if (across_centre) continue;
      const float seen = difference(deuteranope(map.table[i]), deuteranope(map.table[i + 26]));
      EXPECT_GT(seen, 0.5f * difference(linear_of(map.table[i]), linear_of(map.table[i + 26]))) << name << " " << i;
    }
  }
  // The two halves of a diverging or cyclic map pass through the same lightness: their hues must tell them apart.
  for (const std::string& name : own_names()) {
    const Colormap& map = colormap(name);
    if (map.kind != "diverging" && map.kind != "cyclic") continue;
    EXPECT_GT(difference(deuteranope(map.table[64]), deuteranope(map.table[191])), 0.1f) << name;
  }
}

/// Bytes of a colour.
std::array<int, 3> bytes_of(const Color& srgb) {
  std::array<int, 3> bytes;
  for (std::size_t k = 0; k < 3; ++k) bytes[k] = int(std::lround(255 * srgb[k]));
  return bytes;
}

TEST(Colormap, PublishedMapsHaveTheirPublishedColours) {
  using Bytes = std::array<int, 3>;
  EXPECT_EQ(bytes_of(colormap("viridis").table[0]), (Bytes{68, 1, 84}));
  EXPECT_EQ(bytes_of(colormap("viridis").table[128]), (Bytes{33, 145, 140}));
  EXPECT_EQ(bytes_of(colormap("viridis").table[255]), (Bytes{253, 231, 37}));
  EXPECT_EQ(bytes_of(colormap("cividis").table[0]), (Bytes{0, 34, 78}));
  EXPECT_EQ(bytes_of(colormap("cividis").table[255]), (Bytes{254, 232, 56}));
  // Moreland's table: its ends and, within rounding, its middle.
  EXPECT_EQ(bytes_of(colormap("coolwarm").table[0]), (Bytes{59, 76, 192}));
  EXPECT_EQ(bytes_of(colormap("coolwarm").table[255]), (Bytes{180, 4, 38}));
  for (const int channel : bytes_of(colormap("coolwarm").table[127])) EXPECT_NEAR(channel, 221, 2);
}

TEST(Colormap, PublishedMapsAreOfTheKindThatTheySay) {
  for (const char* name : {"viridis", "cividis"})
    for (std::size_t i = 1; i < 256; ++i)
      EXPECT_GT(cie_lightness(colormap(name).table[i]), cie_lightness(colormap(name).table[i - 1]) - 0.05f) << name;
  const Colormap& circle = colormap("twilight");
  const float step = difference(linear_of(circle.table[0]), linear_of(circle.table[1]));
  EXPECT_NEAR(difference(linear_of(circle.table[255]), linear_of(circle.table[0])), step, 0.6f * step);
  const Colormap& rainbow = colormap("turbo");
  for (const Color& colour : rainbow.table)
    for (const float c : colour) EXPECT_TRUE(c >= 0 && c <= 1);
  EXPECT_GT(rainbow.table[60][2], rainbow.table[60][0]) << "low is blue";
  EXPECT_GT(rainbow.table[128][1], rainbow.table[128][2]) << "the middle is green";
  EXPECT_GT(rainbow.table[220][0], rainbow.table[220][2]) << "high is red";
}

}  // namespace
}  // namespace nacre
