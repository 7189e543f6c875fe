// Nacre: a surface made ready for the numerics: bad triangles out, winding consistent, normals per corner.
#include "engine/scene/surface/prepare.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "compute/device/error.hpp"
#include "engine/scene/surface/sheets.hpp"
#include "engine/scene/surface/winding.hpp"

namespace nacre {
namespace {

constexpr double zero_height = 1e-14;   // height over longest side, below which a triangle has no area
constexpr double sliver_height = 1e-6;  // the same, below which rounding of the points decides the triangle's normal
constexpr std::size_t hub_size = 256;   // triangles around a point, above which each keeps its own normal there

struct Shape {
  Vec3d normal;         // unit, or zero
  double flatness = 0;  // height over longest side, about
};

/// Not inlined: all who ask get the same rounding.
[[gnu::noinline]] Shape shape_of(const std::vector<Vec3d>& points, const Triangle& t) {
  const Vec3d ab = points[t.b] - points[t.a], bc = points[t.c] - points[t.b], ca = points[t.a] - points[t.c];
  const double longest = std::sqrt(std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)}));
  if (!(longest > 0) || !std::isfinite(longest)) return {};
  const double scale = 1 / longest;  // first, so that tiny and huge coordinates neither vanish nor overflow
  const Vec3d twice_area = cross(ab * scale, bc * scale);
  return {normalized(twice_area), length(twice_area)};
}

/// "3 triangles were dropped because ...", if there is anything to say and someone to say it to.
void say(std::vector<std::string>* warnings, std::size_t count, std::string_view what, std::string_view happened) {
  if (warnings && count > 0)
    warnings->push_back(fmt::format("{} {}{} {}.", count, what, count == 1 ? " was" : "s were", happened));
}

/// Drops what no later step could make sense of.
void drop_unusable(PreparedSurface& surface, std::vector<std::string>* warnings) {
  const std::vector<Vec3d>& points = surface.points;
  say(warnings,
      std::erase_if(surface.triangles,
                    [&](const Triangle& t) {
                      return std::max({t.a, t.b, t.c}) >= points.size();
                    }),
      "triangle", "dropped because they refer to points that do not exist");
  say(warnings,
      std::erase_if(surface.triangles,
                    [&](const Triangle& t) {
                      return !is_finite(points[t.a]) || !is_finite(points[t.b]) || !is_finite(points[t.c]);
                    }),
      "triangle", "dropped because their coordinates are not finite");
}

void say(std::vector<std::string>* warnings, const WindingReport& report) {
  say(warnings, report.duplicates, "triangle", "dropped because an earlier one has the same three points");
  say(warnings, report.flipped, "triangle", "turned over to be wound like their neighbours");
  say(warnings, report.turned_parts, "closed part", "turned over to face outwards");
  say(warnings, report.contradictions, "edge", "left with contradicting triangles: the surface is one-sided there");
}

void turn_over(Triangle& t) { std::swap(t.b, t.c); }

/// Winds the first sheets consistently, as if there were no others. What lies on them is turned over with them.
void orient_with_second_sheets(PreparedSurface& surface, std::span<const std::uint32_t> same,
                               const SecondSheets& sheets, std::vector<std::string>* warnings) {
  std::vector<Triangle> firsts, seconds;
  std::vector<std::uint32_t> number(surface.triangles.size(), none);  // among the first ones
  for (std::size_t t = 0, s = 0; t < surface.triangles.size(); ++t) {
    const bool second = s < sheets.triangles.size() && sheets.triangles[s] == t;
    if (!second) number[t] = std::uint32_t(firsts.size());
    (second ? seconds : firsts).push_back(surface.triangles[t]);
    s += second ? 1 : 0;
  }
  const std::vector<Triangle> before = firsts;
  std::vector<std::uint8_t> open;
  const WindingReport report = make_winding_consistent(surface.points, same, firsts, &open);
  say(warnings, report);
  const bool inwards = 2 * report.turned_triangles > report.closed_triangles;
  std::vector<char> turned(before.size(), 0);
  for (std::size_t i = 0, k = 0; i < before.size() && k < firsts.size(); ++i) {
    const Triangle over{before[i].a, before[i].c, before[i].b};
    if (!(firsts[k] == before[i]) && !(firsts[k] == over)) continue;  // it was dropped
    if (inwards && open[k]) turn_over(firsts[k]);
    turned[i] = !(firsts[k++] == before[i]);
  }
  for (std::size_t s = 0; s < seconds.size(); ++s)
    if (const std::uint32_t first = number[sheets.backing[s]]; first != none && turned[first]) turn_over(seconds[s]);
  surface.triangles = std::move(firsts);
  surface.second_sheet.assign(surface.triangles.size(), 0);
  surface.triangles.insert(surface.triangles.end(), seconds.begin(), seconds.end());
  surface.second_sheet.resize(surface.triangles.size(), 1);
}

