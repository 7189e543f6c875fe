// Nacre: a picture of triangles with their edges: a depth buffer in bands of rows.
#include "compute/raycast/mesh_picture.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

constexpr int band_rows = 16;  // of pixels
constexpr std::uint32_t nothing = 0xffffffffu;

/// A corner on the screen, in samples; `near` grows towards the eye and is linear over a flat triangle.
struct Corner {
  double x, y, near;
  bool visible;
};

/// What one sample of the picture sees.
struct Sample {
  double near = -1e300;
  std::uint32_t triangle = nothing;
  float line = 0;  ///< 0 away from edges, 1 on one
};

class Screen {
 public:
  explicit Screen(const MeshPictureOptions& o)
      : camera_(o.camera),
        forward_(o.camera.forward()),
        right_(o.camera.right()),
        up_(cross(right_, forward_)),
        distance_(length(o.camera.target - o.camera.eye)),
        scale_(o.height * o.samples / o.camera.height),
        middle_(Vec3d(o.width, o.height, 0) * (0.5 * o.samples)) {}

  Corner project(const Vec3d& p) const {
    const Vec3d d = p - camera_.eye;
    const double away = dot(d, forward_);
    const bool visible = camera_.orthographic || away > 1e-4 * distance_;
    const double scale = camera_.orthographic ? scale_ : scale_ * distance_ / away;
    return {middle_.x + dot(d, right_) * scale, middle_.y - dot(d, up_) * scale,
            camera_.orthographic ? -away : 1 / away, visible};
  }

  /// How much light a facet with normal `n` reflects to the eye, 0..1.
  float brightness(const Vec3d& n, const Vec3d& centre) const {
    const Vec3d view = camera_.orthographic ? forward_ : normalized(centre - camera_.eye);
    const Vec3d light = normalized(up_ * 0.55 - right_ * 0.45 - forward_);
    const double facing = dot(n, view) > 0 ? -1 : 1;
    return float(0.3 + 0.7 * std::max(0.0, facing * dot(n, light)));
  }

 private:
  Camera camera_;
  Vec3d forward_, right_, up_;
  double distance_, scale_;
  Vec3d middle_;
};

class Picture {
 public:
  Picture(std::span<const Vec3d> points, std::span<const Triangle> triangles,
          std::span<const std::array<float, 3>> colours, const MeshPictureOptions& options)
      : points_(points),
        triangles_(triangles),
        colours_(colours),
        o_(options),
        screen_(options),
        bands_((options.height + band_rows - 1) / band_rows),
        pixels_(std::size_t(options.width) * options.height * 4) {}

  std::vector<std::uint8_t> draw() {
    corners_.resize(points_.size());
    tbb::parallel_for(std::size_t(0), points_.size(),
                      [&](std::size_t i) { corners_[i] = screen_.project(points_[i]); });
    sort_into_bands();
    tbb::parallel_for(0, bands_, [&](int band) { draw_band(band); });
    return std::move(pixels_);
  }

 private:
  /// First and last band that the triangle touches; an empty range if it is outside the picture.
  std::array<int, 2> bands_of(const Triangle& t) const {
    const Corner &a = corners_[t.a], &b = corners_[t.b], &c = corners_[t.c];
    if (!a.visible || !b.visible || !c.visible) return {0, -1};
    const double rows = band_rows * o_.samples, width = o_.width * o_.samples;
    if (std::max({a.x, b.x, c.x}) < 0 || std::min({a.x, b.x, c.x}) > width) return {0, -1};
    const double low = std::min({a.y, b.y, c.y}) / rows, high = std::max({a.y, b.y, c.y}) / rows;
    if (!(high >= 0) || !(low < bands_)) return {0, -1};
    return {int(std::max(low, 0.0)), int(std::min(high, bands_ - 1.0))};
  }

