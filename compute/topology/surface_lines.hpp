// Nacre: lines along a tangential vector field on triangles; the separatrices of its saddles.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/topology/critical_points.hpp"
#include "compute/topology/surface_walk.hpp"

namespace nacre {

/// Why a line ends.
enum class LineEnd {
  critical_point,
  rim,
  stopped,  ///< by who asked for it
  still,    ///< the field is zero
  circling  ///< round and round, or longer than `longest`
};

struct SurfaceLine : SurfacePath {
  LineEnd end = LineEnd::still;
  std::uint32_t from = none, to = none;  ///< critical points that it joins
  bool forward = true;                   ///< drawn with the flow
};

/// Follows one field. The step is the midpoint rule, 0.4 edges long, straight over the triangles (SurfaceWalk). The
/// field and the points must outlive it.
class LineTracer {
 public:
  /// Lines end at `points`; `longest`, world units: what is longer circles.
  LineTracer(const TangentField& field, std::span<const CriticalPoint> points, double longest);

  /// Whether a line may go on to its last point; it is cut off before that.
  using MayGoOn = std::function<bool(const SurfaceLine& line, double length)>;

  /// From a point in a triangle, forward or backward in time.
  SurfaceLine trace(std::uint32_t triangle, const Vec3d& weights, bool forward, const MayGoOn& may = {}) const;
  /// A point beside `from` in `triangle`, straight across the flow there: to the left, to the right if `distance` is
  /// below 0; none beyond a rim, or where the field is zero. Its triangle and the weights there.
  struct Beside {
    std::uint32_t triangle = none;
    Vec3d weights, position;
  };
  Beside beside(std::uint32_t triangle, const Vec3d& from, double distance) const;
  /// Linear between the corners.
  double speed(std::uint32_t triangle, const Vec3d& at) const;
  /// From a saddle along its axis (unit, in the surface).
  SurfaceLine leave(std::uint32_t saddle, const Vec3d& axis, bool forward) const;

 private:
  Vec2d direction(const SurfacePosition& at, bool forward) const;
  void follow(SurfacePosition at, bool forward, SurfaceLine& line, const MayGoOn& may) const;

  const TangentField& field_;
  SurfaceWalk walk_;
  std::span<const CriticalPoint> points_;
  double longest_;
  std::vector<std::uint32_t> near_;  ///< of each triangle: the critical point in it or beside it
};

/// Four lines for each saddle: with the flow along its unstable axis, against it along its stable axis.
std::vector<SurfaceLine> separatrices(const TangentField& field, std::span<const CriticalPoint> points);

}  // namespace nacre
