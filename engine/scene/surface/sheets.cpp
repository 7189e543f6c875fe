// Nacre: two sheets in one place.
#include "engine/scene/surface/sheets.hpp"

#include <algorithm>
#include <cmath>

#include "compute/math/disjoint_sets.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_around = 256;  // triangles around a position, above which they are not compared
constexpr double opposite = -0.999;       // cosine between normals that face each other's back
constexpr double near_corner = 0.01;      // share of the way from a corner to the middle of its triangle
constexpr double in_plane = 1e-6;         // of a triangle's size

class SheetFinder {
 public:
  SheetFinder(std::span<const Vec3d> points, std::span<const std::uint32_t> same, std::span<const Triangle> triangles)
      : points_(points), same_(same), triangles_(triangles), several_(points.size(), 0), sheets_(points.size()) {}

  SecondSheets run() {
    SecondSheets found;
    if (!find_doubled_positions()) return found;
    list_candidates();
    find_pairs();
    found.suspected = !pairs_.empty();
    for (const auto& [t, u] : pairs_)
      for (const std::uint32_t triangle : {t, u}) join_points(triangle);
    choose_sides();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> seconds;
    for (const auto& [t, u] : pairs_)
      if (side_of(t) == second) seconds.push_back({t, u});
    if (!seconds.empty()) add_corners_of_rims(seconds);
    std::sort(seconds.begin(), seconds.end());
    for (const auto& [t, u] : seconds) {
      found.triangles.push_back(t);
      found.backing.push_back(u);
    }
    return found;
  }

 private:
  static constexpr char unknown = 0, first = 1, second = 2;

