// Nacre: options of a run of `nacre mesh`.
#pragma once

#include <string>
#include <vector>

#include "app/run.hpp"
#include "engine/io/mesh_input.hpp"
#include "engine/run/mesh_result.hpp"

namespace nacre {

struct MeshOptions {
  CommonOptions common;
  InputOptions input;
  std::string preset, out, particles_out, image;
  bool per_material = false, surface_only = false, keep_on_interrupt = false, cut_away = false;
};

/// Throws UsageError for an unknown extension of a file, Error where it cannot be written.
void check_mesh_outputs(const MeshOptions& options);

/// Will `--out` be a file of tetrahedra?
bool wants_cells(const MeshOptions& options);

/// Writes what was asked for, in stages render and write; returns the files.
std::vector<std::string> write_mesh_outputs(const MeshOptions& options, const Session& session, const MeshInput& input,
                                            const MeshResult& result, const MeshPipeline& pipeline, StageTimers& timers,
                                            const Origin& origin);

}  // namespace nacre
