// Nacre: who finds stars, and what is read off from them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/star.hpp"
#include "compute/meshing/star_items.hpp"
#include "compute/meshing/star_particles.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// A triangle that has two corners or more on rims.
struct RimTriangle {
  std::uint32_t number;  ///< in a list of triangles
  Triangle items;        ///< its corners
};

/// The triangles that the stars of all their corners have.
struct AgreedTriangles {
  std::vector<Triangle> triangles;  ///< corners are particles; the first is the smallest. Ascend by surface, then by it
  std::vector<MaterialPair> materials;    ///< per triangle
  std::vector<RimTriangle> between_rims;  ///< ascending
};

/// The stars of all items, settled, with what is agreed marked, and what is read off from them.
struct FoundStars {
  StarItems items;
  std::span<Star> stars;
  AgreedTriangles agreed;
  std::vector<std::uint32_t> incomplete;  ///< items of which is_incomplete is true; ascending
  std::int64_t unsettled = 0;             ///< stars of which is_unsettled is true
  std::int64_t cut = 0;                   ///< stars that were cut anew
};

class StarDevice {
 public:
  virtual ~StarDevice() = default;

  /// The stars of these particles, until the next call. Those of the call before that have the same items within reach
  /// are not cut again; what comes out depends on the particles alone. The caller may change what it gets, but is to
  /// put stars back (StarOpenings).
  virtual FoundStars& find(const StarParticles& particles) = 0;
};

}  // namespace nacre
