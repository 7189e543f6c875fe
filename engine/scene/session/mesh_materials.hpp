// Nacre: materials of volumes as a mesh run and its report need them, and what is wrong with a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compute/meshing/lattice.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// What a report needs to know about the volume after the volume itself has been released.
struct MeshInput {
  std::string name;
  MeshVolume::Kind kind = MeshVolume::Kind::labels;
  Int3 dims{};
  Vec3d spacing, origin;
  std::array<Vec3d, 3> axes;
  std::vector<std::int64_t> labels;                          ///< per material; [0]: the outside's
  std::vector<std::string> names;                            ///< may be empty
  std::vector<std::optional<std::array<float, 3>>> colours;  ///< per material: the file's, encoded sRGB
  std::string unit;                                          ///< of lengths, see Volume; may be empty
  std::vector<std::size_t> voxels;                           ///< per material
  std::vector<std::string> warnings;
};

/// Receives each warning as soon as it is known; may be empty.
using WarningSink = std::function<void(const std::string&)>;

/// Decides which part of the volumes is which material. `sample`: they are a phantom, which is cut at its intended
/// value unless the input options say otherwise. Fills `described`. Throws Error as `make_mesh_volume` does, and for
/// options without meaning.
MeshVolume make_materials(const std::vector<Volume>& volumes, bool sample, const MaterialSettings& settings,
                          MeshInput& described, const WarningSink& warn = {});

/// The knob `max_cell` (voxels) in the unit of fill_with_tetrahedra.
EdgeLength longest_edge(double max_cell, const Vec3d& spacing);

/// The labels of materials that no facet touches.
std::vector<std::int64_t> lost_labels(std::span<const std::int64_t> labels, const TopologyReport& topology);

/// What is wrong with a mesh: lost labels, surfaces that are not closed, topology that is not sound. One sentence each,
/// with advice.
std::vector<std::string> mesh_flaws(std::span<const std::int64_t> labels, const TopologyReport& topology);

}  // namespace nacre
