// Nacre: the volumes of a session as the mesh pipeline takes them; `nacre mesh` and the viewer read them alike.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compute/meshing/lattice.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/session/session.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// What a report says about the volume once the volume itself is gone.
struct MeshInput {
  std::string name;
  MeshVolume::Kind kind = MeshVolume::Kind::labels;
  Int3 dims{};
  Vec3d spacing, origin;
  std::array<Vec3d, 3> axes;
  std::vector<std::int64_t> labels;  ///< per material; [0]: the outside's
  std::vector<std::string> names;    ///< may be empty
  std::vector<std::size_t> voxels;   ///< per material
  std::vector<std::string> warnings;
};

/// Is told each warning as soon as it is known; may be empty.
using WarningSink = std::function<void(const std::string&)>;

/// The files or the phantom of `input`. Throws Error as `read_volume` and `make_phantom` do, Interrupted soon after
/// `*stop` (may be null) is set.
std::vector<Volume> read_mesh_volumes(const SessionInput& input, const std::atomic<bool>* stop,
                                      const WarningSink& warn = {});

/// What of the volumes is which material. `sample`: they are a phantom, which is cut where it is meant to be unless the
/// options say otherwise. Fills `described`. Throws Error as `make_mesh_volume` does, and for values that cannot be parsed.
MeshVolume make_materials(const std::vector<Volume>& volumes, bool sample, const MaterialWords& words,
                          MeshInput& described, const WarningSink& warn = {});

/// The knob `max_cell` (voxels) as fill_with_tetrahedra takes it.
EdgeLength longest_edge(double max_cell, const Vec3d& spacing);

/// The labels of materials that no facet touches.
std::vector<std::int64_t> lost_labels(std::span<const std::int64_t> labels, const TopologyReport& topology);

/// What is wrong with a mesh: labels that are lost, surfaces that are not closed, topology that is not sound. A sentence
/// each, with what may help.
std::vector<std::string> mesh_flaws(std::span<const std::int64_t> labels, const TopologyReport& topology);

}  // namespace nacre
