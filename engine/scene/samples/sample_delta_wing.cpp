// Nacre: built-in sample on a stream surface that leaves a delta wing and rolls up into a vortex, which breaks down.
#include <algorithm>
#include <numbers>

#include "engine/scene/samples/implicit_shapes.hpp"
#include "engine/scene/samples/sample_kit.hpp"

namespace nacre {
namespace {

using std::numbers::pi;
constexpr double surface_length = 10.0;  // the surface begins at the wing's apex, x = 0, and ends at x = surface_length
constexpr double breakdown_at = 5.7;     // where the vortex breaks down

/// The axis of the vortex at `x`: beside the wing's leading edge, then, behind the bubble, a helix.
Vec3d axis(double x) {
  const double off = 0.09 * smooth_step(6.6, 8.6, x), angle = 4.4 * (x - 6.6);
  return {x, 0.11 * x - 0.006 * x * x + off * std::cos(angle), 0.035 * x + off * std::sin(angle)};
}

/// A position in a half plane through the axis: along it, and away from it.
struct Meridional {
  double x, r;
};

/// Pushes the windings outward around the bubble. Its hollow is drawn from the axis, so that none can cross another.
Meridional swell(const Meridional& m) {
  const double hollow = 0.30 * smooth_step(breakdown_at - 1.1, breakdown_at, m.x) *
                        (1 - smooth_step(breakdown_at, breakdown_at + 2.2, m.x));
  return {m.x, norm(m.r, hollow)};
}

/// Turns what lies near a ring about the axis in its half plane, most at the ring itself: the windings that pass there
/// are folded over, as by a vortex ring. Keeps areas in the half plane, and points apart.
Meridional fold(const Meridional& m, double x, double r, double radius, double angle) {
  const double dx = m.x - x, dr = m.r - r, s = 1 - (dx * dx + dr * dr) / (radius * radius);
  if (s <= 0) return m;
  const double turn = angle * s * s, c = std::cos(turn), d = std::sin(turn);
  return {x + c * dx - d * dr, r + d * dx + c * dr};
}

double turns(double x) { return 0.35 + 2.05 * smooth_step(-1.5, 6.5, x); }
double outer_radius(double x) { return 0.05 + 0.21 * smooth_step(-1.0, 5.5, x) + 0.006 * x; }

/// Distance from the axis over that of the outer winding. Windings lie farther apart outside; beside the wing the sheet
/// comes from far off, its leading edge.
double winding(double x, double q) {
  const double rest = 1 - q, lip = std::max(1 - q / 0.2, 0.0);
  return 0.24 + 0.76 * rest * (0.5 + 0.5 * rest) + (0.2 + 0.9 * (1 - smooth_step(2.5, 5.0, x))) * lip * lip;
}

/// The point of the sheet at `x` along the stream and `q` across: 0 at the edge that has left the wing last, 1 at the
/// innermost. A spiral in each plane across the axis, then the bubble and its folds; each step keeps points apart that
/// were, so that the sheet does not meet itself.
Vec3d sheet_point(double x, double q) {
  const double angle = 0.65 * pi - 2 * pi * turns(x) * q;
  Meridional m{x, outer_radius(x) * winding(x, q)};
  m = swell(m);
  m = fold(m, breakdown_at + 1.1, 0.37, 0.35, -1.7);
  return axis(m.x) + Vec3d{0, std::cos(angle), std::sin(angle)} * m.r;
}

Vec3d sheet_normal(double x, double q) {
  constexpr double h = 1e-6;
  const Vec3d along = sheet_point(x + h, q) - sheet_point(x - h, q);
  const Vec3d across = sheet_point(x, q + h) - sheet_point(x, q - h);
  return normalized(cross(across, along));
}

/// Equal steps along a curve: `length_to` at equal steps of its parameter, 0..1.
class Measure {
 public:
  explicit Measure(std::vector<double> length_to) : length_to_(std::move(length_to)) {}

  double total() const { return length_to_.back(); }
  double parameter_at(double length) const {
    const auto next = std::upper_bound(length_to_.begin() + 1, length_to_.end() - 1, length);
    const double fraction = (length - *(next - 1)) / std::max(*next - *(next - 1), 1e-300);
    return std::clamp((double(next - length_to_.begin()) - 1 + fraction) / double(length_to_.size() - 1), 0.0, 1.0);
  }

