// Nacre: the three embeddings of flow by one name, for tests that run on each.
#pragma once

#include <stdexcept>
#include <string_view>

#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre::test {

/// `name`: grid, brick (the octree of bricks) or thesis (the octree whose leaves are cells).
inline void choose_embedding(FlowParameters& parameters, std::string_view name) {
  if (name != "grid" && name != "brick" && name != "thesis") throw std::invalid_argument("no such embedding");
  parameters.method = name == "grid" ? EmbeddingKind::grid : EmbeddingKind::octree;
  parameters.octree = name == "thesis" ? OctreeKind::thesis : OctreeKind::brick;
}

}  // namespace nacre::test
