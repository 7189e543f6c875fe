// Nacre: how far flat triangles are from the interfaces that they stand for, and where new points bring them nearer.
#include "compute/pipeline/mesh_deviation.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "compute/meshing/point_tree.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr double least_spacing = 0.7;  ///< of a new point from others, in `detail`
constexpr double apart = 1.3;          ///< new points from each other, in their distances from old ones
constexpr std::size_t most_named = 100;

/// Side k of a triangle, as one of the sides of the mesh.
struct Side {
  std::uint32_t a, b;
  std::array<std::uint16_t, 2> materials;
  std::uint32_t triangle;
  std::uint8_t k;

  bool same_edge(const Side& other) const { return a == other.a && b == other.b; }
};

std::vector<Side> sides_of(const SurfaceMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), mesh.materials[t], t, std::uint8_t(k)});
    }
  tbb::parallel_sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return std::tie(s.a, s.b, s.materials, s.triangle) < std::tie(t.a, t.b, t.materials, t.triangle);
  });
  return sides;
}

/// The curve that sides at one edge lie on; no junction where two materials meet there, or more than three.
Junction curve_of(std::span<const Side> sides) {
  std::array<std::uint16_t, 3> met;
  std::size_t count = 0;
  for (const Side& s : sides)
    for (const std::uint16_t m : s.materials) {
      if (std::find(met.begin(), met.begin() + count, m) != met.begin() + count) continue;
      if (count == met.size()) return Junction();
      met[count++] = m;
    }
  if (count < met.size()) return Junction();
  std::sort(met.begin(), met.end());
  return Junction(met[0], met[1], met[2]);
}

/// The one of a curve's three materials that does not meet at this side.
std::uint16_t third_of(const Junction& curve, const Side& side) {
  for (int k = 0; k < 2; ++k)
    if (curve.material(k) != side.materials[0] && curve.material(k) != side.materials[1])
      return std::uint16_t(curve.material(k));
  return std::uint16_t(curve.material(2));
}

/// Calls visit(sides at one edge) for each edge.
template <class Visit>
void for_each_edge(std::span<const Side> sides, const Visit& visit) {
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    end = begin + 1;
    while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
    visit(sides.subspan(begin, end - begin));
  }
}

/// Points at which a mesh is measured, and the sides or the triangle that each distance belongs to.
class Samples {
 public:
  explicit Samples(const SurfaceMesh& mesh) : mesh_(mesh), sides_(sides_of(mesh)) {
    points_.reserve(3 * mesh.triangles.size());  // about 1.5 edges to a triangle
    junctions_.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& c = mesh.triangles[t];
      add((mesh.points[c.a] + mesh.points[c.b] + mesh.points[c.c]) / 3.0,
          Junction(mesh.materials[t][0], mesh.materials[t][1]));
    }
    for_each_edge(sides_, [&](std::span<const Side> at) {
      const Vec3d middle = 0.5 * (mesh.points[at[0].a] + mesh.points[at[0].b]);
      const auto* last = &at[0].materials;
      add(middle, Junction((*last)[0], (*last)[1]));
      for (const Side& s : at.subspan(1))
        if (s.materials != *last) last = &s.materials, add(middle, Junction((*last)[0], (*last)[1]));
      if (const Junction curve = curve_of(at); !(curve == Junction())) add(middle, curve);
    });
  }

  MeshDeviation measure(const NearestOnJunctions& onto, double unit) const {
    const std::vector<Vec3d> on = onto(points_, junctions_);
    const auto away = [&](std::size_t i) { return is_finite(on[i]) ? float(length(on[i] - points_[i]) / unit) : 0.0f; };
    MeshDeviation result;
    const std::size_t n = mesh_.triangles.size();
    result.triangle.resize(n);
    result.on_rim.resize(n);
    for (std::size_t t = 0; t < n; ++t) result.triangle[t] = away(t);
    std::size_t next = n;
    for_each_edge(sides_, [&](std::span<const Side> at) {
      const Junction curve = curve_of(at);
      std::size_t i = next;
      float largest = 0;
      for (std::size_t s = 0; s < at.size(); ++s) {
        if (s > 0 && at[s].materials != at[s - 1].materials) ++i;
        largest = std::max(largest, away(i));
        result.triangle[at[s].triangle] = std::max(result.triangle[at[s].triangle], away(i));
      }
      next = i + 1;
      if (curve == Junction()) return;
      largest = std::max(largest, away(next));
      const Vec3d nearest = is_finite(on[next]) ? on[next] : points_[next];
      ++next;
      for (const Side& s : at) {
        result.on_rim[s.triangle][s.k] = {largest, third_of(curve, s), nearest};
        result.triangle[s.triangle] = std::max(result.triangle[s.triangle], largest);
      }
    });
    for (const float d : result.triangle) result.max = std::max(result.max, double(d)), result.mean += d;
    result.mean /= double(std::max<std::size_t>(n, 1));
    return result;
  }

 private:
  void add(const Vec3d& point, const Junction& junction) {
    points_.push_back(point);
    junctions_.push_back(junction);
  }

  const SurfaceMesh& mesh_;
  std::vector<Side> sides_;
  std::vector<Vec3d> points_;
  std::vector<Junction> junctions_;
};

