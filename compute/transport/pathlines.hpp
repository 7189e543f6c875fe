// Nacre: particles that are carried along a surface by vectors that change in time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/topology/surface_walk.hpp"
#include "compute/topology/tangent_field.hpp"

namespace nacre {

/// A particle on a surface.
struct SurfaceParticle {
  SurfacePosition at;
  bool left = false;  ///< over a rim
};

/// Carries particles over one interval of time, in which vectors are linear. The surface must outlive it.
class Pathlines {
 public:
  explicit Pathlines(const TangentField& surface) : surface_(surface), walk_(surface) {}

  const SurfaceWalk& walk() const { return walk_; }

  /// The interval: signed, and vectors of the points at both of its ends, as many as the vertices' points.
  void enter(double duration, std::span<const Vec3f> first, std::span<const Vec3f> last);
  /// From the beginning of the interval to its end.
  void carry(SurfaceParticle& particle) const;
  /// A particle at a vertex, in the triangle of its fan into which the flow goes. `fan`: its corners.
  SurfaceParticle at_vertex(std::span<const std::uint32_t> fan) const;

 private:
  using Corners = std::array<Vec2d, 3>;
  std::vector<Corners> in_frames(std::span<const Vec3f> vectors) const;
  Vec2d vector_at(std::uint32_t corner, double share) const;
  Vec2d velocity(const SurfacePosition& at, double share) const;
  bool goes_out(std::uint32_t rim, double share) const;
  bool move(SurfaceParticle& particle, double distance, double share) const;

  const TangentField& surface_;
  SurfaceWalk walk_;
  double duration_ = 0;
  std::vector<Corners> first_, last_;  ///< displacements in the whole interval, in the triangles' frames
};

}  // namespace nacre
