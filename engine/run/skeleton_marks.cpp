// Nacre: critical points, separatrices and streamlines, drawn over a picture.
#include "engine/run/skeleton_marks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <span>
#include <utility>

#include "compute/raycast/triangle_tree.hpp"
#include "engine/picture/compose.hpp"
#include "engine/scene/surface/extent.hpp"

namespace nacre {
namespace {

constexpr Rgba hole{255, 255, 255, 255};

struct Pixel {
  double x = 0, y = 0;
  bool seen = false;
};

/// Where points are in a picture, and whether the surface hides them.
class Projection {
 public:
  Projection(const Camera& camera, int width, int height, const PreparedSurface& shape)
      : camera_(camera), width_(width), height_(height), tree_(shape.points, shape.triangles) {
    slack_ = 1e-3 * Extent(shape.points, shape.triangles).diagonal();
  }

  Pixel operator()(const Vec3d& p) const {
    const Vec3d forward = camera_.forward(), right = camera_.right(), up = cross(right, forward), d = p - camera_.eye;
    const double depth = dot(d, forward), distance = length(camera_.target - camera_.eye);
    const double scale = camera_.orthographic ? 1 : distance / std::max(depth, 1e-9 * distance);
    const double half = 0.5 * height_;
    Pixel pixel{0.5 * width_ + dot(d, right) * scale / (0.5 * camera_.height) * half - 0.5,
                half - dot(d, up) * scale / (0.5 * camera_.height) * half - 0.5, false};
    const bool inside = pixel.x > -20 && pixel.y > -20 && pixel.x < width_ + 20 && pixel.y < height_ + 20;
    if (!inside || (!camera_.orthographic && depth <= 0)) return pixel;
    const Vec3d back = camera_.orthographic ? -forward : normalized(camera_.eye - p);
    const double far = camera_.orthographic ? 1e300 : length(camera_.eye - p);
    pixel.seen = !tree_.first(p, back, slack_, far);
    return pixel;
  }

 private:
  const Camera& camera_;
  int width_, height_;
  TriangleTree tree_;
  double slack_ = 0;
};

/// Blends `colour` where `distance` (pixels, from the middle of a pixel to a shape) is below 0, softly.
void fill(Image& image, double left, double top, double right, double bottom, const Rgba& colour,
          const std::function<double(double, double)>& distance) {
  for (int y = std::max(0, int(top)); y <= std::min(image.height - 1, int(bottom) + 1); ++y)
    for (int x = std::max(0, int(left)); x <= std::min(image.width - 1, int(right) + 1); ++x)
      blend_pixel(image.at(x, y), colour, float(std::clamp(0.5 - distance(x, y), 0.0, 1.0)));
}

void draw_mark(Image& image, const Pixel& at, CriticalKind kind, double radius) {
  const bool diamond = kind == CriticalKind::saddle;
  const auto put = [&](double size, const Rgba& colour) {
    const double reach = 1.5 * size + 1;
    fill(image, at.x - reach, at.y - reach, at.x + reach, at.y + reach, colour, [&](double x, double y) {
      const double u = std::fabs(x - at.x), v = std::fabs(y - at.y);
      return diamond ? (u + v - 1.4 * size) * 0.7071 : std::hypot(u, v) - size;
    });
  };
  put(radius + 0.3 * radius, mark_outline);
  put(radius, mark_colour(kind));
  if (kind == CriticalKind::focus_source || kind == CriticalKind::focus_sink) put(0.4 * radius, hole);
}

/// The cover of all lines of one kind in each pixel, so that a line does not cover itself twice.
class LineSheet {
 public:
  LineSheet(int width, int height) : width_(width), height_(height), cover_(std::size_t(width) * height) {}

  void add(const Pixel& a, const Pixel& b, double half_width) {
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy, reach = half_width + 1;
    for (int y = std::max(0, int(std::min(a.y, b.y) - reach));
         y <= std::min(height_ - 1, int(std::max(a.y, b.y) + reach)); ++y)
      for (int x = std::max(0, int(std::min(a.x, b.x) - reach));
           x <= std::min(width_ - 1, int(std::max(a.x, b.x) + reach)); ++x) {
        const double s = squared > 0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / squared, 0.0, 1.0) : 0;
        const double distance = std::hypot(x - a.x - s * dx, y - a.y - s * dy);
        float& cover = cover_[std::size_t(y) * width_ + x];
        cover = std::max(cover, float(std::clamp(half_width + 0.5 - distance, 0.0, 1.0)));
      }
  }
  void blend(Image& image, const Rgba& colour) const {
    for (std::size_t i = 0; i < cover_.size(); ++i)
      if (cover_[i] > 0) blend_pixel(&image.pixels[4 * i], colour, cover_[i]);
  }

