// Nacre: the triad of axes, as strokes in pixels.
#include "engine/render/axes_pass.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace nacre {
namespace {

struct Ink {
  float r, g, b, a;
};

struct InkCorner {
  float x, y;
  Ink ink;
};

struct Point {
  float x, y;
};

constexpr std::size_t most_corners = 4096;

/// Strokes as triangles.
class Strokes {
 public:
  /// From `a`, half as wide as `wide_a`, to `b`.
  void line(Point a, Point b, float wide_a, float wide_b, Ink ink) {
    const float dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length < 1e-3f) return;
    const float nx = -dy / length, ny = dx / length;
    const auto corner = [&](Point p, float wide) {
      return std::array<Point, 2>{Point{p.x + nx * wide, p.y + ny * wide}, Point{p.x - nx * wide, p.y - ny * wide}};
    };
    const auto [a0, a1] = corner(a, wide_a);
    const auto [b0, b1] = corner(b, wide_b);
    for (const Point& p : {a0, a1, b0, b0, a1, b1}) corners_.push_back({p.x, p.y, ink});
  }

  void letter(int axis, Point middle, float size, Ink ink) {
    const float wide = std::max(0.6f, 0.09f * size), w = 0.32f * size, h = 0.42f * size;
    const auto at = [&](float x, float y) { return Point{middle.x + x * w, middle.y + y * h}; };
    const auto stroke = [&](Point a, Point b) { line(a, b, wide, wide, ink); };
    if (axis == 0) {
      stroke(at(-1, -1), at(1, 1));
      stroke(at(-1, 1), at(1, -1));
    } else if (axis == 1) {
      stroke(at(-1, 1), at(0, 0));
      stroke(at(1, 1), at(0, 0));
      stroke(at(0, 0), at(0, -1));
    } else {
      stroke(at(-1, 1), at(1, 1));
      stroke(at(1, 1), at(-1, -1));
      stroke(at(-1, -1), at(1, -1));
    }
  }

  std::span<const InkCorner> corners() const { return corners_; }

 private:
  std::vector<InkCorner> corners_;
};

struct Axis {
  int number;
  float across, up, depth;
};

void draw_axis(Strokes& strokes, const Axis& axis, Point origin, float font) {
  static constexpr std::array<Ink, 3> inks{
      {{0.87f, 0.24f, 0.2f, 1}, {0.17f, 0.62f, 0.26f, 1}, {0.23f, 0.48f, 0.94f, 1}}};
  const Ink ink = inks[std::size_t(axis.number)];
  const float length = 2.6f * font, seen = std::hypot(axis.across, axis.up);
  const Point tip{origin.x + length * axis.across, origin.y + length * axis.up};
  const float head = std::min(0.32f, 0.6f * seen) / std::max(seen, 1e-6f);
  const Point neck{tip.x - head * length * axis.across, tip.y - head * length * axis.up};
  strokes.line(origin, neck, 0.075f * font, 0.075f * font, ink);
  strokes.line(neck, tip, 0.24f * font, 0.02f * font, ink);
  // Where the axis points at the eye its letter goes to the left, where no neighbour's is likely.
  const float ux = seen > 0.15f ? axis.across / seen : -0.7f, uy = seen > 0.15f ? axis.up / seen : 0.7f;
  strokes.letter(axis.number, {tip.x + 0.75f * font * ux, tip.y + 0.75f * font * uy}, font, ink);
}

}  // namespace

AxesPass::AxesPass() : program_("ink.vert", "ink.frag"), corners_(most_corners * sizeof(InkCorner)) {
  glCreateVertexArrays(1, &array_);
  glVertexArrayVertexBuffer(array_, 0, corners_.id(), 0, sizeof(InkCorner));
  glVertexArrayAttribFormat(array_, 0, 2, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(array_, 1, 4, GL_FLOAT, GL_FALSE, offsetof(InkCorner, ink));
  for (GLuint k = 0; k < 2; ++k) {
    glEnableVertexArrayAttrib(array_, k);
    glVertexArrayAttribBinding(array_, k, 0);
  }
}

AxesPass::~AxesPass() { glDeleteVertexArrays(1, &array_); }

void AxesPass::draw(const View& view, float scale) {
  const float font = 15 * scale, reach = 4.7f * font;
  if (float(view.width) < 3 * reach || float(view.height) < 3 * reach) return;
  const Vec3d forward = view.camera.forward(), right = view.camera.right(), up = cross(right, forward);
  std::array<Axis, 3> axes;
  for (int k = 0; k < 3; ++k) axes[std::size_t(k)] = {k, float(right[k]), float(up[k]), float(forward[k])};
  std::sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) { return a.depth > b.depth; });
  Strokes strokes;
  for (const Axis& axis : axes) draw_axis(strokes, axis, {float(view.width) - reach, reach}, font);
  assert(strokes.corners().size() <= most_corners);
  corners_.update(strokes.corners());
  program_.set("picture_size", std::array<float, 2>{float(view.width), float(view.height)});
  program_.use();
  glBindVertexArray(array_);
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(strokes.corners().size()));
  glEnable(GL_DEPTH_TEST);
}

}  // namespace nacre
