// Nacre: where new points bring the triangles of a mesh nearer to their interfaces.
#include "compute/pipeline/deviation_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "compute/math/sort_unique.hpp"
#include "compute/meshing/point_tree.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/pipeline/mesh_sides.hpp"

namespace nacre {
namespace {

constexpr double least_spacing = 0.7;  ///< of a new point from others, in `detail`
constexpr double apart = 1.3;          ///< new points from each other, in their distances from old ones
/// From a point that a third material covers to where its rim is looked for, in distances from old points: there, and
/// on all sides.
constexpr std::array<Vec3d, 13> ways_to_rim{{{0, 0, 0},
                                             {0.5, 0, 0},
                                             {-0.5, 0, 0},
                                             {0, 0.5, 0},
                                             {0, -0.5, 0},
                                             {0, 0, 0.5},
                                             {0, 0, -0.5},
                                             {1.5, 0, 0},
                                             {-1.5, 0, 0},
                                             {0, 1.5, 0},
                                             {0, -1.5, 0},
                                             {0, 0, 1.5},
                                             {0, 0, -1.5}}};
constexpr double rim_reach = 2;  ///< farther away from such a point no other is put, in the same unit
constexpr std::size_t most_named = 100;

/// The points of a mesh at edges on junction curves, curve by curve.
class PointsOnCurves {
 public:
  explicit PointsOnCurves(const SurfaceMesh& mesh) : mesh_(mesh) {
    const std::vector<MeshSide> sides = sides_of(mesh);
    for_each_edge(sides, [&](std::span<const MeshSide> at) {
      const Junction curve = curve_of(at);
      if (!(curve == Junction())) entry_.insert(entry_.end(), {{curve, at[0].a}, {curve, at[0].b}});
    });
    sort_unique(entry_);
    std::vector<Vec3d> points;
    std::vector<std::uint32_t> first;
    for (std::uint32_t k = 0; k < entry_.size(); ++k) {
      if (k == 0 || !(entry_[k].curve == entry_[k - 1].curve)) {
        first.push_back(k);
        curves_.push_back(entry_[k].curve);
      }
      points.push_back(mesh.points[entry_[k].point]);
    }
    first.push_back(std::uint32_t(entry_.size()));
    tree_.emplace(points, first);
  }

  /// Those within `radius` of `position`.
  std::vector<std::uint32_t> within(const Junction& curve, const Vec3d& position, double radius) const {
    std::vector<std::uint32_t> points;
    const auto at = std::lower_bound(curves_.begin(), curves_.end(), curve, before);
    if (at == curves_.end() || !(*at == curve)) return points;
    std::vector<PointTree::Found> found;
    tree_->within(std::uint32_t(at - curves_.begin()), position, radius, found);
    for (const PointTree::Found& f : found) points.push_back(entry_[f.point].point);
    return points;
  }

  /// Whether `nearest`, where the curve is nearest to the middle of its edge ab, is on the far side of a loop: another
  /// point of the curve lies on that side of the edge, nearer to `nearest` than the middle.
  bool is_across_loop(const Junction& curve, const Vec3d& nearest, std::uint32_t a, std::uint32_t b) const {
    const Vec3d middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
    const std::vector<std::uint32_t> near = within(curve, nearest, length(nearest - middle));
    return std::any_of(near.begin(), near.end(), [&](std::uint32_t v) {
      return v != a && v != b && dot(mesh_.points[v] - middle, nearest - middle) > 0;
    });
  }

 private:
  struct Entry {
    Junction curve;
    std::uint32_t point;
    auto key() const { return std::make_pair(curve.packed, point); }
    bool operator<(const Entry& other) const { return key() < other.key(); }
    bool operator==(const Entry& other) const { return key() == other.key(); }
  };
  static bool before(const Junction& s, const Junction& t) { return s.packed < t.packed; }

  const SurfaceMesh& mesh_;
  std::vector<Entry> entry_;
  std::vector<Junction> curves_;  ///< in order
  std::optional<PointTree> tree_;
};

/// Chooses new points one after the other.
class Insertion {
 public:
  Insertion(const SurfaceMesh& mesh, const MeshDeviation& deviation, const DeviationRule& rule)
      : mesh_(mesh), deviation_(deviation), rule_(rule), on_curves_(mesh), beside_(mesh.points.size()) {}

