// Nacre: options and results of a run of `nacre mesh`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/io/mesh_input.hpp"

namespace nacre {

struct MeshOptions {
  CommonOptions common;
  InputOptions input;
  std::string preset, out, particles_out, image;
  bool per_material = false, surface_only = false, keep_on_interrupt = false, cut_away = false;
};

struct MeshResult {
  SurfaceMesh mesh;
  TopologyReport topology;
  SurfaceQuality quality;
  SurfaceDistance distance;
  std::optional<TetrahedralMesh> cells;
  CellQuality cell_quality;
  bool interrupted = false;  ///< the particles were stopped before they were done
};

/// Throws UsageError where the smallest distance of particles is above the largest.
void check_particle_sizes(const MeshParameters& mesh);

/// The report's own part: input, parameters, embedding, fields, particles, mesh, tetrahedra.
void add_mesh_report(nlohmann::json& report, const MeshInput& input, const Settings& settings, const MeshInfo& info,
                     const MeshResult& result);

/// The result in a few lines, for the terminal.
std::string mesh_summary(const MeshInput& input, const MeshInfo& info, const MeshResult& result, double seconds);

/// Throws UsageError for an unknown extension of a file, Error where it cannot be written.
void check_mesh_outputs(const MeshOptions& options);

/// Will `--out` be a file of tetrahedra?
bool wants_cells(const MeshOptions& options);

/// Writes what was asked for, in stages render and write; returns the files.
std::vector<std::string> write_mesh_outputs(const MeshOptions& options, const Session& session, const MeshInput& input,
                                            const MeshResult& result, const MeshPipeline& pipeline,
                                            StageTimers& timers);

}  // namespace nacre
