// Nacre: the values of a flow as a file.
#pragma once

#include <filesystem>

#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// Writes `pipeline.values()` as .vtp: one point per surface cell, at its centre, with the arrays `value` (0..1), `velocity`,
/// `normal` and `closest_point`; `time` becomes TimeValue. Throws Error where the file cannot be written.
void write_flow_values(const FlowPipeline& pipeline, const std::filesystem::path& file, double time);

}  // namespace nacre
