// Nacre: the tab "result" of a mesh: figures, history, materials, worst triangles.
#pragma once

#include <memory>
#include <vector>

#include "app/viewer/mesh_measures.hpp"
#include "app/viewer/viewed_volume.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// What is known so far.
struct MeshResults {
  std::shared_ptr<const ViewedVolume> volume;
  std::shared_ptr<const SurfaceMesh> mesh;
  std::shared_ptr<const MeshMeasures> measures;  ///< of `mesh`
  MeshInfo info;
  std::vector<float> energy, particles;  ///< per iteration of the present order of junctions
  ShownCounts counts;
};

/// Labels in a list of words "L[,L...]"; what is no number is skipped.
std::vector<std::int64_t> labels_of(const std::string& words);

class MaterialList;

/// Draws it with Dear ImGui. Buttons change the session: hidden, ghosts, camera.
void draw_mesh_results(const MeshResults& results, MaterialList& materials, Session& session);

}  // namespace nacre
