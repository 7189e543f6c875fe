// Nacre: how well shaped the triangles and tetrahedra of a mesh are.
#include "compute/meshing/quality.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace nacre {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr double small_angle = 25;  // degrees; what solvers begin to mind
constexpr double dihedral_lower = 10, dihedral_upper = 160;

/// Squared edges opposite of each corner, and the length of the cross product of two edges, from the two shorter ones:
/// the others lose digits in needles.
struct Shape {
  std::array<double, 3> squares;
  double twice_area;

  Shape(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d u = c - b, v = a - c, w = b - a;
    squares = {dot(u, u), dot(v, v), dot(w, w)};
    const auto longest = std::max_element(squares.begin(), squares.end()) - squares.begin();
    twice_area = length(longest == 0 ? cross(v, w) : longest == 1 ? cross(w, u) : cross(u, v));
  }
};

double ratio_of(const Shape& s) {
  const double a = std::sqrt(s.squares[0]), b = std::sqrt(s.squares[1]), c = std::sqrt(s.squares[2]);
  const double below = (a + b + c) * a * b * c;
  return below > 0 ? std::min(1.0, 4 * s.twice_area * s.twice_area / below) : 0;
}

std::array<double, 3> angles_of(const Shape& s) {
  std::array<double, 3> angles{};
  for (int k = 0; k < 3; ++k) {
    const double beside = s.squares[(k + 1) % 3] + s.squares[(k + 2) % 3] - s.squares[k];  // 2 |b| |c| cos
    if (s.squares[(k + 1) % 3] > 0 && s.squares[(k + 2) % 3] > 0)
      angles[k] = degrees * std::atan2(2 * s.twice_area, beside);
  }
  return angles;
}

/// Sums up triangles.
class Tally {
 public:
  void add(double ratio, const std::array<double, 3>& angles) {
    const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
    const int bins = int(sum_.radius_ratio_histogram.size());
    ++sum_.radius_ratio_histogram[std::clamp(int(ratio * bins), 0, bins - 1)];
    const bool first = sum_.triangles++ == 0;
    sum_.radius_ratio_mean += ratio;
    sum_.radius_ratio_min = first ? ratio : std::min(sum_.radius_ratio_min, ratio);
    sum_.angle_min = first ? *smallest : std::min(sum_.angle_min, *smallest);
    sum_.angle_max = std::max(sum_.angle_max, *largest);
    sum_.angle_mean_min += *smallest;
    sum_.share_under_25 += *smallest < small_angle;
  }

  void add(const Tally& other) {
    const TriangleQuality& more = other.sum_;
    if (more.triangles == 0) return;
    for (std::size_t k = 0; k < sum_.radius_ratio_histogram.size(); ++k)
      sum_.radius_ratio_histogram[k] += more.radius_ratio_histogram[k];
    const bool first = sum_.triangles == 0;
    sum_.triangles += more.triangles;
    sum_.radius_ratio_mean += more.radius_ratio_mean;
    sum_.radius_ratio_min = first ? more.radius_ratio_min : std::min(sum_.radius_ratio_min, more.radius_ratio_min);
    sum_.angle_min = first ? more.angle_min : std::min(sum_.angle_min, more.angle_min);
    sum_.angle_max = std::max(sum_.angle_max, more.angle_max);
    sum_.angle_mean_min += more.angle_mean_min;
    sum_.share_under_25 += more.share_under_25;
  }

  TriangleQuality result() const {
    TriangleQuality q = sum_;
    if (q.triangles == 0) return q;
    for (double* value : {&q.radius_ratio_mean, &q.angle_mean_min, &q.share_under_25}) *value /= double(q.triangles);
    return q;
  }

 private:
  TriangleQuality sum_;
};

}  // namespace

double radius_ratio(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return ratio_of(Shape(a, b, c)); }

std::array<double, 3> triangle_angles(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return angles_of(Shape(a, b, c));
}

