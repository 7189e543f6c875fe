// Nacre: what `nacre flow` finds out beside the texture, and writes into files of its own.
#include "app/flow_results.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "app/common.hpp"
#include "app/ranks.hpp"
#include "compute/device/stage_timers.hpp"
#include "engine/io/vtk_inline.hpp"
#include "engine/io/vtp_writer.hpp"
#include "engine/run/flow_maps.hpp"
#include "engine/run/flow_skeleton.hpp"
#include "engine/run/flow_tracks.hpp"
#include "engine/scene/surface/haemodynamics.hpp"
#include "engine/system/extension.hpp"

namespace nacre {

using nlohmann::json;

void write_haemodynamics(const std::string& file, VectorsInTime& input, const Origin& origin) {
  input.enter(input.start());
  input.rebase(input.start());
  const Haemodynamics all = haemodynamics(input);
  std::vector<PointArray> arrays;
  for (const std::string& name : haemodynamic_names()) arrays.push_back({name, 1, haemodynamic_array(all, name)});
  const PreparedSurface& surface = input.surface();
  write_vtp(file, std::span<const Vec3d>(surface.points), surface.triangles, arrays, std::nullopt, {},
            xml_origin(origin_of_output(origin, "haemodynamics")));
}

json make_flow_map(const FlowOptions& options, StageTimers& timers, VectorsInTime& input, const FlowSpan& span,
                   const Settings& settings, const Origin& origin, std::vector<std::string>& outputs) {
  const bool colours = is_ftle(settings.color) && !input.colored();
  const bool writes = !options.ftle_out.empty() && is_first_process();
  if (!colours && !writes) return json::object();
  StageTimers::Scope scope(timers, "flow_map");
  SurfaceFlowMap map = surface_flow_map(input, span, settings.ftle_time, &interrupt_flag());
  if (writes) {
    write_flow_map(options.ftle_out, map, origin_of_output(origin, "ftle-out"));
    outputs.push_back(options.ftle_out);
  }
  const json report = flow_map_report(map);
  if (colours) input.show_scalar(settings.color, std::move(map.ftle));
  return {{"flow_map", report}};
}

json write_lines(const FlowOptions& options, FlowPipeline& pipeline, VectorsInTime& input, const FlowSpan& span,
                 const Settings& settings, const Origin& origin, std::vector<std::string>& outputs) {
  json report = json::object();
  const bool points = settings.topology || !options.topology_out.empty();
  const bool lines = settings.streamlines || !options.streamlines_out.empty();
  const bool tracks = !options.tracks_out.empty();
  if (!points && !lines && !tracks) return report;
  const double t = pipeline.flow().time();
  StageTimers::Scope scope(pipeline.timers(), "topology");
  if (points) {
    const FlowSkeleton skeleton = flow_skeleton(input, t, settings.persistence);
    report["topology"] = skeleton_report(skeleton);
    if (!options.topology_out.empty()) {
      write_skeleton(options.topology_out, skeleton, origin_of_output(origin, "topology-out"));
      outputs.push_back(options.topology_out);
    }
  }
  if (lines) {
    const FlowStreamlines streamlines = flow_streamlines(input, t, settings.line_spacing, &interrupt_flag());
    report["streamlines"] = {{"time", t}, {"count", streamlines.lines.size()}};
    if (!options.streamlines_out.empty()) {
      write_streamlines(options.streamlines_out, streamlines, origin_of_output(origin, "streamlines-out"));
      outputs.push_back(options.streamlines_out);
    }
  }
  if (tracks) {
    const FlowTracks followed = flow_tracks(input, {span.first, span.end}, settings.persistence, &interrupt_flag());
    report["tracks"] = tracks_report(followed);
    write_tracks(options.tracks_out, followed, origin_of_output(origin, "tracks-out"));
    outputs.push_back(options.tracks_out);
  }
  return report;
}

}  // namespace nacre
