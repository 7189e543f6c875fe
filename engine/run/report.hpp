// Nacre: what every report begins with.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "compute/device/device.hpp"
#include "compute/device/stage_timers.hpp"

namespace nacre {

/// "name", "seconds", "calls" and "launches" of each stage.
nlohmann::json stages_report(const StageTimers& timers);

/// "nacre" (the version), "command", "device", "stages", "memory".
nlohmann::json report_frame(const std::string& command, const Device& device, const StageTimers& timers,
                            std::size_t arena_bytes);

}  // namespace nacre
