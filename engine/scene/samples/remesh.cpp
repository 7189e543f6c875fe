// Nacre: makes the triangles of a closed implicit surface nearly equilateral.
#include "engine/scene/samples/remesh.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

namespace nacre {
namespace {

using Index = std::uint32_t;

constexpr double least_facing =
    0.5;  // a change that turns triangles further than this from the surface's normals must be no worse
constexpr std::size_t max_fan = 10;  // most triangles about a point that a collapse may create

class Remesher {
 public:
  Remesher(const ImplicitFunction& f, double edge, PolygonMesh& mesh)
      : f_(f), edge_(edge), points_(mesh.points), normals_(mesh.normals), triangles_(mesh.triangles) {
    fans_.resize(points_.size());
    for (Index t = 0; t < triangles_.size(); ++t)
      for (int k = 0; k < 3; ++k) fans_[triangles_[t][k]].push_back(t);
  }

  void collapse_edges_below(double shortest);
  void flip_edges();
  void spread_points();
  void compact();

 private:
  static bool has(const Triangle& t, Index v) { return t.a == v || t.b == v || t.c == v; }
  static bool alive(const Triangle& t) { return t.a != t.b; }
  static Triangle replaced(Triangle t, Index from, Index to) {
    (t.a == from ? t.a : t.b == from ? t.b : t.c) = to;
    return t;
  }
  static Index third(const Triangle& t, Index a, Index b) {
    return t.a != a && t.a != b ? t.a : t.b != a && t.b != b ? t.b : t.c;
  }

  Vec3d area_vector(const Triangle& t) const { return cross(points_[t.b] - points_[t.a], points_[t.c] - points_[t.a]); }
  double facing(const Triangle& t) const;
  double worst_facing(const std::vector<Index>& fan) const;
  double least_angle_cosine(const Triangle& t) const;
  void neighbours(Index v, std::vector<Index>& out) const;
  bool collapse(Index gone, Index kept);
  bool flip(Index a, Index b);
  Vec3d on_surface(Vec3d p, const Vec3d& normal) const;

  const ImplicitFunction& f_;
  double edge_;
  std::vector<Vec3d>& points_;
  std::vector<Vec3d>& normals_;
  std::vector<Triangle>& triangles_;
  std::vector<std::vector<Index>> fans_;  // triangles about each point; empty where the point is gone
  mutable std::vector<Index> ring_a_, ring_b_;
};

/// The least cosine between a triangle and the surface at its corners; -1 where it has hardly an area.
double Remesher::facing(const Triangle& t) const {
  const Vec3d area = area_vector(t);
  const double size = length(area);
  if (!(size > 1e-4 * edge_ * edge_)) return -1;
  return std::min({dot(area, normals_[t.a]), dot(area, normals_[t.b]), dot(area, normals_[t.c])}) / size;
}

double Remesher::worst_facing(const std::vector<Index>& fan) const {
  double worst = 1;
  for (const Index t : fan) worst = std::min(worst, facing(triangles_[t]));
  return worst;
}

/// The largest cosine of the three angles: less is better.
double Remesher::least_angle_cosine(const Triangle& t) const {
  double largest = -1;
  for (int k = 0; k < 3; ++k) {
    const Vec3d u = points_[t[(k + 1) % 3]] - points_[t[k]], v = points_[t[(k + 2) % 3]] - points_[t[k]];
    largest = std::max(largest, dot(u, v) / std::max(length(u) * length(v), 1e-300));
  }
  return largest;
}

/// Points joined to `v` by an edge, sorted.
void Remesher::neighbours(Index v, std::vector<Index>& out) const {
  out.clear();
  for (const Index t : fans_[v])
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] != v) out.push_back(triangles_[t][k]);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

/// Draws `gone` into `kept` unless that would pinch the surface (the link condition), stretch or turn a triangle.
bool Remesher::collapse(Index gone, Index kept) {
  neighbours(gone, ring_a_);
  neighbours(kept, ring_b_);
  if (ring_a_.size() + ring_b_.size() > max_fan + 4) return false;
  std::size_t shared = 0;
  for (const Index v : ring_a_) {
    const bool common = std::binary_search(ring_b_.begin(), ring_b_.end(), v);
    shared += common;
    if (common && fans_[v].size() <= 3) return false;
    if (length(points_[v] - points_[kept]) > 1.4 * edge_) return false;
  }
  if (shared != 2) return false;
  const double least = std::min(least_facing, worst_facing(fans_[gone]));
  for (const Index t : fans_[gone])
    if (!has(triangles_[t], kept) && !(facing(replaced(triangles_[t], gone, kept)) >= least)) return false;

  for (const Index t : fans_[gone]) {
    if (has(triangles_[t], kept)) {
      std::erase(fans_[kept], t);
      std::erase(fans_[third(triangles_[t], gone, kept)], t);
      triangles_[t] = {};
    } else {
      triangles_[t] = replaced(triangles_[t], gone, kept);
      fans_[kept].push_back(t);
    }
  }
  fans_[gone].clear();
  return true;
}

void Remesher::collapse_edges_below(double shortest) {
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3 && alive(triangles_[t]); ++k) {
      const Index a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
      if (length(points_[a] - points_[b]) < shortest && (collapse(a, b) || collapse(b, a))) break;
    }
  }
}

