// Nacre: meshes that were made with other knobs, for undo. No OpenGL here.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "app/viewer/mesh/mesh_measures.hpp"
#include "app/viewer/mesh/viewed_volume.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// A mesh, what it is like, and what it was made of.
struct KeptMesh {
  Settings settings;
  std::shared_ptr<const ViewedVolume> volume;
  std::vector<Vec3d> corners;  ///< as VolumeRead has them
  VoxelFrame frame;
  std::shared_ptr<const SurfaceMesh> mesh;
  std::shared_ptr<const MeshMeasures> measures;
  MeshInfo info;

  std::size_t bytes() const {
    return mesh->points.size() * (sizeof(Vec3d) + sizeof(float)) +
           mesh->triangles.size() * (sizeof(Triangle) + 2 * sizeof(std::uint16_t)) +
           volume->material.size() * sizeof(std::uint16_t);
  }
};

/// The newest that memory allows.
class KeptMeshes {
 public:
  explicit KeptMeshes(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  void keep(KeptMesh mesh) {
    bytes_ += mesh.bytes();
    kept_.push_back(std::make_shared<const KeptMesh>(std::move(mesh)));
    while (bytes_ > most_bytes_ && !kept_.empty()) {
      bytes_ -= kept_.front()->bytes();
      kept_.pop_front();
    }
  }

  /// The newest for whose settings `fits` says so; null: there is none.
  template <class Fits>
  std::shared_ptr<const KeptMesh> find(const Fits& fits) const {
    for (auto kept = kept_.rbegin(); kept != kept_.rend(); ++kept)
      if (fits((*kept)->settings)) return *kept;
    return {};
  }

 private:
  std::size_t most_bytes_, bytes_ = 0;
  std::deque<std::shared_ptr<const KeptMesh>> kept_;
};

}  // namespace nacre