  /// Positions at which triangles use different points; false where there are none.
  bool find_doubled_positions() {
    std::vector<std::uint32_t> used(points_.size(), none);
    bool any = false;
    for (const Triangle& t : triangles_)
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& user = used[same_[t[k]]];
        if (user == none) user = t[k];
        if (user != t[k]) several_[same_[t[k]]] = any = true;
      }
    return any;
  }

  bool own(std::uint32_t point) const { return several_[same_[point]] != 0; }

  /// Triangles that stand on such a position, around each position.
  void list_candidates() {
    start_.assign(points_.size() + 2, 0);
    const auto each = [&](const auto& visit) {
      for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const Triangle& c = triangles_[t];
        if (own(c.a) || own(c.b) || own(c.c))
          for (int k = 0; k < 3; ++k) visit(t, same_[c[k]]);
      }
    };
    each([&](std::uint32_t, std::uint32_t p) { ++start_[p + 2]; });
    for (std::size_t p = 2; p < start_.size(); ++p) start_[p] += start_[p - 1];
    around_.resize(start_.back());
    each([&](std::uint32_t t, std::uint32_t p) { around_[start_[p + 1]++] = t; });
  }

  Vec3d normal_of(const Triangle& t) const {
    return normalized(cross(points_[t.b] - points_[t.a], points_[t.c] - points_[t.a]));
  }

  /// Whether `p` lies in a triangle with this unit normal.
  bool holds(const Triangle& t, const Vec3d& normal, const Vec3d& p) const {
    const Vec3d a = points_[t.a], b = points_[t.b], c = points_[t.c];
    const double size = std::sqrt(std::max(dot(b - a, b - a), dot(c - a, c - a)));
    if (std::fabs(dot(normal, p - a)) > in_plane * size) return false;
    const auto beside = [&](const Vec3d& from, const Vec3d& to) {
      return dot(normal, cross(to - from, p - from)) < -in_plane * size * size;
    };
    return !beside(a, b) && !beside(b, c) && !beside(c, a);
  }

  static bool share_all_points(const Triangle& t, const Triangle& u) {
    const auto has = [&](std::uint32_t p) { return p == u.a || p == u.b || p == u.c; };
    return has(t.a) && has(t.b) && has(t.c);
  }

  /// The triangle that lies on `t` and faces the other way; `none`: there is none. It is looked for around the corners,
  /// since two sheets in one place have their corners in common.
  std::uint32_t backing_of(std::uint32_t t) const {
    const Triangle& own = triangles_[t];
    const Vec3d normal = normal_of(own), middle = (points_[own.a] + points_[own.b] + points_[own.c]) / 3.0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t corner = same_[own[k]];
      if (start_[corner + 1] - start_[corner] > most_around) continue;
      const Vec3d inside = points_[own[k]] + (middle - points_[own[k]]) * near_corner;
      for (std::size_t i = start_[corner]; i < start_[corner + 1]; ++i) {
        const Triangle& other = triangles_[around_[i]];
        if (around_[i] == t || share_all_points(own, other)) continue;
        const Vec3d facing = normal_of(other);
        if (dot(normal, facing) < opposite && holds(other, facing, inside)) return around_[i];
      }
    }
    return none;
  }

  void find_pairs() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const Triangle& c = triangles_[t];
      if (!own(c.a) && !own(c.b) && !own(c.c)) continue;
      if (const std::uint32_t u = backing_of(t); u != none) pairs_.push_back({t, u});
    }
  }

  /// Where both sheets use the points of their rim, a triangle may have no others: it is on the other side than what it
  /// lies on.
  void add_corners_of_rims(std::vector<std::pair<std::uint32_t, std::uint32_t>>& seconds) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (sheet_of(t) != none) continue;
      const std::uint32_t u = backing_of(t);
      if (u != none && side_of(u) == first) seconds.push_back({t, u});
    }
  }

  /// A point at a position with several belongs to one sheet, and so do all triangles that use it.
  void join_points(std::uint32_t t) {
    std::uint32_t joined = none;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = triangles_[t][k];
      if (!own(p)) continue;
      if (joined != none) sheets_.join(joined, p);
      joined = p;
    }
  }

  std::uint32_t sheet_of(std::uint32_t t) {
    for (int k = 0; k < 3; ++k)
      if (own(triangles_[t][k])) return sheets_.find(triangles_[t][k]);
    return none;
  }

  char side_of(std::uint32_t t) {
    const std::uint32_t sheet = sheet_of(t);
    return sheet == none ? first : side_[sheet];
  }

  /// The sheet of the earliest triangle is a first one, those that lie on it are second ones, and so on. A sheet that
  /// lies on itself, or on two that lie on each other, stays what it is first called.
  void choose_sides() {
    side_.assign(points_.size(), unknown);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> touching;
    for (const auto& [t, u] : pairs_) {
      const std::uint32_t a = sheet_of(t), b = sheet_of(u);
      if (a == none || b == none || a == b) continue;
      touching.push_back({a, b});
      touching.push_back({b, a});
    }
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
    std::vector<std::uint32_t> open;
    for (const auto& [t, u] : pairs_) {
      const std::uint32_t seed = sheet_of(t);
      if (seed == none || side_[seed] != unknown) continue;
      side_[seed] = first;
      open.assign(1, seed);
      while (!open.empty()) {
        const std::uint32_t a = open.back();
        open.pop_back();
        const auto begin = std::lower_bound(touching.begin(), touching.end(), std::pair(a, 0u));
        for (auto edge = begin; edge != touching.end() && edge->first == a; ++edge)
          if (side_[edge->second] == unknown) {
            side_[edge->second] = char(3 - side_[a]);
            open.push_back(edge->second);
          }
      }
    }
  }

  std::span<const Vec3d> points_;
  std::span<const std::uint32_t> same_;
  std::span<const Triangle> triangles_;
  std::vector<char> several_;  ///< per position, at its first point
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> around_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;  ///< a triangle and one that it lies on, ascending
  DisjointSets sheets_;
  std::vector<char> side_;  ///< per sheet, at its first point
};

}  // namespace

SecondSheets find_second_sheets(std::span<const Vec3d> points, std::span<const std::uint32_t> same,
                                std::span<const Triangle> triangles) {
  return SheetFinder(points, same, triangles).run();
}

}  // namespace nacre
