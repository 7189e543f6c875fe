// Nacre: writes the values of a flow that one process has, or several.
#pragma once

#include <filesystem>
#include <string>

#include "compute/device/ranks.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/io/flow_values.hpp"

namespace nacre {

/// Writes the values as .vtp, by the first process, or as .pvtp: a piece of each process that has cells, and a list of
/// them. `ranks`: null: this process is alone. `origin`: how they came about (engine/run/origin.hpp). Collective.
/// Throws Error where a file cannot be written; then none appears.
void write_values(const std::filesystem::path& file, const FlowMethod& flow, Ranks* ranks, const std::string& origin,
                  const MoreArrays& more = {});

}  // namespace nacre
