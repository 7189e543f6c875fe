// Nacre: dye that is carried along a surface, in mass.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Finite volumes on the dual cells of the points: from the middles of edges to the centroids of triangles. What leaves
/// a cell enters its neighbour, so mass changes only by `release` and over rims, up to rounding.
///
/// The flux between two cells is that of the linear vectors through the two pieces of their border. The concentration
/// on it is that of the cell upstream, continued half-way to the other by the gradient of its triangles, and limited:
/// superbee (P. L. Roe, Some contributions to the modelling of discontinuous flows, 1985), with the point upstream
/// within the range of its neighbours. Diffusion has the cotangent weights (G. Dziuk, Finite elements for the Beltrami
/// operator on arbitrary surfaces, 1988). In time Heun's method of C.-W. Shu and S. Osher (1988), in as many sub-steps
/// as keep every concentration from going below 0 by advection: within one, no cell gives away more than half of what
/// it has. The same to the byte for any number of threads.
class Dye {
 public:
  /// Points at one position have one index. `diffusion`: area per unit of time.
  Dye(std::size_t points, std::span<const Triangle> triangles, double diffusion);

  void set_diffusion(double diffusion) { diffusion_ = diffusion; }  ///< area per unit of time

  /// Fills the cells of these points up to the concentration 1. The shape as it is then.
  void release(std::span<const Vec3d> shape, std::span<const std::uint32_t> points);

  /// Goes on by `duration`, on one shape, with vectors that are linear in time between two. Returns the number of
  /// sub-steps. Throws Error where these would be more than `most_sub_steps`; Interrupted where `stop` is set.
  int step(std::span<const Vec3d> shape, double duration, std::span<const Vec3f> first, std::span<const Vec3f> last,
           const std::atomic<bool>* stop = nullptr);

  /// Mass divided by area, per point; 0 where no triangle is.
  std::vector<float> concentration(std::span<const Vec3d> shape) const;
  std::span<const double> masses() const { return mass_; }  ///< of the cell of each point
  double mass() const;                                      ///< on the surface: concentration x area
  double released() const { return released_; }             ///< so far
  double left() const { return left_; }                     ///< over rims, so far

  static constexpr int most_sub_steps = 100000;

 private:
  struct Lists {
    std::vector<std::uint32_t> start, item;
    std::span<const std::uint32_t> of(std::size_t i) const {
      return {item.data() + start[i], item.data() + start[i + 1]};
    }
  };
  struct Edge {
    std::uint32_t a, b;
  };
  struct RimSide {
    std::uint32_t corner;  ///< its first
    double first[2], last[2];
  };

  void measure(std::span<const Vec3d> shape);
  void find_fluxes(std::span<const Vec3d> shape, std::span<const Vec3f> vectors, bool last);
  int sub_steps(double duration) const;
  double euler(std::span<const Vec3d> shape, std::vector<double>& mass, double share, double duration);
  double face_value(std::span<const Vec3d> shape, std::uint32_t from, std::uint32_t to) const;
  std::uint32_t corner_point(std::size_t corner) const { return triangles_[corner / 3][int(corner % 3)]; }

  std::vector<Triangle> triangles_;
  double diffusion_ = 0, released_ = 0, left_ = 0;
  std::vector<double> mass_;
  std::vector<Edge> edges_;
  std::vector<RimSide> rims_;
  Lists corners_of_, edges_of_;  ///< of each point; edges: 2 e, or 2 e + 1 where the point is their second

  // Of the present shape and vectors.
  std::vector<Vec3d> normal_;                   ///< of triangles, as long as twice their area
  std::vector<double> area_, weight_;           ///< of cells; cotangent weights of edges
  std::vector<double> first_flux_, last_flux_;  ///< of edges, from a to b
  std::vector<std::uint32_t> edge_of_;  ///< of each side of a triangle: 2 e, or 2 e + 1 where it goes from b to a

  // Of the present concentrations.
  std::vector<double> c_, low_, high_;
  std::vector<Vec3d> slope_, gradient_;  ///< of triangles; of points
  std::vector<double> flux_;
};

}  // namespace nacre
