// Nacre: the exact closest points of eight cells: bounds in single precision, what they leave in double precision.
//
// Eight cells (an octet) are searched at once, since they are near to the same triangles: on a CPU each distance below
// is one SIMD register of eight. The search goes through three sieves, each cheaper than the next. (1) Clusters of
// neighbouring triangles are left out by their bounding balls and slabs. (2) The triangles of those that remain are
// measured in single precision. (3) Where rounding leaves a triangle a chance, its closest points are computed in
// double precision. On a mesh with one triangle to three cells an octet sifts 28 clusters, measures 22 to 29 triangles,
// and 3.4 of them in double precision (docs/performance/flow.md).
//
// What that is worth, whole stages, medians of three in turn on a busy machine: embedding the train at 1024 went from
// 1.61 s, one cell at a time, to 0.39 s (docs/performance/bounds.md).
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/embedding/band.hpp"
#include "compute/embedding/closest_of_eight.hpp"
#include "compute/embedding/clusters.hpp"
#include "compute/embedding/triangle_frame.hpp"
#include "compute/math/bits.hpp"
#include "compute/math/eight.hpp"

namespace nacre::detail {

struct FrameTriangle {
  const Corners* corners;
  TriangleFrame* frame;
  NACRE_HD void operator()(std::int64_t i) const { frame[i] = triangle_frame(corners[i]); }
};

/// Clusters of triangles with what their distances are computed from.
struct ClusterView {
  const std::uint32_t* order;
  const std::uint32_t* start;
  const ClusterBound* bound;
  const Corners* corners;      // in `order`
  const TriangleFrame* frame;  // in `order`
  float rounding;              // how far a point of the domain may be off in single precision

  /// Prefetches a triangle that will be measured soon: the search waited for memory, since an octet takes
  /// triangles from many clusters.
  NACRE_HD_INLINE void fetch([[maybe_unused]] std::uint32_t j) const {
#if !defined(__CUDACC__)
    __builtin_prefetch(frame + j);
    __builtin_prefetch(corners + j);
#endif
  }

  /// How far the roots of squared distances may be off.
  struct Slack {
    float lower;  // no point of a cluster is nearer than this much less
    float upper;  // some point is no farther than this much more
  };

  // Cells. A smaller triangle is taken for its ball: its exact distance would leave out too few to pay for itself.
  // (With the lists without branches below: train at 512 from 334-408 to 286-357 ns a cell, one thread.)
  static constexpr float fine = 1;
  static constexpr float most = 2.74f;  // cells: no cluster of several is larger (centroids in one cell, a cell around)

  /// Squares of the distances between cluster `c` and the corners of the cube around `centre` with half edge `half`.
  NACRE_HD_INLINE Slack distances(std::uint32_t c, const Vec3d& centre, float half, Eight& squared) const {
    const ClusterBound& b = bound[c];
    if (b.radius > fine && start[c + 1] - start[c] == 1) {
      const float error = frame[start[c]].distances(centre, half, squared);
      return {error, error};
    }
    squared = nacre::squared(displacements_to_corners(Vec3f(centre) - b.centre, half));
    return {b.radius + rounding + 1e-3f, rounding + 1e-3f};
  }
};

constexpr float cell_diagonal = 0.8660256f;  ///< half of it: a triangle that touches a cell is that near to its centre

/// The eight cells of an octet (2^3 cells) and their closest points so far.
class OctetSearch {
 public:
  static constexpr unsigned all_touched = 0xff;

  /// `near`: the surface is no farther from the octet's centre; `touched`: cells of which that need not be found out.
  NACRE_HD OctetSearch(const ClusterView& clusters, const Vec3d& centre, float near, float radius, unsigned touched = 0)
      : clusters_(clusters),
        centre_(centre),
        at_(centre),
        radius_(radius),
        slack_(clusters.rounding + 1e-4f + 1e-6f * radius),
        touched_(touched) {
    const float bound = near + (cell_diagonal + 1e-4f);
    nearest_ = eight(bound * bound);
    for (int k = 0; k < 8; ++k) best_[k] = 1e300, winner_[k] = none, x_[k] = y_[k] = z_[k] = 0;
  }