void orient(PreparedSurface& surface, std::span<const std::uint32_t> same, bool with_arrays,
            std::vector<std::string>* warnings) {
  const SecondSheets sheets =
      with_arrays ? find_second_sheets(surface.points, same, surface.triangles) : SecondSheets();
  if (!sheets.triangles.empty()) return orient_with_second_sheets(surface, same, sheets, warnings);
  say(warnings, make_winding_consistent(surface.points, same, surface.triangles));
}

/// Triangle corners by the point (first at its position) that they stand on.
struct CornerTable {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> corners;  // 3 * triangle + corner, ascending around each point
};

CornerTable list_corners(std::span<const std::uint32_t> same, const std::vector<Triangle>& triangles) {
  CornerTable table;
  table.first.assign(same.size() + 2, 0);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++table.first[same[t[k]] + 2];
  for (std::size_t p = 2; p < table.first.size(); ++p) table.first[p] += table.first[p - 1];
  table.corners.resize(3 * triangles.size());
  for (std::size_t i = 0; i < table.corners.size(); ++i)
    table.corners[table.first[same[triangles[i / 3][int(i % 3)]] + 1]++] = std::uint32_t(i);
  return table;
}

double corner_angle(const std::vector<Vec3d>& points, const Triangle& t, int k) {
  const Vec3d u = points[t[(k + 1) % 3]] - points[t[k]], v = points[t[(k + 2) % 3]] - points[t[k]];
  return std::atan2(length(cross(u, v)), dot(u, v));
}

/// The normals of all corners around one point.
class PointFan {
 public:
  PointFan(const PreparedSurface& surface, const std::vector<Shape>& shapes, double cosine)
      : surface_(surface), shapes_(shapes), cosine_(cosine) {}

  void write(std::span<const std::uint32_t> corners, std::vector<Vec3f>& normals) {
    weighted_.clear();
    if (corners.size() <= hub_size)
      for (const std::uint32_t c : corners) {
        const Shape& shape = shapes_[c / 3];
        const double angle = corner_angle(surface_.points, surface_.triangles[c / 3], int(c % 3));
        weighted_.push_back(shape.flatness > sliver_height ? shape.normal * angle : Vec3d{});
      }
    for (const std::uint32_t c : corners) normals[c] = Vec3f(normal_at(c, corners));
  }

 private:
  /// A sliver's own normal is rounding noise: it takes its neighbours' mean whatever the crease, and adds nothing to
  /// theirs.
  Vec3d normal_at(std::uint32_t corner, std::span<const std::uint32_t> corners) const {
    const Shape& own = shapes_[corner / 3];
    Vec3d sum;
    for (std::size_t i = 0; i < weighted_.size(); ++i)
      if (own.flatness <= sliver_height || dot(own.normal, shapes_[corners[i] / 3].normal) >= cosine_)
        sum += weighted_[i];
    const double size = length(sum);
    return size > 1e-9 ? sum / size : own.normal;
  }

