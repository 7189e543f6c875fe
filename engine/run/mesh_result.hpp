// Nacre: the result of a mesh run: its measures, and the lines printed about it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compute/meshing/quality.hpp"
#include "compute/meshing/second_order.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_deviation.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "compute/pipeline/voxel_distance.hpp"
#include "engine/scene/session/mesh_materials.hpp"

namespace nacre {

struct MeshResult {
  SurfaceMesh mesh;
  TopologyReport topology;
  SurfaceQuality quality;
  SurfaceDistance distance;
  std::vector<VoxelDistance> voxels;  ///< per material, how the mesh compares with the voxels
  std::optional<TetrahedralMesh> cells;
  CellQuality cell_quality;
  std::optional<SecondOrder> second;  ///< the nodes on the edges of `cells` or, without these, of `mesh`
  DeviationRange flat, curved;        ///< of the triangles without and with their nodes, voxels
  bool interrupted = false;           ///< the particles were stopped before they were done
};

/// Throws Error where the smallest distance of particles is above the largest.
void check_particle_sizes(const MeshParameters& mesh);

/// What a user should know of the fields before the long part begins: junctions that are left out, a very large number
/// of particles. Full sentences.
struct FieldRemarks {
  std::vector<std::string> warnings, remarks;
};
FieldRemarks remarks_on_fields(const MeshInfo& info, const MeshParameters& parameters);

/// Topology and shape of `result.mesh` (stage quality).
void measure_triangles(MeshResult& result, int materials, StageTimers& timers);

/// `result.mesh` against the voxels that it was made of (stage fidelity). Of `volume` everything but `values` is read.
void compare_with_voxels(MeshResult& result, const MeshVolume& volume, StageTimers& timers,
                         const std::atomic<bool>* stop);

/// Fills `result.mesh` with tetrahedra (stage tetrahedra), whose longest edge is the knob `max_cell`, and measures
/// them. `input` is the volume that the mesh was made of. Throws as fill_with_tetrahedra does.
void fill_result(MeshResult& result, double max_cell, const MeshInput& input, StageTimers& timers,
                 const std::atomic<bool>* stop);

/// The nodes of second order of what `pipeline` has made, and of the tetrahedra within (may be null); stage nodes.
SecondOrder mesh_nodes(const SurfaceMesh& mesh, const TetrahedralMesh* filled, MeshPipeline& pipeline,
                       const std::atomic<bool>* stop);

/// The nodes of second order of `result.cells` or, where there are none, of `result.mesh`, and what they bring (stage
/// nodes). `input` is the volume that the mesh was made of by `pipeline`.
void add_second_order(MeshResult& result, MeshPipeline& pipeline, const MeshInput& input,
                      const std::atomic<bool>* stop);

/// The report's own part: input, parameters, embedding, fields, particles, mesh, tetrahedra.
void add_mesh_report(nlohmann::json& report, const MeshInput& input, const Settings& settings, const MeshInfo& info,
                     const MeshResult& result);

/// The result in a few lines, for the terminal.
std::string mesh_summary(const MeshInput& input, const MeshInfo& info, const MeshResult& result, double seconds);

}  // namespace nacre
