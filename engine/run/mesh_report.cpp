// Nacre: the report of `nacre mesh`.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/run/mesh_result.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

using nlohmann::json;

json vector_json(const Vec3d& v) { return {v.x, v.y, v.z}; }
json vector_json(const Int3& v) { return {v.x, v.y, v.z}; }

const char* kind_name(MeshVolume::Kind kind) {
  switch (kind) {
    case MeshVolume::Kind::labels: return "labels";
    case MeshVolume::Kind::indicators: return "indicators";
    case MeshVolume::Kind::scalar: return "scalar";
  }
  return "";
}

std::string name_of(const MeshInput& input, std::size_t material) {
  return material < input.names.size() ? input.names[material] : "";
}

json input_json(const MeshInput& input) {
  json materials = json::array();
  for (std::size_t m = 1; m < input.labels.size(); ++m)
    materials.push_back({{"label", input.labels[m]}, {"name", name_of(input, m)}, {"voxels", input.voxels[m]}});
  json axes = json::array();
  for (const Vec3d& axis : input.axes) axes.push_back(vector_json(axis));
  return {{"name", input.name},
          {"kind", kind_name(input.kind)},
          {"dimensions", vector_json(input.dims)},
          {"spacing", vector_json(input.spacing)},
          {"origin", vector_json(input.origin)},
          {"axes", axes},
          {"outside", input.labels.empty() ? 0 : input.labels[0]},
          {"materials", materials},
          {"warnings", input.warnings}};
}

/// The labels that meet on each surface and curve, and at each kind of junction point.
json junctions_json(const MeshInput& input, const MeshInfo& info) {
  json junctions = json::array();
  for (const auto& materials : info.junctions) {
    json labels = json::array();
    for (const std::uint16_t m : materials)
      if (m < input.labels.size()) labels.push_back(input.labels[m]);
    junctions.push_back(labels);
  }
  return junctions;
}

json fields_json(const MeshInput& input, const MeshInfo& info) {
  return {{"blocks", vector_json(info.blocks)},
          {"bytes", info.field_bytes},
          {"surfaces", info.surfaces},
          {"curves", info.curves},
          {"points", info.points},
          {"junctions", junctions_json(input, info)},
          {"crowded_points", info.crowded_points},
          {"crowded_cells", info.crowded_cells},
          {"thinned_voxels", info.thinned_voxels},
          {"constrained_voxels", info.constrained_voxels},
          {"creased_voxels", info.ridge_voxels},
          {"smallest_size_voxels", info.smallest_size},
          {"largest_size_voxels", info.largest_size},
          {"expected_particles", info.expected_particles}};
}

json particles_json(const MeshInfo& info, bool interrupted) {
  return {{"seeded", info.seeded},
          {"seeded_on_surfaces", info.seeded_on_surfaces},
          {"final", info.final},
          {"on_points", info.points_final},
          {"on_curves", info.curves_final},
          {"on_surfaces", info.surfaces_final},
          {"iterations", info.iterations},
          {"coarse_iterations", info.coarse_iterations},
          {"interrupted", interrupted},
          {"energy", info.energy},
          {"final_energy", info.final_energy},
          {"count", info.count},
          {"seconds", info.seconds}};
}

json stars_json(const StarUse& use) {
  return {{"meshes", use.meshes},
          {"fallbacks", use.fallbacks},
          {"attempts", use.attempts},
          {"specks", use.specks},
          {"edge_flips", use.flips},
          {"edge_contractions", use.contractions},
          {"edge_splits", use.splits},
          {"stars", use.last.stars},
          {"unsettled", use.last.unsettled},
          {"holes", use.last.holes},
          {"filled_triangles", use.last.filled},
          {"left_out", use.last.left_out},
          {"in_patches", use.last.in_patches}};
}

json angles_json(const TriangleQuality& q) {
  return {{"min", q.angle_min}, {"mean_min", q.angle_mean_min}, {"max", q.angle_max}};
}

json ratio_json(const TriangleQuality& q) {
  return {{"mean", q.radius_ratio_mean}, {"min", q.radius_ratio_min}, {"histogram", q.radius_ratio_histogram}};
}

/// The mesh of a material against its voxels; lengths and volumes in the units of the data.
json against_voxels_json(double volume, const VoxelDistance& v) {
  json compared = {{"voxel_volume", v.voxel_volume}, {"difference", volume - v.voxel_volume}};
  compared["relative_difference"] = v.voxel_volume > 0 ? json(volume / v.voxel_volume - 1) : json();
  if (!v.measured) return compared;
  compared["mean_distance"] = v.mean();
  compared["hausdorff_distance"] = v.hausdorff();
  compared["from_mesh"] = {{"mean", v.mesh_mean}, {"max", v.mesh_max}};
  compared["from_voxels"] = {{"mean", v.faces_mean}, {"max", v.faces_max}};
  return compared;
}

