// Nacre: the report of a flow run.
#include "engine/run/flow_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/scene/settings/knobs.hpp"
#include "engine/scene/surface/surface_share.hpp"

namespace nacre {
namespace {

nlohmann::json median_min_max(std::vector<double> seconds) {
  if (seconds.empty()) return {{"median", 0}, {"min", 0}, {"max", 0}};
  std::sort(seconds.begin(), seconds.end());
  return {{"median", seconds[seconds.size() / 2]}, {"min", seconds.front()}, {"max", seconds.back()}};
}

nlohmann::json embedding_report(const EmbeddingInfo& e) {
  return {{"kind", e.kind},
          {"dimensions", {e.dimensions.x, e.dimensions.y, e.dimensions.z}},
          {"cells", e.cells},
          {"surface_cells", e.surface_cells},
          {"bytes", e.bytes},
          {"dense_bytes", e.dense_bytes},
          {"sparseness_percent", 100.0 * (1 - double(e.bytes) / std::max<double>(1, double(e.dense_bytes)))},
          {"closest_point_dimensions",
           {e.closest_point_dimensions.x, e.closest_point_dimensions.y, e.closest_point_dimensions.z}},
          {"closest_point_cells", e.closest_point_cells},
          {"cell_size", e.cell_size}};
}

}  // namespace

void add_flow_report(nlohmann::json& report, const VectorsInTime& input, const FlowVectors& vectors,
                     const Settings& settings, const EmbeddingInfo& embedding, const std::vector<double>& seconds,
                     const Focus* focus, int first_step) {
  const Share* share = input.share();
  report["input"] = {{"name", input.series().name},
                     {"vectors", input.array()},
                     {"points", share ? share->all_points : input.surface().points.size()},
                     {"triangles", share ? share->all_triangles : input.surface().triangles.size()},
                     {"time", {vectors.start, vectors.end}},
                     {"reference_speed", vectors.reference_speed},
                     {"normal_share", input.statistics().normal_share},
                     {"zero_share", input.statistics().zero_share}};
  report["parameters"] = knob_values(settings);
  report["embedding"] = embedding_report(embedding);
  report["flow"] = {{"steps", seconds.size()}, {"seconds_per_step", median_min_max(seconds)}};
  if (first_step > 0) report["flow"]["first_step"] = first_step;
  if (embedding.flow_bytes) report["flow"]["bytes"] = embedding.flow_bytes;
  if (focus)
    report["focus"] = {{"triangles", focus->part.surface.triangles.size()},
                       {"resolution", focus->resolution},
                       {"cell_size", focus->cell_size},
                       {"cells_per_pixel", focus->pixel / focus->cell_size}};
}

}  // namespace nacre