 private:
  std::vector<double> length_to_;
};

/// Along the row of points at `x`.
Measure across_sheet(double x) {
  constexpr int sample_count = 600;
  std::vector<double> length_to{0};
  Vec3d last = sheet_point(x, 0);
  for (int i = 1; i <= sample_count; ++i) {
    const Vec3d next = sheet_point(x, double(i) / sample_count);
    length_to.push_back(length_to.back() + length(next - last));
    last = next;
  }
  return Measure(std::move(length_to));
}

/// How far rows at neighbouring `x` are from each other, in the mean over a row, measured square to it.
Measure along_sheet() {
  constexpr int sample_count = 1500, parts_across = 96;
  constexpr double h = 1e-5;
  std::vector<double> length_to{0};
  for (int i = 0; i < sample_count; ++i) {
    const double x = surface_length * (i + 0.5) / sample_count;
    double area = 0, width = 0;
    for (int j = 0; j < parts_across; ++j) {
      const double q = (j + 0.5) / parts_across;
      const Vec3d along = sheet_point(x + h, q) - sheet_point(x - h, q);
      const Vec3d across = sheet_point(x, q + h) - sheet_point(x, q - h);
      area += length(cross(along, across));
      width += length(across);
    }
    length_to.push_back(length_to.back() + area / width / (2 * h) * surface_length / sample_count);
  }
  return Measure(std::move(length_to));
}

/// Points at one `x`, numbered from `first` on.
struct Row {
  std::uint32_t first, count;
};

/// Triangles between two rows, whose numbers of points may differ: always the shorter of the two next diagonals.
void join(const Row& a, const Row& b, SampleShape& shape) {
  std::uint32_t i = 0, j = 0;
  const auto apart = [&](std::uint32_t p, std::uint32_t q) {
    return length(shape.points[a.first + p] - shape.points[b.first + q]);
  };
  while (i + 1 < a.count || j + 1 < b.count) {
    const bool step_a = j + 1 == b.count || (i + 1 < a.count && apart(i + 1, j) < apart(i, j + 1));
    const std::uint32_t p = a.first + i, q = b.first + j;
    shape.triangles.push_back({p, step_a ? p + 1 : q + 1, q});
    step_a ? ++i : ++j;
  }
}

SampleShape delta_wing_shape(int detail) {
  const double edge = surface_length / detail;
  const Measure along = along_sheet();
  const int rows = int(std::lround(along.total() / (edge * 0.87)));
  SampleShape shape;
  Row last{};
  for (int i = 0; i <= rows; ++i) {
    const double x = surface_length * along.parameter_at(along.total() * i / rows);
    const Measure across = across_sheet(x);
    const int steps = std::max(2, int(std::lround(across.total() / edge)));
    const Row row{std::uint32_t(shape.points.size()), std::uint32_t(steps + 1)};
    for (int j = 0; j <= steps; ++j) {
      const double q = across.parameter_at(across.total() * j / steps);
      shape.points.push_back(sheet_point(x, q));
      shape.normals.push_back(sheet_normal(x, q));
    }
    if (i > 0) join(last, row, shape);
    last = row;
  }
  return shape;
}

/// The stream, its swirl about the axis, waves on both that travel downstream, and a bubble that breathes.
SampleField delta_wing_flow(double time) {
  const double phase = 2 * pi * time;
  return [phase](const Vec3d& p, const Vec3d& n) {
    const Vec3d a = axis(p.x), off{0, p.y - a.y, p.z - a.z};
    const double r = std::max(length(off), 1e-6), angle = std::atan2(off.z, off.y);
    const Vec3d outward = off / r, around = cross(outward, Vec3d{1, 0, 0});
    const double bubble = smooth_step(breakdown_at - 1.2, breakdown_at - 0.3, p.x) * (1 - smooth_step(6.6, 7.8, p.x));
    const double stream = 0.9 - 0.75 * bubble + 0.3 * std::sin(2.2 * p.x - angle - phase);
    const double swirl = 0.75 + 0.4 * std::sin(2.9 * p.x + angle - phase) + 0.3 * bubble * std::cos(2 * angle + phase);
    const Vec3d pumping = outward * (0.5 * bubble * std::sin(5.0 * p.x + 14.0 * r + phase));
    const Vec3d drift = cross(n, Vec3d{1, 0, 0}) * (0.35 * std::sin(3.7 * p.x + 2 * angle - phase));
    return Vec3d{stream, 0, 0} + around * swirl + pumping + drift;
  };
}

}  // namespace

SampleDefinition delta_wing_sample() {
  return {
      {"delta-wing", "open stream surface off a delta wing: rolls up into a vortex, which breaks down into a bubble"},
      570,
      200,
      24,
      delta_wing_shape,
      delta_wing_flow};
}

}  // namespace nacre