json materials_json(const MeshInput& input, const MeshResult& result) {
  const TopologyReport& topology = result.topology;
  json materials = json::array();
  for (std::size_t m = 1; m < std::min(input.labels.size(), topology.materials.size()); ++m) {
    const MaterialTopology& t = topology.materials[m];
    materials.push_back({{"label", input.labels[m]},
                         {"name", name_of(input, m)},
                         {"euler", t.euler},
                         {"closed", t.closed},
                         {"volume", t.volume},
                         {"components", t.components},
                         {"vertices", t.vertices},
                         {"triangles", t.facets}});
    if (m < result.voxels.size()) materials.back()["against_voxels"] = against_voxels_json(t.volume, result.voxels[m]);
  }
  return materials;
}

json distance_json(const MeshResult& r) {
  const SurfaceDistance& d = r.distance;
  const double vertices = double(r.mesh.points.size()), facets = double(r.mesh.triangles.size());
  return {{"mean", (d.vertex_mean * vertices + d.facet_mean * facets) / std::max(1.0, vertices + facets)},
          {"max", std::max(d.vertex_max, d.facet_max)},
          {"vertex_mean", d.vertex_mean},
          {"vertex_max", d.vertex_max},
          {"facet_mean", d.facet_mean},
          {"facet_max", d.facet_max}};
}

/// Where the best quality was not reached: an angle under 30 degrees or a ratio under 0.5 away from junctions.
json short_of_best_json(const SurfaceMesh& mesh) {
  constexpr std::size_t most_named = 100;
  const std::vector<std::uint32_t> found = triangles_short_of(mesh, 30, 0.5);
  json places = json::array();
  for (std::size_t i = 0; i < std::min(found.size(), most_named); ++i) {
    const Triangle& t = mesh.triangles[found[i]];
    const Vec3d &a = mesh.points[t.a], &b = mesh.points[t.b], &c = mesh.points[t.c], middle = (a + b + c) / 3;
    const auto angles = triangle_angles(a, b, c);
    places.push_back({{"at", {middle.x, middle.y, middle.z}},
                      {"radius_ratio", radius_ratio(a, b, c)},
                      {"angle_degrees", *std::min_element(angles.begin(), angles.end())}});
  }
  return {{"triangles", found.size()}, {"places", places}};
}

json mesh_json(const MeshInput& input, const MeshResult& r) {
  const TriangleQuality &all = r.quality.all, &away = r.quality.away_from_junctions;
  return {{"vertices", r.topology.vertices},
          {"triangles", r.topology.triangles},
          {"components", r.topology.components},
          {"boundary_edges", r.topology.boundary_edges},
          {"nonmanifold_edges", r.topology.nonmanifold_edges},
          {"junction_edges", r.topology.junction_edges},
          {"pinched_edges", r.topology.pinched_edges},
          {"nonmanifold_vertices", r.topology.nonmanifold_vertices},
          {"pinched_vertices", r.topology.pinched_vertices},
          {"inconsistent_edges", r.topology.inconsistent_edges},
          {"duplicate_triangles", r.topology.duplicate_triangles},
          {"degenerate_triangles", r.topology.degenerate_triangles},
          {"sound", r.topology.sound()},
          {"lost_labels", lost_labels(input.labels, r.topology)},
          {"radius_ratio", ratio_json(all)},
          {"angle_degrees", angles_json(all)},
          {"share_under_25_degrees", all.share_under_25},
          {"away_from_junctions",
           {{"triangles", away.triangles},
            {"radius_ratio", ratio_json(away)},
            {"angle_degrees", angles_json(away)},
            {"share_under_25_degrees", away.share_under_25}}},
          {"surface_distance_voxels", distance_json(r)},
          {"materials", materials_json(input, r)}};
}

json cells_json(const MeshInput& input, const MeshResult& r) {
  const CellQuality& q = r.cell_quality;
  json materials = json::array();
  for (std::size_t m = 1; m < std::min(input.labels.size(), q.volume.size()); ++m)
    materials.push_back({{"label", input.labels[m]}, {"volume", q.volume[m]}});
  return {{"vertices", r.cells->points.size()},
          {"cells", q.cells},
          {"inverted", q.inverted},
          {"dihedral_degrees", {{"min", q.dihedral_min}, {"max", q.dihedral_max}, {"histogram", q.dihedral_histogram}}},
          {"share_within_10_160_degrees", q.share_within_10_160},
          {"materials", materials}};
}

json range_json(const DeviationRange& range) { return {{"mean", range.mean}, {"max", range.max}}; }

