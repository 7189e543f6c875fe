// Nacre: the Delaunay triangulation of the particles.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// The finite cells, in an order that depends on the points alone (not on threads): ascending by their sorted vertices.
struct DelaunayCells {
  /// Indices of points; ascending but for the last two, which are swapped where that makes the volume positive.
  std::vector<std::array<std::uint32_t, 4>> vertices;
  std::vector<std::array<std::int32_t, 4>>
      neighbours;                    ///< per cell: the one opposite of vertex k; -1 outside of the hull
  std::vector<Vec3d> circumcentres;  ///< finite; see circumcentre_reach for cells next to flat
};

/// A Delaunay triangulation that follows its points: where few have gone, come or moved since the last call, only their
/// neighbourhoods are made again. What it gives depends on the points alone.
class Delaunay {
 public:
  /// On `threads` threads (0: all of the arena that it is called in; 1 under the thread sanitizer).
  explicit Delaunay(int threads = 0);
  ~Delaunay();
  Delaunay(const Delaunay&) = delete;
  Delaunay& operator=(const Delaunay&) = delete;

  /// The cells of `points`; of those that coincide the first is used. Points of the last call are known again by their
  /// positions. Throws Error where there are fewer than four points, all lie in
  /// one plane or one is not finite, and Interrupted soon after `*stop` is set.
  DelaunayCells cells(std::span<const Vec3d> points, const std::atomic<bool>* stop = nullptr);

 private:
  struct Held;
  int threads_;
  std::unique_ptr<Held> held_;
};

/// The cells of points that are triangulated once.
inline DelaunayCells delaunay(std::span<const Vec3d> points, int threads = 0, const std::atomic<bool>* stop = nullptr) {
  return Delaunay(threads).cells(points, stop);
}

}  // namespace nacre