  /// False where the triangle is too small.
  bool divide(std::uint32_t t) {
    choices_.clear();
    list_choices(t);
    bool small = true;
    for (const Choice& c : choices_) {
      if (std::hypot(c.free, c.away * rule_.unit) < least_spacing * rule_.detail) continue;
      small = false;
      if (rule_.tried && rule_.tried(c.third, c.position)) continue;
      insert(c, t);
      break;
    }
    return !small;
  }

  std::vector<MeshDefects::NewPoint> take() { return std::move(found_); }

 private:
  struct Choice {
    Vec3d position;
    double free;  ///< its distance from other points
    double away;  ///< it will be moved by about so much
    std::uint16_t third = 0xffff;
  };

  /// Where a point may divide the triangle, the best one first.
  void list_choices(std::uint32_t t) {
    const Triangle& c = mesh_.triangles[t];
    const std::array<Vec3d, 3> p{mesh_.points[c.a], mesh_.points[c.b], mesh_.points[c.c]};
    const Vec3d u = p[1] - p[0], v = p[2] - p[0], n = cross(u, v);
    const double square = dot(n, n), away = deviation_.triangle[t];
    if (!(square > 0)) return;
    const Vec3d centre = p[0] + (dot(u, u) * cross(v, n) + dot(v, v) * cross(n, u)) / (2 * square);
    const double radius = length(centre - p[0]);
    int rim = -1;
    for (int k = 0; k < 3; ++k) {
      const float off = deviation_.on_rim[t][std::size_t(k)].away;
      if (off < 0) continue;
      const Vec3d a = p[std::size_t(k)], b = p[std::size_t((k + 1) % 3)];
      const bool encroached = length(centre - 0.5 * (a + b)) < 0.5 * length(b - a);
      const bool worse = rim < 0 || off > deviation_.on_rim[t][std::size_t(rim)].away;
      if ((off > rule_.most || encroached) && worse) rim = k;
    }
    if (rim >= 0) choices_.push_back(on_rim(t, rim));
    choices_.push_back({centre, radius, away});
    const Vec3d middle = (p[0] + p[1] + p[2]) / 3.0;
    choices_.push_back({middle, std::min({length(middle - p[0]), length(middle - p[1]), length(middle - p[2])}), away});
    std::array<int, 3> sides{0, 1, 2};
    const auto side = [&](int k) { return p[std::size_t((k + 1) % 3)] - p[std::size_t(k)]; };
    std::stable_sort(sides.begin(), sides.end(), [&](int k, int l) { return length(side(k)) > length(side(l)); });
    for (const int k : sides) choices_.push_back({p[std::size_t(k)] + 0.5 * side(k), 0.5 * length(side(k)), away});
  }

  /// At the middle of an edge on a curve.
  Choice on_rim(std::uint32_t t, int rim) const {
    const Triangle& c = mesh_.triangles[t];
    const std::uint32_t a = c[rim], b = c[(rim + 1) % 3];
    const MeshDeviation::Rim& on = deviation_.on_rim[t][std::size_t(rim)];
    const Vec3d middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
    const Junction curve = curve_between(mesh_.materials[t][0], mesh_.materials[t][1], on.third);
    const double half = 0.5 * length(mesh_.points[b] - mesh_.points[a]);
    Vec3d start = middle;
    if (on_curves_.is_across_loop(curve, on.nearest, a, b)) {
      const Vec3d back = middle - on.nearest;
      start += std::max(1.0, half / length(back)) * back;
    }
    return {start, half, on.away, on.third};
  }

  /// Unless another new point is nearby, which comes first.
  void insert(const Choice& choice, std::uint32_t t) {
    const Triangle& c = mesh_.triangles[t];
    for (int k = 0; k < 3; ++k)
      for (const std::uint32_t other : beside_[c[k]])
        if (length(found_[other].position - choice.position) < apart * choice.free) return;
    for (int k = 0; k < 3; ++k) beside_[c[k]].push_back(std::uint32_t(found_.size()));
    found_.push_back({choice.position, mesh_.materials[t], c.a, choice.third});
  }

