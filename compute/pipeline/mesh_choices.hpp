// Nacre: enums for the choices that MeshParameters holds as strings.
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

/// How the tree solver's particles get back onto their interface after a step.
enum class Projection {
  fields,     ///< by Newton's method on the materials' functions
  embedding,  ///< by the closest points of a grid's cells (sec. 4.2.1)
};

/// How much work a mesh is worth.
enum class QualityLevel {
  draft,     ///< for looking, and for turning knobs
  standard,  ///< the parameters as they are
  best,      ///< more rounds of everything
};

/// What triangles are made of.
enum class TriangleSource {
  automatic,  ///< stars; delaunay where tetrahedra are asked for with the surface
  delaunay,   ///< facets between Delaunay cells of different materials, and nothing else
  stars,      ///< each particle's neighbours on its surfaces, where these settle; polished
};

std::string to_string(Solver solver);
std::string to_string(TriangleSource source);
std::string to_string(CubicKernel kernel);

/// Each throws Error, listing the valid values, for any other value.
Solver solver_from_string(std::string_view text);
CubicKernel kernel_from_string(std::string_view text);
TriangleSource triangles_from_string(std::string_view text);
QualityLevel quality_from_string(std::string_view text);
Projection projection_from_string(std::string_view text);
/// "auto" is the embedding for the tree solver and marching cubes for the others, as in ch. 4 and ch. 3.
SeedOrigin seeds_from_string(std::string_view text, Solver solver);

/// The parameters that a run with these works with. A draft has one closest-point cell per voxel and axis, projects by
/// the fields, has 16 iterations of a quarter of the particles, 8 of all, one round of smoothing and twelve of
/// remeshing, or fewer where `parameters` say so, and does not measure the energy at the end; the best has at least two
/// closest-point cells per voxel and axis, 120 iterations, a stagnation of 0.0000125, four rounds of smoothing and 40
/// of remeshing. `auto` triangles are what they stand for.
MeshParameters at_quality(const MeshParameters& parameters);

/// All choices of a set of parameters.
struct MeshChoices {
  Solver solver;
  CubicKernel kernel;
  SeedOrigin seeds;
  TriangleSource triangles;
  QualityLevel quality;

  /// Throws Error where one of the values is unknown.
  explicit MeshChoices(const MeshParameters& parameters);
};

}  // namespace nacre
