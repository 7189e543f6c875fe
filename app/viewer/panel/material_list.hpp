// Nacre: the list of a mesh's materials: what they are called, how large they are, which of them are seen.
#pragma once

#include <string>
#include <vector>

#include "app/viewer/mesh/mesh_results.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// Of long lists a part is seen, and there is a field to find materials in; buttons for all are for those that it
/// finds.
class MaterialList {
 public:
  /// With Dear ImGui. Changes which are hidden and which are ghosts.
  void draw(const MeshResults& results, ViewSettings& view);

 private:
  std::vector<std::size_t> found(const MeshInput& input) const;

  std::string wanted_;  ///< part of a name
};

}  // namespace nacre