  /// Looks at the clusters at(0) .. at(count - 1). Their centres lie on the surface: no cell is farther from it than
  /// from them. A large triangle was measured when the octet's list was made and is not sifted again.
  ///
  /// The clusters that remain are first written to a list, each over the one before where that was left out: so nothing
  /// branches on the outcome of the sieve. Where triangles are about as large as cells it goes either way, and a
  /// processor that had to guess was wrong two or three times for each candidate (see `fine` for what that cost).
  template <class At>
  NACRE_HD void search(std::uint64_t count, const At& at) {
    Eight bound = eight(1e30f);
    for (std::uint64_t k = 0; k < count; ++k)
      bound = min(bound, squared(displacements_to_corners(at_ - clusters_.bound[at(k)].centre, 0.5f)));
    bound = sqrt(bound) + slack_;
    nearest_ = min(nearest_, bound * bound);
    find_reach();
    std::uint32_t left[room];
    for (std::uint64_t k = 0; k < count;) {
      int n = 0;
      for (; k < count && n < room; ++k) {
        const std::uint32_t c = at(k);
        const ClusterBound& b = clusters_.bound[c];
        left[n] = c;
        n += int(b.radius > ClusterView::most) | int(in_reach(b));  // `|`: both are computed, none is branched on
      }
      take(left, n);
    }
    settle();
  }

  /// A bit for each cell within `radius`, and for each that a triangle touches.
  NACRE_HD unsigned in_band(double radius) const {
    unsigned bits = 0;
    for (int k = 0; k < 8; ++k) bits |= unsigned(best_[k] <= radius * radius) << k;
    return bits;
  }
  NACRE_HD unsigned touched() const { return touched_; }

  /// The closest point of a cell minus its centre, and its distance; the triangle that it lies on.
  NACRE_HD Float4 offset(int k) const { return {float(x_[k]), float(y_[k]), float(z_[k]), float(std::sqrt(best_[k]))}; }
  NACRE_HD std::uint32_t triangle(int k) const { return std::uint32_t(winner_[k]); }

  /// Writes the closest points of the cells in `bits` to to(0) .. to(7).
  template <class To>
  NACRE_HD void pack(unsigned bits, float quantum, const To& to) const {
    std::int32_t x[8], y[8], z[8];
    for (int k = 0; k < 8; ++k) x[k] = CellPoint::rounded(x_[k], quantum);
    for (int k = 0; k < 8; ++k) y[k] = CellPoint::rounded(y_[k], quantum);
    for (int k = 0; k < 8; ++k) z[k] = CellPoint::rounded(z_[k], quantum);
    for (; bits; bits &= bits - 1) {
      const int k = lowest_bit(bits);
      to(k) = CellPoint::pack(x[k], y[k], z[k], std::uint32_t(winner_[k]));
    }
  }

 private:
  static constexpr int room = 32;

  /// Collects the triangles of `n` clusters, and measures them when the list is full.
  NACRE_HD void take(const std::uint32_t* cluster, int n) {
    for (int i = 0; i < n; ++i) {
      const std::uint32_t last = clusters_.start[cluster[i] + 1];
      for (std::uint32_t j = clusters_.start[cluster[i]]; j < last; ++j) {
        clusters_.fetch(j);
        triangle_[pending_] = j;
        if (++pending_ == room) settle();
      }
    }
  }