  const SurfaceMesh& mesh_;
  const MeshDeviation& deviation_;
  const DeviationRule& rule_;
  const PointsOnCurves on_curves_;
  std::vector<std::vector<std::uint32_t>> beside_;  ///< per point: new points in triangles at it
  std::vector<MeshDefects::NewPoint> found_;
  std::vector<Choice> choices_;  ///< of the triangle at hand
};

/// Those of `on_curve` that are to be new points around p: the first, and others within reach that keep half the
/// diameter of the loop that they lie on, at most 0.7 of `free`, from those before.
std::vector<Vec3d> spread(std::span<const Vec3d> on_curve, const Vec3d& p, double free, double spacing) {
  std::vector<Vec3d> within, chosen;
  for (const Vec3d& q : on_curve)
    if (is_finite(q) && length(q - p) < rim_reach * free) within.push_back(q);
  double diameter = 0;
  for (const Vec3d& q : within)
    for (const Vec3d& r : within) diameter = std::max(diameter, length(q - r));
  const double gap = std::max(spacing, std::min(0.7 * free, 0.5 * diameter));
  for (const Vec3d& q : within)
    if (std::none_of(chosen.begin(), chosen.end(), [&](const Vec3d& r) { return length(q - r) < gap; }))
      chosen.push_back(q);
  return chosen;
}

}  // namespace

DeviationRefinement refine_deviation(const SurfaceMesh& mesh, const MeshDeviation& deviation,
                                     const DeviationRule& rule) {
  DeviationRefinement result;
  std::vector<std::uint32_t> above;
  for (std::uint32_t t = 0; t < deviation.triangle.size(); ++t)
    if (deviation.triangle[t] > rule.most) above.push_back(t);
  result.above = std::int64_t(above.size());
  if (above.empty()) return result;
  std::stable_sort(above.begin(), above.end(),
                   [&](std::uint32_t s, std::uint32_t t) { return deviation.triangle[s] > deviation.triangle[t]; });
  const std::vector<std::uint8_t> at_junction = junction_points(mesh);
  Insertion insertion(mesh, deviation, rule);
  for (const std::uint32_t t : above) {
    const Triangle& c = mesh.triangles[t];
    if (!insertion.divide(t))
      ++result.above_detail;
    else if (at_junction[c.a] || at_junction[c.b] || at_junction[c.c])
      ++result.above_junctions;
  }
  result.insert = insertion.take();
  above.resize(std::min(above.size(), most_named));
  result.worst = std::move(above);
  return result;
}

std::vector<MeshDefects::NewPoint> points_on_rims(const SurfaceMesh& mesh,
                                                  std::span<const MeshDefects::NewPoint> points,
                                                  std::span<const std::uint32_t> taken, double spacing,
                                                  const NearestOnJunctions& onto, const MaterialsAt& material_at) {
  std::vector<MeshDefects::NewPoint> lost;
  std::vector<double> free;  // the distance from points of the mesh
  std::vector<Vec3d> position;
  std::vector<Junction> junction;
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (points[k].third != 0xffff || std::binary_search(taken.begin(), taken.end(), k)) continue;
    lost.push_back(points[k]);
    free.push_back(length(points[k].position - mesh.points[points[k].at]));
    position.push_back(points[k].position);
    junction.emplace_back(points[k].materials[0], points[k].materials[1]);
  }
  if (lost.empty()) return lost;
  const std::vector<Vec3d> on = onto(position, junction);
  for (std::size_t k = 0; k < lost.size(); ++k)
    if (is_finite(on[k])) position[k] = lost[k].position = on[k];
  const std::vector<std::uint16_t> covered_by = material_at(position);
  std::vector<std::uint32_t> covered;
  for (std::uint32_t k = 0; k < lost.size(); ++k) {
    lost[k].third = covered_by[k];
    const auto& [a, b] = lost[k].materials;
    if (lost[k].third != a && lost[k].third != b && lost[k].third != 0xffff) covered.push_back(k);
  }
  if (covered.empty()) return {};
  // From where the curves are looked for.
  position.clear(), junction.clear();
  for (const std::uint32_t k : covered)
    for (const Vec3d& way : ways_to_rim) {
      position.push_back(lost[k].position + free[k] * way);
      junction.push_back(curve_between(lost[k].materials[0], lost[k].materials[1], lost[k].third));
    }
  const std::vector<Vec3d> on_curve = onto(position, junction);
  const PointsOnCurves on_curves(mesh);
  std::vector<MeshDefects::NewPoint> found;
  for (std::size_t c = 0; c < covered.size(); ++c) {
    MeshDefects::NewPoint p = lost[covered[c]];
    const std::size_t first = c * ways_to_rim.size();
    for (const Vec3d& q :
         spread(std::span(on_curve).subspan(first, ways_to_rim.size()), p.position, free[covered[c]], spacing)) {
      const bool apart = on_curves.within(junction[first], q, spacing).empty() &&
                         std::none_of(found.begin(), found.end(), [&](const MeshDefects::NewPoint& other) {
                           return length(other.position - q) < spacing;
                         });
      p.position = q;
      if (apart) found.push_back(p);
    }
  }
  return found;
}

}  // namespace nacre