json second_order_json(const MeshInput& input, const MeshResult& r) {
  const SecondOrder& s = *r.second;
  const std::vector<double> volume = enclosed_volumes(r.mesh, s, int(input.labels.size()));
  json materials = json::array();
  for (std::size_t m = 1; m < volume.size(); ++m)
    materials.push_back({{"label", input.labels[m]}, {"volume", volume[m]}});
  return {{"elements", r.cells ? "tetrahedra" : "triangles"},
          {"nodes", s.nodes.size()},
          {"on_surfaces", s.on_surfaces},
          {"on_curves", s.on_curves},
          {"left_straight", s.left_straight},
          {"pulled_back", s.pulled_back},
          {"straightened", s.straightened},
          {"curved_elements", s.curved_elements},
          {"least_scaled_jacobian", s.least_jacobian},
          {"deviation_voxels", {{"order_1", range_json(r.flat)}, {"order_2", range_json(r.curved)}}},
          {"materials", materials}};
}

json deviation_json(const DeviationInfo& d, double bound) {
  json places = json::array();
  for (const Vec3d& p : d.places) places.push_back(vector_json(p));
  return {{"bound_voxels", bound},
          {"max_voxels", d.max},
          {"mean_voxels", d.mean},
          {"met", d.above() == 0},
          {"triangles_above",
           {{"too_small_to_divide", d.above_detail}, {"at_junctions", d.above_junctions}, {"others", d.above_others}}},
          {"places", places},
          {"before_refining", {{"max_voxels", d.first_max}, {"triangles_above", d.first_above}}},
          {"rounds", d.rounds},
          {"inserted_particles", d.inserted}};
}

}  // namespace

void add_mesh_report(json& report, const MeshInput& input, const Settings& settings, const MeshInfo& info,
                     const MeshResult& result) {
  report["input"] = input_json(input);
  report["parameters"] = knob_values(settings);
  report["embedding"] = {{"kind", "interfaces"}, {"cells", info.embedding_cells}, {"bytes", info.embedding_bytes}};
  report["memory"]["estimated_peak_bytes"] = std::int64_t(info.estimated_peak_bytes);
  report["fields"] = fields_json(input, info);
  report["particles"] = particles_json(info, result.interrupted);
  report["mesh"] = mesh_json(input, result);
  if (settings.mesh.quality == "best") report["mesh"]["short_of_best"] = short_of_best_json(result.mesh);
  if (info.stars.meshes + info.stars.fallbacks > 0) report["mesh"]["stars"] = stars_json(info.stars);
  if (settings.mesh.max_deviation > 0)
    report["mesh"]["deviation"] = deviation_json(info.deviation, settings.mesh.max_deviation);
  if (result.cells) report["tetrahedra"] = cells_json(input, result);
  if (result.second) report["second_order"] = second_order_json(input, result);
}

std::string mesh_summary(const MeshInput& input, const MeshInfo& info, const MeshResult& result, double seconds) {
  const TopologyReport& t = result.topology;
  const std::size_t lost = lost_labels(input.labels, t).size();
  std::size_t open = 0;
  for (std::size_t m = 1; m < t.materials.size(); ++m) open += t.materials[m].facets > 0 && !t.materials[m].closed;
  const std::size_t materials = input.labels.size() - 1;
  const std::string state = open > 0    ? fmt::format("{} not closed", open)
                            : lost > 0  ? fmt::format("{} lost", lost)
                            : t.sound() ? "all closed"
                                        : "all closed, not sound";
  std::string text = fmt::format("{} particles, {} triangles around {} material{}, {}\n", info.final, t.triangles,
                                 materials, materials == 1 ? "" : "s", state);
  text += fmt::format("radius ratio {:.3f} mean, {:.3f} min; triangles {:.3f} voxels from the interface on average",
                      result.quality.all.radius_ratio_mean, result.quality.all.radius_ratio_min,
                      result.distance.facet_mean);
  if (const DeviationInfo& d = info.deviation; d.max > 0)
    text += fmt::format("\ntriangles at most {:.3g} voxels from the interface{}", d.max,
                        d.above() > 0 ? fmt::format(", {} above the bound", d.above()) : "");
  if (result.cells)
    text += fmt::format("\n{} tetrahedra, dihedral angles {:.1f} to {:.1f} degrees, {:.2f}% within 10 to 160",
                        result.cell_quality.cells, result.cell_quality.dihedral_min, result.cell_quality.dihedral_max,
                        100 * result.cell_quality.share_within_10_160);
  if (result.second)
    text += fmt::format("\nnodes on {} edges; triangles {:.2g} voxels from the interface at most, flat ones {:.2g}",
                        result.second->nodes.size(), result.curved.max, result.flat.max);
  return text + fmt::format("\n{:.1f} s{}", seconds,
                            result.interrupted ? ", interrupted: the particles were not finished" : "");
}

}  // namespace nacre
