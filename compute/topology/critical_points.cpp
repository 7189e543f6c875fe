// Nacre: the critical points of a tangential vector field on triangles.
#include "compute/topology/critical_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compute/math/disjoint_sets.hpp"
#include "compute/topology/linear_fit.hpp"

namespace nacre {
namespace {

struct Crossing {
  double speed;  ///< from which on the two triangles belong together
  std::uint32_t half_edge;
};

std::vector<Crossing> crossings(const TangentField& field) {
  std::vector<Crossing> all;
  for (std::uint32_t h = 0; h < 3 * field.triangles(); ++h)
    if (field.twin(h) != none && h < field.twin(h)) all.push_back({field.least_speed(h), h});
  std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) {
    return a.speed != b.speed ? a.speed < b.speed : a.half_edge < b.half_edge;
  });
  return all;
}

Vec3d middle(const TangentField& field, std::uint32_t t) {
  return (field.corner_point(3 * t) + field.corner_point(3 * t + 1) + field.corner_point(3 * t + 2)) / 3.0;
}

double area(const TangentField& field, std::uint32_t t) {
  const Vec3d a = field.corner_point(3 * t);
  return 0.5 * length(cross(field.corner_point(3 * t + 1) - a, field.corner_point(3 * t + 2) - a));
}

/// For each triangle with a zero the speed at which that is cancelled; where it never is, `never`.
std::vector<double> persistences(const TangentField& field, const std::vector<Crossing>& order, double never) {
  std::vector<double> result(field.triangles(), never);
  std::vector<std::vector<std::uint32_t>> zeros(field.triangles());  // of each root, all of one sign
  for (std::uint32_t t = 0; t < field.triangles(); ++t)
    if (field.index(t) != 0) zeros[t].assign(std::size_t(std::abs(field.index(t))), t);
  DisjointSets sets(field.triangles());
  for (const Crossing& each : order) {
    const std::uint32_t a = sets.find(each.half_edge / 3), b = sets.find(field.twin(each.half_edge) / 3);
    if (a == b) continue;
    const std::uint32_t kept = sets.join(a, b);
    std::vector<std::uint32_t>& mine = zeros[kept];
    std::vector<std::uint32_t>& other = zeros[kept == a ? b : a];
    if (!mine.empty() && !other.empty() && field.index(mine[0]) * field.index(other[0]) < 0)
      while (!mine.empty() && !other.empty()) {
        std::size_t best_i = 0, best_j = 0;
        double nearest = 1e300;
        for (std::size_t i = 0; i < mine.size(); ++i)
          for (std::size_t j = 0; j < other.size(); ++j) {
            const double distance = length(middle(field, mine[i]) - middle(field, other[j]));
            if (distance < nearest) nearest = distance, best_i = i, best_j = j;
          }
        result[mine[best_i]] = result[other[best_j]] = each.speed;
        mine.erase(mine.begin() + std::ptrdiff_t(best_i));
        other.erase(other.begin() + std::ptrdiff_t(best_j));
      }
    mine.insert(mine.end(), other.begin(), other.end());
    std::vector<std::uint32_t>().swap(other);
  }
  return result;
}

/// The triangles of each set that speeds up to `limit` make, for those sets that `wanted` is in.
struct SlowSets {
  DisjointSets sets;
  std::vector<std::vector<std::uint32_t>> members;  ///< by root; empty where it is not wanted

  SlowSets(const TangentField& field, const std::vector<Crossing>& order, double limit,
           const std::vector<std::uint32_t>& wanted)
      : sets(field.triangles()), members(field.triangles()) {
    for (const Crossing& each : order) {
      if (each.speed > limit) break;
      const std::uint32_t a = sets.find(each.half_edge / 3), b = sets.find(field.twin(each.half_edge) / 3);
      if (a != b) sets.join(a, b);
    }
    std::vector<bool> is_wanted(field.triangles());
    for (const std::uint32_t t : wanted) is_wanted[sets.find(t)] = true;
    for (std::uint32_t t = 0; t < field.triangles(); ++t)
      if (is_wanted[sets.find(t)]) members[sets.find(t)].push_back(t);
  }
};

