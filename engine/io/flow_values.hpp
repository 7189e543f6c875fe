// Nacre: the values of a flow as a file.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Writes `flow.values()` as .vtp: one point per surface cell, at its centre, with the arrays `value` (0..1),
/// `velocity`, `normal` and `closest_point`, and those that `dye` gives for points of the surface.
/// `time` becomes TimeValue. `origin` says how they came about
/// (engine/run/origin.hpp). Throws Error where the file cannot be written.
void write_flow_values(const FlowMethod& flow, const std::filesystem::path& file, double time,
                       const std::string& origin = "",
                       const std::function<std::vector<PointArray>(std::span<const Vec3d>)>& dye = {});

}  // namespace nacre
