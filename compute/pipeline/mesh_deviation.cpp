// Nacre: how far flat triangles are from the interfaces that they stand for.
#include "compute/pipeline/mesh_deviation.hpp"

#include <algorithm>

#include "compute/pipeline/mesh_sides.hpp"

namespace nacre {
namespace {

/// The one of a curve's three materials that does not meet at this side.
std::uint16_t third_of(const Junction& curve, const MeshSide& side) {
  for (int k = 0; k < 2; ++k)
    if (curve.material(k) != side.materials[0] && curve.material(k) != side.materials[1])
      return std::uint16_t(curve.material(k));
  return std::uint16_t(curve.material(2));
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
    for_each_edge(sides_, [&](std::span<const MeshSide> at) {
      const Vec3d middle = 0.5 * (mesh.points[at[0].a] + mesh.points[at[0].b]);
      const auto* last = &at[0].materials;
      add(middle, Junction((*last)[0], (*last)[1]));
      for (const MeshSide& s : at.subspan(1))
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
    for_each_edge(sides_, [&](std::span<const MeshSide> at) {
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
      for (const MeshSide& s : at) {
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
  std::vector<MeshSide> sides_;
  std::vector<Vec3d> points_;
  std::vector<Junction> junctions_;
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

}  // namespace nacre
