// Nacre: what became of the stars that triangles were read off from.
#pragma once

#include <cstdint>

namespace nacre {

/// Of one mesh.
struct StarCounts {
  std::int64_t stars = 0;       ///< a particle has one on each of its surfaces
  std::int64_t cut = 0;         ///< of these, found anew: others were known from the mesh before
  std::int64_t unsettled = 0;   ///< of all, with a triangle that another corner does not have, after all rounds
  std::int64_t holes = 0;       ///< between agreed triangles, filled one by one
  std::int64_t filled = 0;      ///< triangles in them
  std::int64_t left_out = 0;    ///< particles that no triangle has
  std::int64_t in_patches = 0;  ///< particles whose triangles are facets of Delaunay cells of what is around them
};

/// Of all meshes that an improvement made.
struct StarUse {
  std::int64_t meshes = 0;                               ///< from stars
  std::int64_t fallbacks = 0;                            ///< by the Delaunay triangulation of all particles
  std::int64_t attempts = 0;                             ///< rounds of them, in pieces of the last mesh
  std::int64_t specks = 0;                               ///< bodies of at most 20 facets that are gone
  std::int64_t flips = 0, contractions = 0, splits = 0;  ///< of edges of the whole mesh, before the attempts
  StarCounts last;                                       ///< of the last mesh that was tried
};

}  // namespace nacre
