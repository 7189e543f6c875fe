// Nacre: the choices among MeshParameters, which are words there, as enums.
#pragma once

#include <string>
#include <string_view>

#include "compute/field/cubic.hpp"

namespace nacre {

struct MeshParameters;

/// How particles move.
enum class Solver {
  tree,      ///< all at once (ch. 4)
  redblack,  ///< bins three apart at once (sec. 3.2)
  serial,    ///< one after the other (sec. 3.1)
};

/// Where the particles of surfaces begin; those of curves always begin in the embedding.
enum class SeedOrigin { embedding, marching_cubes };

/// What triangles are made of.
enum class TriangleSource {
  delaunay,  ///< facets between Delaunay cells of different materials
  stars,     ///< each particle's neighbours on its surfaces
};

std::string to_string(Solver solver);
std::string to_string(CubicKernel kernel);

/// Each throws Error, with the words that there are, for any other word.
Solver solver_from_string(std::string_view word);
CubicKernel kernel_from_string(std::string_view word);
TriangleSource triangles_from_string(std::string_view word);
/// "auto" is the embedding for the tree solver and marching cubes for the others, as in ch. 4 and ch. 3.
SeedOrigin seeds_from_string(std::string_view word, Solver solver);

/// All choices of a set of parameters.
struct MeshChoices {
  Solver solver;
  CubicKernel kernel;
  SeedOrigin seeds;
  TriangleSource triangles;

  /// Throws Error where one of the words is unknown.
  explicit MeshChoices(const MeshParameters& parameters);
};

}  // namespace nacre