/// Adds what shares a vertex with the sorted `triangles` to them.
std::vector<std::uint32_t> grown(const TangentField& field, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> result = triangles;
  for (const std::uint32_t t : triangles)
    for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
      for (const bool clockwise : {false, true})
        for (std::uint32_t at = c; at != none;) {
          result.push_back(at / 3);
          const std::uint32_t over = field.twin(clockwise ? at : TangentField::previous(at));
          at = over == none ? none : clockwise ? TangentField::next(over) : over;
          if (at == c) break;
        }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

CriticalKind kind_of(const LinearFit& fit, int index) {
  if (index < 0) return CriticalKind::saddle;
  const double real = fit.first.real();
  if (fit.first.imag() == 0) return real + fit.second.real() > 0 ? CriticalKind::source : CriticalKind::sink;
  if (std::fabs(real) <= std::max(2 * fit.real_error, 1e-6 * fit.first.imag())) return CriticalKind::centre;
  return real > 0 ? CriticalKind::focus_source : CriticalKind::focus_sink;
}

/// `slow`: the set around the zero if no other zero remains in it, else only its triangle.
CriticalPoint describe(const TangentField& field, std::uint32_t zero, const std::vector<std::uint32_t>& slow) {
  CriticalPoint point;
  point.index = field.index(zero);
  Vec3d centre;
  double whole = 0;
  for (const std::uint32_t t : slow) {
    centre += middle(field, t) * area(field, t);
    whole += area(field, t);
  }
  centre = whole > 0 ? centre / whole : middle(field, zero);
  // The middle of the set on the surface, and what lies around it; long sets are cut to a disc.
  const double radius = 2 * std::sqrt(whole / std::numbers::pi);
  std::vector<std::uint32_t> around;
  std::uint32_t nearest = zero;
  for (const std::uint32_t t : slow) {
    const double distance = length(middle(field, t) - centre);
    if (distance < length(middle(field, nearest) - centre)) nearest = t;
    if (distance <= radius) around.push_back(t);
  }
  if (around.empty()) around.push_back(nearest);
  around = grown(field, around);
  LinearFit fit = fit_linear(field, nearest, around);
  if (!fit.good(point.index)) fit = fit_linear(field, zero, {zero});
  if (!fit.good(point.index) && slow.size() > 1) fit = fit_linear(field, nearest, {nearest});
  point.triangle = fit.triangle;
  point.weights = fit.weights;
  for (int k = 0; k < 3; ++k)
    point.position += field.corner_point(3 * fit.triangle + std::uint32_t(k)) * fit.weights[k];
  point.kind = kind_of(fit, point.index);
  point.first = fit.first;
  point.second = fit.second;
  point.first_axis = fit.first_axis;
  point.second_axis = fit.second_axis;
  return point;
}

}  // namespace

const char* name_of(CriticalKind kind) {
  switch (kind) {
    case CriticalKind::saddle: return "saddle";
    case CriticalKind::source: return "source";
    case CriticalKind::sink: return "sink";
    case CriticalKind::focus_source: return "focus source";
    case CriticalKind::focus_sink: return "focus sink";
    case CriticalKind::centre: return "centre";
  }
  return "";
}

FlowTopology find_critical_points(const TangentField& field, double least_persistence) {
  FlowTopology all;
  all.euler_characteristic = field.euler_characteristic();
  all.rims = field.rims().size();
  for (const TangentField::Rim& rim : field.rims()) all.rim_index += rim.index - 1;
  double fastest = 0;
  for (std::size_t v = 0; v < field.vertices(); ++v) fastest = std::max(fastest, field.speed(v));
  const std::vector<Crossing> order = crossings(field);
  const std::vector<double> persistence = persistences(field, order, fastest);

  // Zero regions: sets of triangles around more than one point whose vector is zero.
  std::vector<std::uint32_t> at_zero, kept;
  for (std::uint32_t t = 0; t < field.triangles(); ++t)
    for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
      if (field.speed(field.vertex(c)) == 0 && (at_zero.empty() || at_zero.back() != t)) at_zero.push_back(t);
  SlowSets zero(field, order, 0, at_zero);
  std::vector<std::uint32_t> region_of(field.triangles(), none);
  for (std::uint32_t root = 0; root < field.triangles(); ++root) {
    std::vector<std::uint32_t> still;
    ZeroRegion region{.triangle = root};
    for (const std::uint32_t t : zero.members[root]) {
      std::size_t zeros = 0;
      for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
        if (field.speed(field.vertex(c)) == 0) still.push_back(field.vertex(c)), ++zeros;
      if (zeros == 3) region.area += area(field, t);
    }
    std::sort(still.begin(), still.end());
    region.points = std::size_t(std::unique(still.begin(), still.end()) - still.begin());
    if (region.points < 2) continue;
    for (const std::uint32_t t : zero.members[root]) region_of[t] = std::uint32_t(all.zero_regions.size());
    all.zero_regions.push_back(region);
  }

  for (std::uint32_t t = 0; t < field.triangles(); ++t) {
    if (field.index(t) == 0) continue;
    if (persistence[t] <= least_persistence && persistence[t] < fastest)
      ++all.cancelled;
    else if (region_of[t] != none)
      all.zero_regions[region_of[t]].index += field.index(t);
    else
      kept.push_back(t);
  }
  for (const ZeroRegion& region : all.zero_regions) all.region_index += region.index;
  SlowSets slow(field, order, least_persistence, kept);
  std::vector<int> in_set(field.triangles());
  for (const std::uint32_t t : kept) ++in_set[slow.sets.find(t)];
  for (const std::uint32_t t : kept) {
    const std::uint32_t root = slow.sets.find(t);
    CriticalPoint point = describe(field, t, in_set[root] == 1 ? slow.members[root] : std::vector<std::uint32_t>{t});
    point.persistence = persistence[t];
    all.point_index += point.index;
    all.points.push_back(point);
  }
  return all;
}

}  // namespace nacre