/// The points of a mesh at edges on junction curves.
class PointsOnCurves {
 public:
  PointsOnCurves(const SurfaceMesh& mesh, const MeshDeviation& deviation)
      : mesh_(mesh),
        number_(numbers_of(mesh, deviation)),
        tree_(points_of(mesh, number_), std::vector<std::uint32_t>{0, std::uint32_t(number_.size())}) {}

  /// Whether one of these points, not a or b, is nearer to `position` than both a and b.
  bool nearer_to_others(const Vec3d& position, std::uint32_t a, std::uint32_t b) const {
    const double to_ends = std::min(length(mesh_.points[a] - position), length(mesh_.points[b] - position));
    std::vector<PointTree::Found> found;
    tree_.within(0, position, to_ends, found);
    return std::any_of(found.begin(), found.end(),
                       [&](const PointTree::Found& f) { return number_[f.point] != a && number_[f.point] != b; });
  }

 private:
  static std::vector<std::uint32_t> numbers_of(const SurfaceMesh& mesh, const MeshDeviation& deviation) {
    std::vector<std::uint8_t> on_curve(mesh.points.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (deviation.on_rim[t][std::size_t(k)].away >= 0)
          on_curve[mesh.triangles[t][k]] = on_curve[mesh.triangles[t][(k + 1) % 3]] = 1;
    return marked(on_curve);
  }

  static std::vector<Vec3d> points_of(const SurfaceMesh& mesh, std::span<const std::uint32_t> numbers) {
    std::vector<Vec3d> points;
    points.reserve(numbers.size());
    for (const std::uint32_t v : numbers) points.push_back(mesh.points[v]);
    return points;
  }

  const SurfaceMesh& mesh_;
  std::vector<std::uint32_t> number_;
  PointTree tree_;
};

/// Chooses new points one after the other.
class Insertion {
 public:
  Insertion(const SurfaceMesh& mesh, const MeshDeviation& deviation, const DeviationRule& rule)
      : mesh_(mesh), deviation_(deviation), rule_(rule), on_curves_(mesh, deviation), beside_(mesh.points.size()) {}

  /// False where the triangle is too small.
  bool divide(std::uint32_t t) {
    const Triangle& c = mesh_.triangles[t];
    const std::array<Vec3d, 3> p{mesh_.points[c.a], mesh_.points[c.b], mesh_.points[c.c]};
    const Vec3d u = p[1] - p[0], v = p[2] - p[0], n = cross(u, v);
    const double square = dot(n, n);
    if (!(square > 0)) return false;
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
    if (rim >= 0) {
      const std::uint32_t a = c[rim], b = c[(rim + 1) % 3];
      const MeshDeviation::Rim& on = deviation_.on_rim[t][std::size_t(rim)];
      const Vec3d middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
      const Vec3d start = on_curves_.nearer_to_others(on.nearest, a, b) ? 2 * middle - on.nearest : middle;
      return insert(start, 0.5 * length(mesh_.points[b] - mesh_.points[a]), on.away, t, on.third);
    }
    return insert(centre, radius, deviation_.triangle[t], t, 0xffff);
  }