  void sort_into_bands() {
    start_.assign(std::size_t(bands_) + 1, 0);
    for (const Triangle& t : triangles_) {
      const auto [first, last] = bands_of(t);
      for (int band = first; band <= last; ++band) ++start_[std::size_t(band) + 1];
    }
    for (int band = 0; band < bands_; ++band) start_[std::size_t(band) + 1] += start_[std::size_t(band)];
    in_band_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto [first, last] = bands_of(triangles_[t]);
      for (int band = first; band <= last; ++band) in_band_[next[std::size_t(band)]++] = std::uint32_t(t);
    }
  }

  void draw_band(int band) {
    const int top = band * band_rows, bottom = std::min(top + band_rows, o_.height);
    const int width = o_.width * o_.samples;
    std::vector<Sample> samples(std::size_t(width) * (bottom - top) * o_.samples);
    for (std::size_t k = start_[std::size_t(band)]; k < start_[std::size_t(band) + 1]; ++k)
      draw_triangle(in_band_[k], top * o_.samples, bottom * o_.samples, samples);
    for (int y = top; y < bottom; ++y)
      for (int x = 0; x < o_.width; ++x) resolve(x, y, &samples[std::size_t(y - top) * o_.samples * width], width);
  }

  void draw_triangle(std::uint32_t index, int top, int bottom, std::vector<Sample>& samples) const {
    const Triangle& t = triangles_[index];
    const std::array<Corner, 3> c{corners_[t.a], corners_[t.b], corners_[t.c]};
    const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
    if (area == 0 || !std::isfinite(area)) return;
    const int width = o_.width * o_.samples;
    const auto range = [](double low, double high, int first, int last) {
      return std::array<int, 2>{int(std::clamp(std::ceil(low - 0.5), double(first), double(last))),
                                int(std::clamp(std::floor(high - 0.5) + 1, double(first), double(last)))};
    };
    const auto [x0, x1] = range(std::min({c[0].x, c[1].x, c[2].x}), std::max({c[0].x, c[1].x, c[2].x}), 0, width);
    const auto [y0, y1] = range(std::min({c[0].y, c[1].y, c[2].y}), std::max({c[0].y, c[1].y, c[2].y}), top, bottom);
    std::array<double, 3> height;  // of each corner over its opposite edge, in pixels
    for (int k = 0; k < 3; ++k) {
      const Corner &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
      height[k] = std::abs(area) / std::max(1e-12, std::hypot(b.x - a.x, b.y - a.y)) / o_.samples;
    }
    const double size = std::sqrt(std::abs(area)) / o_.samples;
    const float fade = o_.edges ? float(std::clamp((size - 2.5) / 6, 0.0, 1.0)) : 0.0f;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        std::array<double, 3> w;
        w[0] = ((c[1].x - px) * (c[2].y - py) - (c[2].x - px) * (c[1].y - py)) / area;
        w[1] = ((c[2].x - px) * (c[0].y - py) - (c[0].x - px) * (c[2].y - py)) / area;
        w[2] = 1 - w[0] - w[1];
        if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
        const double near = w[0] * c[0].near + w[1] * c[1].near + w[2] * c[2].near;
        Sample& sample = samples[std::size_t(y - top) * width + x];
        if (near <= sample.near) continue;
        const double edge = std::min({w[0] * height[0], w[1] * height[1], w[2] * height[2]});
        sample = {near, index, fade * float(std::clamp(1.15 - edge, 0.0, 1.0))};
      }
  }

  /// The colour of one pixel: its samples, averaged in linear light (gamma 2, near sRGB).
  void resolve(int x, int y, const Sample* row, int width) {
    float sum[3] = {}, alpha = 0;
    for (int j = 0; j < o_.samples; ++j)
      for (int i = 0; i < o_.samples; ++i) {
        const Sample& s = row[std::size_t(j) * width + std::size_t(x) * o_.samples + i];
        const bool seen = s.triangle != nothing;
        const float light = seen ? shade(s) : 1;
        const std::array<float, 3>& colour = seen ? colours_[s.triangle] : o_.background;
        const float weight = seen || !o_.transparent ? 1.0f : 0.0f;
        for (int k = 0; k < 3; ++k) sum[k] += weight * colour[k] * colour[k] * light;
        alpha += weight;
      }
    std::uint8_t* pixel = &pixels_[(std::size_t(y) * o_.width + x) * 4];
    const auto byte = [](float v) { return std::uint8_t(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
    for (int k = 0; k < 3; ++k) pixel[k] = byte(alpha > 0 ? std::sqrt(sum[k] / alpha) : 0);
    pixel[3] = byte(alpha / float(o_.samples * o_.samples));
  }

  float shade(const Sample& sample) const {
    const Triangle& t = triangles_[sample.triangle];
    const Vec3d &a = points_[t.a], &b = points_[t.b], &c = points_[t.c];
    const float light = screen_.brightness(normalized(cross(b - a, c - a)), (a + b + c) / 3.0);
    return light * (1 - 0.75f * sample.line);
  }

  std::span<const Vec3d> points_;
  std::span<const Triangle> triangles_;
  std::span<const std::array<float, 3>> colours_;
  MeshPictureOptions o_;
  Screen screen_;
  int bands_;
  std::vector<Corner> corners_;
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> in_band_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

std::vector<std::uint8_t> mesh_picture(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                       std::span<const std::array<float, 3>> colours,
                                       const MeshPictureOptions& options) {
  return Picture(points, triangles, colours, options).draw();
}

}  // namespace nacre