 private:
  int width_, height_;
  std::vector<float> cover_;
};

double line_unit(const Image& image) { return std::max(0.5, std::min(image.width, image.height) / 768.0); }

/// Adds what is seen of a line to each of the sheets, as wide as it says.
void add_line(const Projection& project, std::span<const Vec3d> points,
              std::initializer_list<std::pair<LineSheet*, double>> sheets) {
  Pixel before;
  for (const Vec3d& p : points) {
    const Pixel now = project(p);
    if (before.seen && now.seen)
      for (const auto& [sheet, half_width] : sheets) sheet->add(before, now, half_width);
    before = now;
  }
}

}  // namespace

Rgba mark_colour(CriticalKind kind) {
  switch (kind) {
    case CriticalKind::saddle: return {255, 225, 40, 255};
    case CriticalKind::source:
    case CriticalKind::focus_source: return {225, 40, 40, 255};
    case CriticalKind::sink:
    case CriticalKind::focus_sink: return {40, 90, 230, 255};
    case CriticalKind::centre: return {40, 170, 70, 255};
  }
  return mark_outline;
}

void draw_skeleton(Image& image, const Camera& camera, const FlowSkeleton& skeleton) {
  const Projection project(camera, image.width, image.height, skeleton.shape);
  const double unit = line_unit(image);
  LineSheet edge(image.width, image.height), forward = edge, backward = edge, leaving = edge, arriving = edge,
                                             attracting = edge, repelling = edge;
  for (const ClosedOrbit& orbit : skeleton.orbits)
    add_line(project, orbit.points, {{&edge, 2.6 * unit}, {orbit.attracting ? &attracting : &repelling, 1.8 * unit}});
  for (const SeparationLine& line : skeleton.separation)
    add_line(project, line.points, {{&edge, 1.9 * unit}, {line.separation ? &leaving : &arriving, 1.2 * unit}});
  for (const SurfaceLine& line : skeleton.separatrices)
    add_line(project, line.points, {{&edge, 1.6 * unit}, {line.forward ? &forward : &backward, 0.9 * unit}});
  edge.blend(image, {mark_outline.r, mark_outline.g, mark_outline.b, 170});
  arriving.blend(image, attachment_colour);
  leaving.blend(image, separation_colour);
  backward.blend(image, separatrix_against_flow);
  forward.blend(image, separatrix_with_flow);
  attracting.blend(image, mark_colour(CriticalKind::sink));
  repelling.blend(image, mark_colour(CriticalKind::source));
  for (const CriticalPoint& point : skeleton.topology.points) {
    const Pixel at = project(point.position);
    if (at.seen) draw_mark(image, at, point.kind, 4.5 * unit);
  }
}

void draw_tracks(Image& image, const Camera& camera, const FlowTracks& tracks, double now,
                 const PreparedSurface& shape) {
  const Projection project(camera, image.width, image.height, shape);
  const double unit = line_unit(image);
  LineSheet edge(image.width, image.height), past = edge, later = edge;
  for (const PointTrack& track : tracks.tracks)
    for (const TrackPart& part : parts_of(tracks, track, now))
      add_line(project, part.points, {{&edge, 1.9 * unit}, {part.past ? &past : &later, 1.1 * unit}});
  edge.blend(image, {mark_outline.r, mark_outline.g, mark_outline.b, 170});
  later.blend(image, later_track_colour);
  past.blend(image, track_colour);
}

void draw_streamlines(Image& image, const Camera& camera, const FlowStreamlines& streamlines) {
  const Projection project(camera, image.width, image.height, streamlines.shape);
  LineSheet sheet(image.width, image.height);
  for (const EvenLine& line : streamlines.lines) add_line(project, line.points, {{&sheet, 0.7 * line_unit(image)}});
  sheet.blend(image, streamline_ink);
}

}  // namespace nacre
