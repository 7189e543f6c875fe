// Nacre: which particles of a junction curve follow each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/field/interface.hpp"
#include "compute/math/lanes.hpp"

namespace nacre {

/// Particles as the stars need them; all spans have an entry for each.
struct StarParticles {
  std::span<const Float4> position;   ///< x, y, z; h
  std::span<const Float4> direction;  ///< unit normal of a surface, towards its lower material
  std::span<const Junction> junction;
  std::span<const JunctionGradients> gradient;  ///< at those on curves and points; the others' are not read

  std::size_t count() const { return position.size(); }
  Vec3d point(std::size_t i) const { return {position[i].x, position[i].y, position[i].z}; }
  /// Gradient of the function of material i of the junction less that of its material j.
  Vec3d difference(std::size_t particle, int i, int j) const {
    const auto from_first = [&](int k) { return k == 0 ? Vec3d() : Vec3d(gradient[particle].from_first[k - 1]); };
    return from_first(j) - from_first(i);
  }
};

/// A particle on a curve, or a point where one begins or ends, with the particles beside it. A curve runs so that its
/// materials, ascending, come around it counter-clockwise, seen against its direction.
struct CurveNode {
  std::uint64_t curve;  ///< Junction::packed of its three materials
  std::uint32_t particle;
  bool has_next, has_previous;                 ///< by the fields
  std::uint32_t next = none, previous = none;  ///< nodes, `none` where none was found

  bool is_broken() const { return (has_next && next == none) || (has_previous && previous == none); }
  /// Part of a ring of one or two, which bounds nothing.
  bool is_idle() const { return next != none && next == previous; }
};

/// The nodes of all curves, ascending by curve and particle, linked to their neighbours where both of two agree, the
/// nearest first.
std::vector<CurveNode> link_curves(const StarParticles& particles);

}  // namespace nacre
