// Nacre: badly shaped tetrahedra improved by flips and by moving points.
#include "compute/meshing/improve_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compute/device/error.hpp"
#include "compute/meshing/cell_store.hpp"
#include "compute/meshing/interface_facets.hpp"

namespace nacre {
namespace {

constexpr double bad = 0.25;            // shapes below this are worked on
constexpr double gain = 1e-3;           // that a step must bring, so that steps come to an end
constexpr std::size_t most_around = 9;  // cells around an edge that is taken away
constexpr int most_rounds = 8;

using Cell = CellStore::Cell;

/// Whether two orders of the same four corners turn the same way.
bool is_even(const Cell& s, const Cell& t) {
  std::array<int, 4> at{};
  for (int i = 0; i < 4; ++i) at[i] = int(std::find(t.begin(), t.end(), s[i]) - t.begin());
  bool even = true;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) even ^= at[i] > at[j];
  return even;
}

class Improvement {
 public:
  Improvement(std::vector<Vec3d>& points, std::size_t fixed, MaterialCells& cells, const std::atomic<bool>* stop)
      : points_(points), fixed_(fixed), store_(cells, points.size()), touched_(points.size()), stop_(stop) {}

  CellImprovement run() {
    for (round_ = 1; round_ <= most_rounds; ++round_) {
      const std::vector<std::int32_t> worst = bad_cells();
      if (round_ == 1) result_.bad_before = std::int64_t(worst.size());
      const std::int64_t steps = result_.flips + result_.moves;
      for (const std::int32_t cell : worst) {
        check_stop(stop_);
        if (is_bad(cell) && may_help(cell) && !flip(cell)) move_corners(cell);
      }
      if (result_.flips + result_.moves == steps) break;
    }
    result_.bad_after = std::int64_t(bad_cells().size());
    store_.close_ranks();
    return result_;
  }

 private:
  double shape(const Cell& v) const { return cell_shape(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]); }
  bool is_bad(std::int32_t cell) const { return store_.alive(cell) && shape(store_.vertices(cell)) < bad; }

  std::vector<std::int32_t> bad_cells() const {
    std::vector<std::int32_t> found;
    for (std::int32_t i = 0; i < store_.size(); ++i)
      if (is_bad(i)) found.push_back(i);
    return found;
  }

  /// Whether anything near the cell changed since it was last tried.
  bool may_help(std::int32_t cell) const {
    const Cell& v = store_.vertices(cell);
    return std::any_of(v.begin(), v.end(), [&](std::uint32_t p) { return touched_[p] + 1 >= round_; });
  }
  void touch(const Cell& cell) {
    for (const std::uint32_t p : cell) touched_[p] = std::uint8_t(round_);
  }

  double worst_of(const std::vector<std::int32_t>& cells) const {
    double worst = std::numeric_limits<double>::max();
    for (const std::int32_t cell : cells) worst = std::min(worst, shape(store_.vertices(cell)));
    return worst;
  }

  bool flip(std::int32_t cell) {
    const Cell v = store_.vertices(cell);
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (remove_edge(v[i], v[j], cell)) return true;
    for (int k = 0; k < 4; ++k)
      if (remove_facet(cell, k)) return true;
    return false;
  }

  /// Replaces the cells (a, b, p[i], p[i + 1]) around an edge by pairs of cells on the triangles of the best
  /// triangulation of the ring p, if the worst of those is better.
  bool remove_edge(std::uint32_t a, std::uint32_t b, std::int32_t cell) {
    const std::vector<std::int32_t> ring = store_.around_edge(a, b, cell);
    if (ring.size() < 3 || ring.size() > most_around) return false;
    for (const std::int32_t c : ring)
      if (c < 0 || store_.material(c) != store_.material(cell)) return false;
    corners_around(ring);
    if (!is_even({a, b, around_[0], around_[1]}, store_.vertices(ring[0]))) std::swap(a, b);
    fresh_.clear();
    if (best_of_ring(a, b) < worst_of(ring) + gain) return false;
    collect(a, b, 0, int(ring.size()) - 1);
    replace(ring);
    return true;
  }

