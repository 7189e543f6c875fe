// Nacre: colour maps as curves through OKLab, traversed at constant perceptual speed.
#include "engine/picture/colormap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "compute/device/error.hpp"
#include "engine/picture/colormap_tables.hpp"
#include "engine/picture/oklab.hpp"

namespace nacre {
namespace {

constexpr int table_size = 256;
constexpr int samples_per_span = 512;

/// A colour that a map passes through: OKLab's lightness (0..1), chroma, and hue in degrees.
struct Anchor {
  float lightness, chroma, hue;
};

Color oklab_of(const Anchor& anchor) {
  const float hue = anchor.hue * std::numbers::pi_v<float> / 180;
  return {anchor.lightness, anchor.chroma * std::cos(hue), anchor.chroma * std::sin(hue)};
}

float distance(const Color& p, const Color& q) { return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }

Color mix(const Color& p, const Color& q, float t) {
  return {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])};
}

/// A Catmull-Rom spline through the anchors; beyond the ends of an open one, the end spans are extended straight.
class Spline {
 public:
  Spline(const std::vector<Anchor>& anchors, bool closed) : closed_(closed) {
    for (const Anchor& anchor : anchors) points_.push_back(oklab_of(anchor));
  }

  int spans() const { return int(points_.size()) - (closed_ ? 0 : 1); }

  Color at(int span, float t) const {
    const Color p0 = point(span - 1), p1 = point(span), p2 = point(span + 1), p3 = point(span + 2);
    Color result;
    for (int k = 0; k < 3; ++k) {
      const float linear = p2[k] - p0[k];
      const float square = 2 * p0[k] - 5 * p1[k] + 4 * p2[k] - p3[k];
      const float cubic = 3 * p1[k] - p0[k] - 3 * p2[k] + p3[k];
      result[k] = 0.5f * (2 * p1[k] + t * (linear + t * (square + t * cubic)));
    }
    return result;
  }

 private:
  Color point(int i) const {
    const int n = int(points_.size());
    if (closed_) return points_[(i + n) % n];
    if (i < 0) return mix(points_[1], points_[0], 2);
    if (i >= n) return mix(points_[n - 2], points_[n - 1], 2);
    return points_[i];
  }

  std::vector<Color> points_;
  bool closed_;
};

Color srgb_of_oklab(const Color& oklab) {
  Color color = linear_from_oklab(oklab);
  for (float& c : color) c = srgb_from_linear(std::clamp(c, 0.f, 1.f));
  return color;
}

/// Equal steps along the curve are equal colour differences, which is what makes the map uniform.
std::vector<Color> walk(const Spline& spline, bool closed) {
  std::vector<Color> curve;
  for (int span = 0; span < spline.spans(); ++span)
    for (int i = 0; i < samples_per_span; ++i) curve.push_back(spline.at(span, float(i) / samples_per_span));
  curve.push_back(spline.at(spline.spans() - 1, 1));

  std::vector<float> along(curve.size(), 0.f);
  for (std::size_t i = 1; i < curve.size(); ++i) along[i] = along[i - 1] + distance(curve[i - 1], curve[i]);

  std::vector<Color> table;
  const int steps = closed ? table_size : table_size - 1;
  for (int i = 0; i < table_size; ++i) {
    const float s = along.back() * float(i) / float(steps);
    const auto after = std::upper_bound(along.begin() + 1, along.end() - 1, s) - along.begin();
    const float width = along[after] - along[after - 1];
    table.push_back(
        srgb_of_oklab(mix(curve[after - 1], curve[after], width > 0 ? (s - along[after - 1]) / width : 0.f)));
  }
  return table;
}

/// The two arms meet in a sharp neutral centre, so each is a curve by itself; together they have 256 steps.
std::vector<Color> walk_both_arms(const std::vector<Anchor>& low, const std::vector<Anchor>& high) {
  const std::vector<Color> left = walk(Spline(low, false), false), right = walk(Spline(high, false), false);
  const auto sample = [](const std::vector<Color>& arm, float t) {
    const float position = t * (table_size - 1);
    const int i = std::min(int(position), table_size - 2);
    return mix(arm[i], arm[i + 1], position - float(i));
  };
  std::vector<Color> table;
  for (int i = 0; i < table_size; ++i) {
    const float t = 2 * float(i) / (table_size - 1);
    table.push_back(t < 1 ? sample(left, t) : sample(right, 2 - t));
  }
  return table;
}

std::vector<Color> from_digits(std::string_view digits) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::vector<Color> table;
  for (std::size_t k = 0; k + 6 <= digits.size(); k += 6) {
    Color colour;
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] = float(16 * digit(digits[k + 2 * c]) + digit(digits[k + 2 * c + 1])) / 255;
    table.push_back(colour);
  }
  return table;
}

std::vector<Colormap> make_all() {
  const auto open = [](const std::vector<Anchor>& anchors) { return walk(Spline(anchors, false), false); };
  const auto closed = [](const std::vector<Anchor>& anchors) { return walk(Spline(anchors, true), true); };
  return {
      {"sea", "sequential",
       open({{.33f, .10f, 275}, {.48f, .095f, 240}, {.63f, .105f, 195}, {.78f, .135f, 152}, {.93f, .15f, 105}})},
      {"ember", "sequential",
       open({{.27f, .085f, 305}, {.43f, .125f, 345}, {.60f, .155f, 22}, {.76f, .135f, 58}, {.93f, .11f, 98}})},
      {"blue-red", "diverging",
       walk_both_arms({{.44f, .145f, 256}, {.70f, .10f, 252}, {.96f, 0, 250}},
                      {{.44f, .145f, 28}, {.70f, .10f, 32}, {.96f, 0, 32}})},
      {"gray", "gray", open({{.18f, 0, 0}, {1, 0, 0}})},
      {"phase", "cyclic", closed({{.92f, .03f, 90}, {.62f, .11f, 245}, {.35f, .05f, 300}, {.62f, .11f, 40}})},
      {"viridis", "sequential", from_digits(viridis_table)},
      {"cividis", "sequential", from_digits(cividis_table)},
      {"turbo", "rainbow",
       open({{.27f, .09f, 310},
             {.46f, .175f, 275},
             {.64f, .15f, 248},
             {.78f, .115f, 205},
             {.87f, .165f, 155},
             {.91f, .18f, 118},
             {.84f, .16f, 85},
             {.70f, .165f, 55},
             {.55f, .185f, 34},
             {.38f, .13f, 28}})},
      {"coolwarm", "diverging", coolwarm_colours(table_size)},
      {"twilight", "cyclic", from_digits(twilight_table)},
  };
}

const std::vector<Colormap>& all() {
  static const std::vector<Colormap> maps = make_all();
  return maps;
}

}  // namespace

const Colormap& colormap(const std::string& name) {
  for (const Colormap& map : all())
    if (map.name == name) return map;
  std::string names;
  for (const std::string& known : colormap_names()) names += (names.empty() ? "" : ", ") + known;
  throw Error("there is no colour map '" + name + "'", {}, "choose one of " + names);
}

std::vector<std::string> colormap_names() {
  std::vector<std::string> names;
  for (const Colormap& map : all()) names.push_back(map.name);
  return names;
}

}  // namespace nacre
