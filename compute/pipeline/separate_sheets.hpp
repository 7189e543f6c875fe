// Nacre: two sheets in one place are embedded apart, so that either has cells, values and vectors of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// A surface as it is embedded. The triangles of second sheets have points of their own, which are moved aside; those
/// of all others are where they were. Numbers of triangles and of the mesh's points stay the same.
struct SeparatedSheets {
  std::vector<Vec3d> points;          ///< the mesh's, then those that are moved
  std::vector<Triangle> triangles;    ///< empty: there is no second sheet, and nothing is moved
  std::vector<std::uint32_t> source;  ///< of each moved point: the mesh's point that it was
  Vec3d shift{};                      ///< from where it was to where it is

  explicit operator bool() const { return !triangles.empty(); }
};

/// Moves the second sheets of `mesh` along the shortest axis of its box, to `gap` beyond its border.
SeparatedSheets separate_sheets(const FlowMesh& mesh, double gap);

}  // namespace nacre