  void corners_around(const std::vector<std::int32_t>& ring) {
    around_.clear();  // of each cell the corner that the next one does not have
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Cell& next = store_.vertices(ring[(i + 1) % ring.size()]);
      for (const std::uint32_t v : store_.vertices(ring[i]))
        if (std::find(next.begin(), next.end(), v) == next.end()) around_.push_back(v);
    }
  }

  /// Shape of the worse of the two cells on triangle (i, j, k) of the ring.
  double pair_shape(std::uint32_t a, std::uint32_t b, int i, int j, int k) const {
    const std::uint32_t p = around_[i], q = around_[j], r = around_[k];
    return std::min(shape({p, q, r, b}), shape({q, p, r, a}));
  }

  /// The best that the worst triangle of a triangulation of the ring can be; choice_ holds the third corner over each
  /// side.
  double best_of_ring(std::uint32_t a, std::uint32_t b) {
    const int n = int(around_.size());
    for (int span = 1; span < n; ++span)
      for (int i = 0; i + span < n; ++i) {
        const int k = i + span;
        best_[i][k] = span == 1 ? std::numeric_limits<double>::max() : -std::numeric_limits<double>::max();
        for (int j = i + 1; j < k; ++j) {
          const double shape = std::min({best_[i][j], best_[j][k], pair_shape(a, b, i, j, k)});
          if (shape > best_[i][k]) {
            best_[i][k] = shape;
            choice_[i][k] = j;
          }
        }
      }
    return best_[0][n - 1];
  }

  void collect(std::uint32_t a, std::uint32_t b, int i, int k) {
    if (k - i < 2) return;
    const int j = choice_[i][k];
    fresh_.push_back({around_[i], around_[j], around_[k], b});
    fresh_.push_back({around_[j], around_[i], around_[k], a});
    collect(a, b, i, j);
    collect(a, b, j, k);
  }

  /// Replaces the two cells at a facet by three around the edge between their tips, if the worst of those is better.
  bool remove_facet(std::int32_t cell, int k) {
    const std::int32_t other = store_.neighbour(cell, k);
    if (other < 0 || store_.material(other) != store_.material(cell)) return false;
    const Cell& v = store_.vertices(cell);
    const Cell& w = store_.vertices(other);
    std::uint32_t tip = w[0];
    for (const std::uint32_t corner : w)
      if (std::find(v.begin(), v.end(), corner) == v.end()) tip = corner;
    const double before = std::min(shape(v), shape(w));
    fresh_.clear();
    for (int i = 0; i < 3; ++i) {
      fresh_.push_back({v[k], tip, v[facet_corners[k][i]], v[facet_corners[k][(i + 1) % 3]]});
      if (shape(fresh_.back()) < before + gain) return false;
    }
    replace(std::array{cell, other});
    return true;
  }

  void replace(std::span<const std::int32_t> old) {
    store_.replace(old, fresh_);
    for (const Cell& cell : fresh_) touch(cell);
    ++result_.flips;
  }

  void move_corners(std::int32_t cell) {
    const Cell v = store_.vertices(cell);
    for (const std::uint32_t p : v)
      if (p >= fixed_) result_.moves += move(p);
  }

  /// The cells at a point, the worst first: they decide soonest that a position is no better.
  std::vector<std::int32_t> cells_at(std::uint32_t p) {
    std::vector<std::pair<double, std::int32_t>> cells;
    for (const std::int32_t cell : store_.around_vertex(p)) cells.push_back({shape(store_.vertices(cell)), cell});
    std::sort(cells.begin(), cells.end());
    std::vector<std::int32_t> sorted;
    for (const auto& entry : cells) sorted.push_back(entry.second);
    return sorted;
  }

  /// Searches a better position of a point in ever smaller steps. The cells at it are all of one material.
  bool move(std::uint32_t p) {
    static constexpr std::array<std::array<int, 3>, 14> directions = {{{1, 0, 0},
                                                                       {-1, 0, 0},
                                                                       {0, 1, 0},
                                                                       {0, -1, 0},
                                                                       {0, 0, 1},
                                                                       {0, 0, -1},
                                                                       {1, 1, 1},
                                                                       {-1, -1, -1},
                                                                       {1, 1, -1},
                                                                       {-1, -1, 1},
                                                                       {1, -1, 1},
                                                                       {-1, 1, -1},
                                                                       {-1, 1, 1},
                                                                       {1, -1, -1}}};
    const std::vector<std::int32_t> star = cells_at(p);
    const Vec3d before = points_[p];
    const double start = shape(store_.vertices(star[0]));
    double best = start, step = 0;
    for (const std::uint32_t v : store_.vertices(star[0])) step = std::max(step, length(points_[v] - before));
    step *= 0.25;
    for (int halvings = 0; halvings < 5 && best < 2 * bad;) {
      bool found = false;
      const Vec3d from = points_[p];
      Vec3d to = from;
      for (const auto& [x, y, z] : directions) {
        points_[p] = from + step / std::sqrt(double(x * x + y * y + z * z)) * Vec3d(x, y, z);
        const double worst = worst_of_at_least(star, best + gain);
        if (worst < best + gain) continue;
        best = worst;
        to = points_[p];
        found = true;
      }
      points_[p] = to;
      if (found) continue;
      step *= 0.5;
      ++halvings;
    }
    if (best > start)
      for (const std::int32_t cell : star) touch(store_.vertices(cell));
    return best > start;
  }

  /// The worst shape, or the first that is less than `enough`.
  double worst_of_at_least(const std::vector<std::int32_t>& cells, double enough) const {
    double worst = std::numeric_limits<double>::max();
    for (const std::int32_t cell : cells) {
      worst = std::min(worst, shape(store_.vertices(cell)));
      if (worst < enough) return worst;
    }
    return worst;
  }

  std::vector<Vec3d>& points_;
  std::size_t fixed_;
  CellStore store_;
  std::vector<std::uint8_t> touched_;  // per point: the last round in which something at it changed
  int round_ = 0;
  const std::atomic<bool>* stop_;
  std::vector<std::uint32_t> around_;  // corners around the edge in question
  std::vector<Cell> fresh_;
  double best_[most_around][most_around];
  int choice_[most_around][most_around];
  CellImprovement result_;
};

}  // namespace

double cell_shape(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const std::array<Vec3d, 4> p = {a, b, c, d};
  std::array<Vec3d, 4> normal;  // outwards
  std::array<double, 4> size;
  for (int k = 0; k < 4; ++k) {
    const auto [i, j, l] = facet_corners[k];
    normal[k] = cross(p[j] - p[i], p[l] - p[i]);
    size[k] = length(normal[k]);
  }
  const double six_volumes = dot(b - a, cross(c - a, d - a));
  double worst = std::numeric_limits<double>::max();
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const int k = i > 0 ? 0 : j > 1 ? 1 : 2, l = 6 - i - j - k;  // the edge that facets i and j share
      const double below = size[i] * size[j];
      const double sine = below > 0 ? six_volumes * length(p[k] - p[l]) / below : 0;
      const bool obtuse = dot(normal[i], normal[j]) > 0;
      worst = std::min(worst, obtuse && sine > 0 ? 0.5 * sine : sine);
    }
  return worst;
}

CellImprovement improve_cells(std::vector<Vec3d>& points, std::size_t fixed, MaterialCells& cells,
                              const std::atomic<bool>* stop) {
  return Improvement(points, fixed, cells, stop).run();
}

}  // namespace nacre