/// Replaces the edge a-b by the other diagonal of its two triangles where that widens their smallest angle.
bool Remesher::flip(Index a, Index b) {
  Index s = 0, t = 0;  // a-b runs forward in s, backward in t
  for (const Index i : fans_[a]) {
    if (!has(triangles_[i], b)) continue;
    const Triangle& u = triangles_[i];
    const bool forward = (u.a == a && u.b == b) || (u.b == a && u.c == b) || (u.c == a && u.a == b);
    (forward ? s : t) = i;
  }
  const Index c = third(triangles_[s], a, b), d = third(triangles_[t], a, b);
  if (c == d || fans_[a].size() <= 3 || fans_[b].size() <= 3) return false;
  const Triangle first{a, d, c}, second{d, b, c};
  const double before = std::max(least_angle_cosine(triangles_[s]), least_angle_cosine(triangles_[t]));
  const double after = std::max(least_angle_cosine(first), least_angle_cosine(second));
  if (after > before - 1e-6) return false;
  const double least = std::min({least_facing, facing(triangles_[s]), facing(triangles_[t])});
  if (!(std::min(facing(first), facing(second)) >= least)) return false;
  for (const Index i : fans_[c])
    if (has(triangles_[i], d)) return false;

  triangles_[s] = first;
  triangles_[t] = second;
  std::erase(fans_[a], t);
  std::erase(fans_[b], s);
  fans_[c].push_back(t);
  fans_[d].push_back(s);
  return true;
}

void Remesher::flip_edges() {
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3 && alive(triangles_[t]); ++k) {
      const Index a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
      if (a < b && flip(a, b)) break;
    }
  }
}

/// The zero of `f` near `p` along its gradient; `normal` gives the gradient's direction where it is not resolved.
Vec3d Remesher::on_surface(Vec3d p, const Vec3d& normal) const {
  for (int i = 0; i < 8; ++i) {
    const double value = f_(p);
    if (std::abs(value) < 1e-10 * edge_) break;
    const Vec3d direction = i == 0 ? normal : implicit_normal(f_, p, edge_);
    const double h = 1e-5 * edge_;
    const double slope = (f_(p + direction * h) - f_(p - direction * h)) / (2 * h);
    if (!(std::abs(slope) > 0.05)) break;
    p -= direction * (value / slope);
  }
  return p;
}

/// Moves every point towards the middle of its neighbours and back onto the surface.
void Remesher::spread_points() {
  std::vector<Vec3d> moved = points_, turned = normals_;
  tbb::parallel_for(std::size_t(0), points_.size(), [&](std::size_t v) {
    if (fans_[v].empty()) return;
    Vec3d middle;
    double weight = 0;
    for (const Index t : fans_[v]) {
      const Triangle& s = triangles_[t];
      const double area = length(area_vector(s));
      middle += (points_[s.a] + points_[s.b] + points_[s.c]) * (area / 3);
      weight += area;
    }
    const Vec3d step = middle / weight - points_[v];
    const Vec3d target = points_[v] + step - normals_[v] * dot(step, normals_[v]);
    const Vec3d landed = on_surface(target, normals_[v]);
    if (!(length(landed - target) < 0.5 * edge_) || !(std::abs(f_(landed)) < 1e-9 * edge_)) return;
    moved[v] = landed;
    turned[v] = implicit_normal(f_, landed, edge_);
  });
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (fans_[v].empty()) continue;
    const double least = std::min(least_facing, worst_facing(fans_[v]));
    std::swap(points_[v], moved[v]);
    std::swap(normals_[v], turned[v]);
    if (worst_facing(fans_[v]) >= least) continue;
    points_[v] = moved[v];
    normals_[v] = turned[v];
  }
}

/// Drops the points and triangles that are gone.
void Remesher::compact() {
  std::erase_if(triangles_, [](const Triangle& t) { return !alive(t); });
  std::vector<Index> index(points_.size());
  Index count = 0;
  for (Index v = 0; v < points_.size(); ++v) {
    if (fans_[v].empty()) continue;
    points_[count] = points_[v];
    normals_[count] = normals_[v];
    index[v] = count++;
  }
  points_.resize(count);
  normals_.resize(count);
  for (Triangle& t : triangles_) t = {index[t.a], index[t.b], index[t.c]};
}

}  // namespace

void remesh(const ImplicitFunction& f, double edge, PolygonMesh& mesh) {
  Remesher remesher(f, edge, mesh);
  for (const double fraction : {0.3, 0.5}) remesher.collapse_edges_below(fraction * edge);
  for (int round = 0; round < 3; ++round) {
    remesher.flip_edges();
    remesher.collapse_edges_below(0.72 * edge);
    remesher.flip_edges();
    remesher.spread_points();
  }
  remesher.flip_edges();
  remesher.spread_points();
  remesher.compact();
}

}  // namespace nacre