  const PreparedSurface& surface_;
  const std::vector<Shape>& shapes_;
  double cosine_;
  std::vector<Vec3d> weighted_;  // per corner around the point: normal times angle, zero for slivers
};

void add_corner_normals(PreparedSurface& surface, std::span<const std::uint32_t> same, const std::vector<Shape>& shapes,
                        double crease_degrees) {
  const CornerTable table = list_corners(same, surface.triangles);
  const double cosine = std::cos(crease_degrees * std::numbers::pi / 180) - 1e-12;
  surface.corner_normals.resize(3 * surface.triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, same.size(), 4096), [&](const auto& range) {
    PointFan fan(surface, shapes, cosine);
    for (std::size_t p = range.begin(); p < range.end(); ++p)
      fan.write({table.corners.data() + table.first[p], table.first[p + 1] - table.first[p]}, surface.corner_normals);
  });
}

std::vector<Shape> shapes_of(const PreparedSurface& surface) {
  std::vector<Shape> shapes(surface.triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, shapes.size(), 4096), [&](const auto& range) {
    for (std::size_t t = range.begin(); t < range.end(); ++t)
      shapes[t] = shape_of(surface.points, surface.triangles[t]);
  });
  return shapes;
}

/// Drops triangles without area, and their entries in `shapes`.
std::size_t drop_flat(PreparedSurface& surface, std::vector<Shape>& shapes) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < shapes.size(); ++t)
    if (shapes[t].flatness > zero_height) {
      surface.triangles[kept] = surface.triangles[t];
      if (!surface.second_sheet.empty()) surface.second_sheet[kept] = surface.second_sheet[t];
      shapes[kept++] = shapes[t];
    }
  const std::size_t dropped = shapes.size() - kept;
  surface.triangles.resize(kept);
  surface.second_sheet.resize(surface.second_sheet.empty() ? 0 : kept);
  shapes.resize(kept);
  return dropped;
}

void require_triangles(const PreparedSurface& surface, std::string_view why) {
  if (surface.triangles.empty())
    throw Error("the surface has no triangles", std::string(why), "give a file with polygons or a volume mesh");
}

}  // namespace

bool has_no_area(const std::vector<Vec3d>& points, const Triangle& triangle) {
  return !(shape_of(points, triangle).flatness > zero_height);
}

void tell_repairs(const WindingReport& winding, std::size_t flat, std::vector<std::string>* warnings) {
  say(warnings, winding);
  say(warnings, flat, "triangle", "dropped because they have no area");
}

void update_normals(PreparedSurface& surface, std::span<const std::uint32_t> same, double crease_degrees) {
  add_corner_normals(surface, same, shapes_of(surface), crease_degrees);
}

PreparedSurface prepare(const Surface& surface, double crease_degrees, std::vector<std::string>* warnings) {
  if (surface.triangles.size() > 0xfffffffdu / 3)
    throw Error("the surface has too many triangles", fmt::format("{}", surface.triangles.size()),
                "at most 1.4 billion are supported");
  PreparedSurface result{surface.points, surface.triangles, {}, {}};
  require_triangles(result, "the file lists none");
  drop_unusable(result, warnings);
  const std::vector<std::uint32_t> same = first_at_position(result.points);
  // Collinear triangles stay until the winding is known: they may be what joins two parts.
  std::size_t flat = std::erase_if(result.triangles, [&](const Triangle& t) {
    return same[t.a] == same[t.b] || same[t.b] == same[t.c] || same[t.c] == same[t.a];
  });
  orient(result, same, !surface.arrays.empty(), warnings);
  std::vector<Shape> shapes = shapes_of(result);
  flat += drop_flat(result, shapes);
  say(warnings, flat, "triangle", "dropped because they have no area");
  require_triangles(result, "each one has no area, or points that are missing or not finite");
  add_corner_normals(result, same, shapes, crease_degrees);
  const Vec3d used = result.points[result.triangles[0].a];
  for (Vec3d& p : result.points)
    if (!is_finite(p)) p = used;
  return result;
}

}  // namespace nacre