  std::vector<MeshDefects::NewPoint> take() { return std::move(found_); }

 private:
  /// `free`: the distance of `position` from other points; it will be moved by about `away`.
  bool insert(const Vec3d& position, double free, double away, std::uint32_t t, std::uint16_t third) {
    if (std::hypot(free, away * rule_.unit) < least_spacing * rule_.detail) return false;
    const Triangle& c = mesh_.triangles[t];
    for (int k = 0; k < 3; ++k)
      for (const std::uint32_t other : beside_[c[k]])
        if (length(found_[other].position - position) < apart * free) return true;  // that one comes first
    for (int k = 0; k < 3; ++k) beside_[c[k]].push_back(std::uint32_t(found_.size()));
    found_.push_back({position, mesh_.materials[t], c.a, third});
    return true;
  }

  const SurfaceMesh& mesh_;
  const MeshDeviation& deviation_;
  const DeviationRule& rule_;
  const PointsOnCurves on_curves_;
  std::vector<std::vector<std::uint32_t>> beside_;  ///< per point: new points in triangles at it
  std::vector<MeshDefects::NewPoint> found_;
};

}  // namespace

MeshDeviation measure_deviation(const SurfaceMesh& mesh, const NearestOnJunctions& onto, double unit) {
  return Samples(mesh).measure(onto, unit);
}

DeviationRange sampled_deviation(const SurfaceMesh& mesh, const SecondOrder* second, const NearestOnJunctions& onto,
                                 double unit) {
  constexpr double third = 1.0 / 3, sixth = 1.0 / 6;
  constexpr std::array<std::array<double, 3>, 7> samples{{{third, third, third},
                                                          {1 - 2 * sixth, sixth, sixth},
                                                          {sixth, 1 - 2 * sixth, sixth},
                                                          {sixth, sixth, 1 - 2 * sixth},
                                                          {0.75, 0.25, 0},
                                                          {0, 0.75, 0.25},
                                                          {0.25, 0, 0.75}}};
  std::vector<Vec3d> points;
  std::vector<Junction> junctions;
  points.reserve(samples.size() * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const Junction interface(mesh.materials[t][0], mesh.materials[t][1]);
    for (const auto& at : samples) {
      points.push_back(second ? point_of_triangle(nodes_of_triangle(mesh, *second, t), at)
                              : at[0] * mesh.points[c.a] + at[1] * mesh.points[c.b] + at[2] * mesh.points[c.c]);
      junctions.push_back(interface);
    }
  }
  const std::vector<Vec3d> on = onto(points, junctions);
  DeviationRange range;
  std::size_t found = 0;
  for (std::size_t i = 0; i < on.size(); ++i) {
    if (!is_finite(on[i])) continue;
    const double away = length(on[i] - points[i]) / unit;
    range.mean += away;
    range.max = std::max(range.max, away);
    ++found;
  }
  range.mean /= double(std::max<std::size_t>(found, 1));
  return range;
}

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

std::vector<MeshDefects::NewPoint> points_on_rims(std::span<const MeshDefects::NewPoint> points,
                                                  std::span<const std::uint32_t> taken, const NearestOnJunctions& onto,
                                                  const MaterialsAt& material_at) {
  std::vector<MeshDefects::NewPoint> lost;
  std::vector<Vec3d> position;
  std::vector<Junction> interface;
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (points[k].third != 0xffff || std::binary_search(taken.begin(), taken.end(), k)) continue;
    lost.push_back(points[k]);
    position.push_back(points[k].position);
    interface.emplace_back(points[k].materials[0], points[k].materials[1]);
  }
  if (lost.empty()) return lost;
  const std::vector<Vec3d> on = onto(position, interface);
  for (std::size_t k = 0; k < lost.size(); ++k)
    if (is_finite(on[k])) position[k] = lost[k].position = on[k];
  const std::vector<std::uint16_t> covered_by = material_at(position);
  for (std::size_t k = 0; k < lost.size(); ++k) lost[k].third = covered_by[k];
  std::erase_if(lost, [](const MeshDefects::NewPoint& p) {
    return p.third == p.materials[0] || p.third == p.materials[1] || p.third == 0xffff;
  });
  return lost;
}

}  // namespace nacre
