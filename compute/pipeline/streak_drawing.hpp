// Nacre: streaks of a frame, in steps between which several processes tell each other what they have.
#pragma once

#include "compute/device/arena.hpp"
#include "compute/device/executor.hpp"
#include "compute/flow/streaks.hpp"

namespace nacre {

/// What a method of flow stores to draw streaks. All steps run on the surface cells of a Surface, of the grid or of
/// the octree; the first two on all that are known, the others on those whose streaks are wanted.
template <class Backend>
class StreakDrawing {
 public:
  explicit StreakDrawing(Executor<Backend>& exec) : exec_(exec) {}

  /// Room for the streaks of all `n` surface cells, permanent, and what cells know of the surface. `cell`: edge of a
  /// texture cell in units of the points of the mesh.
  template <class Surface>
  void make(const Surface& surface, std::size_t n, const MeshView& mesh, double cell) {
    n_ = std::int64_t(n);
    triangles_ = mesh.triangles;
    cells_ = exec_.arena().template permanent<StreakCell>(n + 1);  // the last one is read as four words
    segments_ = exec_.arena().template permanent<StreakSegment>(n + 1);
    weights_ = exec_.arena().template permanent<PackedWeights>(n);
    const DescribeStreakCells<Surface> describe{surface, mesh, cell, cells_.data(), weights_.data()};
    for_each_surface_cell_of(exec_, surface, n_, describe);
  }

  /// First what cells know of the flow. `vectors`: of the points of the mesh, at the time of the frame; `least`: speed
  /// below which nothing flows.
  template <class Surface>
  void mark(const Surface& surface, const Vec3f* vectors, float least) {
    auto stage = exec_.stage("streaks");
    const MarkStreakCells<Surface> mark{surface, triangles_, vectors, least, weights_.data(), cells_.data()};
    for_each_surface_cell_of(exec_, surface, n_, mark);
  }

  /// Then their segments of streamlines, with the values of the moving texture, 0..1.
  template <class Surface>
  void follow(const Surface& surface, const float* value) {
    auto stage = exec_.stage("streaks");
    exec_.for_each(n_, GiveStreakValues{value, cells_.data()});
    store_on_surface(exec_, surface, n_, FollowSegments<Surface>{surface, cells_.data()}, ToArray{segments_.data()});
  }

  /// The means along streamlines of `cells` cells each way, stretched.
  template <class Surface>
  void convolve(const Surface& surface, int cells, float* means) {
    auto stage = exec_.stage("streaks");
    const ConvolveAlongFlow<Surface> convolve{surface, segments_.data(), streak_segments(cells)};
    store_on_surface(exec_, surface, n_, convolve, ToArray{means});
  }

  /// Last, what is shown, 0..1.
  template <class Surface>
  void smooth(const Surface& surface, const float* means, float* streaks) {
    auto stage = exec_.stage("streaks");
    const SmoothAlongAndSharpenAcross<Surface> smooth{surface, means, cells_.data()};
    store_on_surface(exec_, surface, n_, smooth, ToArray{streaks});
  }

 private:
  Executor<Backend>& exec_;
  std::int64_t n_ = 0;
  Array<StreakCell> cells_;
  Array<StreakSegment> segments_;
  Array<PackedWeights> weights_;
  const Triangle* triangles_ = nullptr;
};

}  // namespace nacre
