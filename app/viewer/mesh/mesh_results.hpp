// Nacre: what is known of a mesh so far: for its panel and for what is probed. No OpenGL here.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/viewer/mesh/mesh_measures.hpp"
#include "app/viewer/mesh/viewed_volume.hpp"

namespace nacre {

inline constexpr float ghost_opacity = 0.25f;

struct MeshResults {
  std::shared_ptr<const ViewedVolume> volume;
  std::shared_ptr<const SurfaceMesh> mesh;
  std::shared_ptr<const MeshMeasures> measures;  ///< of `mesh`
  MeshInfo info;
  std::vector<float> energy, particles;  ///< per iteration of the present order of junctions
  ShownCounts counts;
};

/// Labels in a list "L[,L...]"; what is no number is skipped.
std::vector<std::int64_t> labels_of(const std::string& list);

/// Material `number` by label and name, for people.
std::string material_name(const MeshInput& input, std::size_t number);

}  // namespace nacre