std::array<double, 6> dihedral_angles(const std::array<Vec3d, 4>& p) {
  constexpr int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
  std::array<double, 6> angles;
  for (int e = 0; e < 6; ++e) {
    const auto& [i, j, k, l] = edges[e];
    const Vec3d along = p[j] - p[i];
    const Vec3d s = cross(along, p[k] - p[i]), t = cross(along, p[l] - p[i]);
    angles[e] = degrees * std::atan2(length(cross(s, t)), dot(s, t));
  }
  return angles;
}

std::vector<std::uint8_t> junction_points(const SurfaceMesh& mesh) {
  constexpr std::uint16_t none = 0xffff;
  std::vector<std::array<std::uint16_t, 2>> seen(mesh.points.size(), {none, none});
  std::vector<std::uint8_t> at_junction(mesh.points.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = mesh.triangles[i][k];
      if (seen[p][0] == none) seen[p] = mesh.materials[i];
      at_junction[p] |= mesh.materials[i] != seen[p];
    }
  return at_junction;
}

SurfaceQuality surface_quality(const SurfaceMesh& mesh) {
  const std::vector<std::uint8_t> at_junction = junction_points(mesh);
  constexpr std::size_t part = 1 << 14;  // whatever the number of threads is: sums depend on it
  std::vector<std::array<Tally, 2>> tallies((mesh.triangles.size() + part - 1) / part);
  tbb::parallel_for(std::size_t(0), tallies.size(), [&](std::size_t k) {
    auto& [all, away] = tallies[k];
    for (std::size_t i = k * part; i < std::min(mesh.triangles.size(), (k + 1) * part); ++i) {
      const Triangle& t = mesh.triangles[i];
      const Shape shape(mesh.points[t.a], mesh.points[t.b], mesh.points[t.c]);
      const double ratio = ratio_of(shape);
      const std::array<double, 3> angles = angles_of(shape);
      all.add(ratio, angles);
      if (!at_junction[t.a] && !at_junction[t.b] && !at_junction[t.c]) away.add(ratio, angles);
    }
  });
  Tally all, away;
  for (const auto& [some, some_away] : tallies) all.add(some), away.add(some_away);
  return {all.result(), away.result()};
}

std::vector<std::uint32_t> triangles_short_of(const SurfaceMesh& mesh, double angle, double ratio) {
  const std::vector<std::uint8_t> at_junction = junction_points(mesh);
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (at_junction[t.a] || at_junction[t.b] || at_junction[t.c]) continue;
    const Vec3d &a = mesh.points[t.a], &b = mesh.points[t.b], &c = mesh.points[t.c];
    const auto angles = triangle_angles(a, b, c);
    if (radius_ratio(a, b, c) < ratio || *std::min_element(angles.begin(), angles.end()) < angle) found.push_back(i);
  }
  return found;
}

CellQuality cell_quality(const TetrahedralMesh& mesh, int materials) {
  CellQuality q;
  q.volume.resize(std::size_t(materials));
  q.cells = std::int64_t(mesh.cells.size());
  q.dihedral_min = q.cells > 0 ? 180 : 0;
  std::int64_t good = 0;
  const int bins = int(q.dihedral_histogram.size());
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    std::array<Vec3d, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = mesh.points[mesh.cells[i][k]];
    const double volume = dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])) / 6;
    q.inverted += !(volume > 0);
    assert(mesh.material[i] < materials);
    q.volume[mesh.material[i]] += volume;
    const std::array<double, 6> angles = dihedral_angles(p);
    for (const double angle : angles) ++q.dihedral_histogram[std::clamp(int(angle * bins / 180), 0, bins - 1)];
    const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
    q.dihedral_min = std::min(q.dihedral_min, *smallest);
    q.dihedral_max = std::max(q.dihedral_max, *largest);
    good += *smallest >= dihedral_lower && *largest <= dihedral_upper;
  }
  if (q.cells > 0) q.share_within_10_160 = double(good) / double(q.cells);
  return q;
}

}  // namespace nacre
