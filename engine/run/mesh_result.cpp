// Nacre: what a mesh run gives, measured and in words.
#include "engine/run/mesh_result.hpp"

#include <fmt/format.h>

#include "compute/device/error.hpp"
#include "compute/meshing/tetrahedra.hpp"

namespace nacre {

void check_particle_sizes(const MeshParameters& mesh) {
  if (mesh.min_size > mesh.max_size)
    throw Error(fmt::format("--min-size {:g} is larger than --max-size {:g}", mesh.min_size, mesh.max_size));
}

FieldRemarks remarks_on_fields(const MeshInfo& info, const MeshParameters& parameters) {
  FieldRemarks said;
  if (const int crowded = info.crowded_cells; crowded > 0)
    said.warnings.push_back(
        fmt::format("in {} cells of the embedding more than 8 materials or 64 junctions meet: "
                    "some junctions are left out; choose fewer materials with --merge or --materials",
                    crowded));
  // Thin structures everywhere (the cortex of a head, between skull and white matter) need small particles everywhere.
  // A user who did not expect that should know before the long part begins.
  constexpr double many = 3e6;
  if (parameters.particles == 0 && info.expected_particles >= many)
    said.remarks.push_back(fmt::format(
        "about {:.1f} million particles are needed, {:.2g} to {:.2g} voxels apart, since materials are thin; their "
        "number falls with the square of --min-size (now {:.2g})",
        info.expected_particles / 1e6, info.smallest_size, info.largest_size, parameters.min_size));
  return said;
}

void measure_triangles(MeshResult& result, int materials, StageTimers& timers) {
  StageTimers::Scope scope(timers, "quality");
  result.topology = check_topology(result.mesh, materials);
  result.quality = surface_quality(result.mesh);
}

void fill_result(MeshResult& result, double max_cell, const MeshInput& input, StageTimers& timers,
                 const std::atomic<bool>* stop) {
  StageTimers::Scope scope(timers, "tetrahedra");
  result.cells = fill_with_tetrahedra(result.mesh, longest_edge(max_cell, input.spacing), stop);
  result.cell_quality = cell_quality(*result.cells, int(input.labels.size()));
}

}  // namespace nacre
