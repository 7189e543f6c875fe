// Nacre: the result of a mesh run: its measures, and the lines printed about it.
#include "engine/run/mesh_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  if (const std::int64_t thinned = info.thinned_voxels; thinned > 0)
    said.warnings.push_back(fmt::format(
        "more than 64 labels meet within a few voxels: {} voxels of the rarest there took labels beside them",
        thinned));
  // Thin structures everywhere (the cortex of a head, between skull and white matter) need small particles everywhere.
  // A user who did not expect that should know before the long part begins, and what would take a minute.
  constexpr double many = 1e6, seconds_each = 85e-6;  // on two cores: docs/performance/meshing.md
  if (const double count = info.expected_particles; parameters.particles == 0 && count >= many) {
    const double minutes = std::max(1.0, count * seconds_each / 60);
    const std::string deviation =
        parameters.max_deviation > 0
            ? fmt::format(" and --max-deviation {:.2g} times as large (now {:.2g})", minutes, parameters.max_deviation)
            : "";
    said.remarks.push_back(fmt::format(
        "about {:.1f} million particles are needed, {:.2g} to {:.2g} voxels apart: some {:.0f} minutes on two "
        "processor "
        "cores, and about one with --min-size, --max-size and --epsilon {:.2g} times as large (now {:.2g}, {:.2g}, "
        "{:.2g}){}, or with --quality draft for a first look",
        count / 1e6, info.smallest_size, info.largest_size, minutes, std::sqrt(minutes), parameters.min_size,
        parameters.max_size, parameters.epsilon, deviation));
  }
  return said;
}

void measure_triangles(MeshResult& result, int materials, StageTimers& timers) {
  StageTimers::Scope scope(timers, "quality");
  result.topology = check_topology(result.mesh, materials);
  result.quality = surface_quality(result.mesh);
}

void compare_with_voxels(MeshResult& result, const MeshVolume& volume, StageTimers& timers,
                         const std::atomic<bool>* stop) {
  StageTimers::Scope scope(timers, "fidelity");
  result.voxels = voxel_distances(result.mesh, volume, stop);
}

void fill_result(MeshResult& result, double max_cell, const MeshInput& input, StageTimers& timers,
                 const std::atomic<bool>* stop) {
  StageTimers::Scope scope(timers, "tetrahedra");
  result.cells = fill_with_tetrahedra(result.mesh, longest_edge(max_cell, input.spacing), stop);
  result.cell_quality = cell_quality(*result.cells, int(input.labels.size()));
}

namespace {

OntoJunctions onto_junctions_of(MeshPipeline& pipeline, bool within) {
  return [&pipeline, within](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    return pipeline.onto_junctions(points, junctions, within);
  };
}

}  // namespace

SecondOrder mesh_nodes(const SurfaceMesh& mesh, const TetrahedralMesh* filled, MeshPipeline& pipeline,
                       const std::atomic<bool>* stop) {
  StageTimers::Scope scope(pipeline.timers(), "nodes");
  return second_order(mesh, filled, onto_junctions_of(pipeline, true), stop);
}

void add_second_order(MeshResult& result, MeshPipeline& pipeline, const MeshInput& input,
                      const std::atomic<bool>* stop) {
  result.second = mesh_nodes(result.mesh, result.cells ? &*result.cells : nullptr, pipeline, stop);
  StageTimers::Scope scope(pipeline.timers(), "nodes");
  const OntoJunctions nearest = onto_junctions_of(pipeline, false);
  const double voxel = std::min({input.spacing.x, input.spacing.y, input.spacing.z});
  result.flat = sampled_deviation(result.mesh, nullptr, nearest, voxel);
  check_stop(stop);
  result.curved = sampled_deviation(result.mesh, &*result.second, nearest, voxel);
  check_stop(stop);
}

}  // namespace nacre