  NACRE_HD Vec3d cell(int k) const {
    return centre_ + Vec3d(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
  }

  /// Whether a cluster comes near enough to a cell.
  NACRE_HD_INLINE bool in_reach(const ClusterBound& b) const {
    const EightDisplacements w = displacements_to_corners(at_ - b.centre, 0.5f);
    const Eight zero = eight(0), along = dot(w, b.normal);
    const Eight above = max(max(along, zero - along) - b.thickness, zero);
    const Eight across = max(squared(w) - along * along, zero);
    const Eight beside = max(sqrt(across) - b.radius, zero), limit = reach_ + slack_;
    return at_most(above * above + beside * beside, limit * limit) != 0;
  }

  /// How far from each cell a triangle may be to be of interest. One that touches a cell is, unless the closest point
  /// is known to lie inside of the cell.
  NACRE_HD_INLINE void find_reach() {
    const Eight reach = min(sqrt(nearest_), eight(radius_)) + (error_ + 1e-6f);
    reach_ = where_positive(reach - 0.5f, max(reach, eight(cell_diagonal + error_ + 1e-6f)), reach);
  }

  /// Looks at the pending triangles, in double precision where single precision leaves them a chance.
  NACRE_HD void settle() {
    for (int i = 0; i < pending_; ++i) {
      const float error = clusters_.frame[triangle_[i]].distances(centre_, 0.5f, squared_[i]);
      nearest_ = min(nearest_, squared_[i]);
      error_ = error > error_ ? error : error_;
    }
    find_reach();
    const float error = 2 * error_ + 1e-6f;
    const Eight limit = min(sqrt(nearest_), eight(radius_)) + error;
    const Eight limit2 = limit * limit;
    for (int i = 0; i < pending_; ++i)
      if (const unsigned bits = at_most(squared_[i], limit2)) offer(bits, triangle_[i]);
    const Eight touching = eight((cell_diagonal + error) * (cell_diagonal + error));
    if (const unsigned near = at_most(nearest_, touching) & ~touched_) touch(near, touching);
    pending_ = 0;
  }

  /// Finds out which cells of `near` a pending triangle touches; mostly it is the one that holds the closest point.
  NACRE_HD_INLINE void touch(unsigned near, const Eight& touching) {
    constexpr double half = 0.5 + 1e-7;
    for (unsigned bits = near; bits; bits &= bits - 1) {
      const int k = lowest_bit(bits);
      if (best_[k] < 1 && std::fabs(x_[k]) <= half && std::fabs(y_[k]) <= half && std::fabs(z_[k]) <= half)
        touched_ |= 1u << k;
    }
    if (!(near & ~touched_)) return;
    for (int i = 0; i < pending_; ++i)
      for (unsigned bits = at_most(squared_[i], touching) & ~touched_; bits; bits &= bits - 1) {
        const int k = lowest_bit(bits);
        if (touches_cube(clusters_.corners[triangle_[i]], cell(k), half)) touched_ |= 1u << k;
      }
  }

  /// Takes a triangle for those of the cells in `bits` that it is the nearest to so far.
  NACRE_HD_INLINE void offer(unsigned bits, std::uint32_t j) {
    const Corners corners = clusters_.corners[j];
    const std::uint32_t t = clusters_.order[j];
#if !defined(__CUDACC__)
    ClosestOfEight found;
    if (closest_of_eight(corners, centre_, 0.5, found)) {
      const auto wins = (found.squared < best_) | ((found.squared == best_) & (std::int64_t(t) < winner_));
      x_ = wins ? found.x : x_, y_ = wins ? found.y : y_, z_ = wins ? found.z : z_;
      best_ = wins ? found.squared : best_;
      winner_ = wins ? Numbers{} + std::int64_t(t) : winner_;
      return;
    }
#endif
    for (; bits; bits &= bits - 1) offer_one(lowest_bit(bits), t, corners);
  }

  NACRE_HD void offer_one(int k, std::uint32_t t, const Corners& corners) {
    const Vec3d x = cell(k), d = closest_point(corners, x) - x;
    const double square = dot(d, d);
    if (square > best_[k] || (square == best_[k] && t > winner_[k])) return;
    best_[k] = square;
    x_[k] = d.x, y_[k] = d.y, z_[k] = d.z;
    winner_[k] = t;
  }

#if defined(__CUDACC__)
  typedef double Doubles[8];
  typedef std::int64_t Numbers[8];
#else
  typedef EightDoubles Doubles;
  typedef std::int64_t Numbers __attribute__((vector_size(64)));
#endif

  const ClusterView& clusters_;
  Vec3d centre_;
  Vec3f at_;
  float radius_;
  float slack_;      // of distances from clusters
  float error_ = 0;  // of those from triangles
  int pending_ = 0;
  unsigned touched_;
  Eight nearest_;  // squared: the surface is no farther
  Eight reach_;
  Doubles best_;  // squared
  Doubles x_, y_, z_;
  Numbers winner_;
  std::uint32_t triangle_[room];
  Eight squared_[room];
};

}  // namespace nacre::detail
