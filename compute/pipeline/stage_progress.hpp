// Nacre: how the parts of the mesh pipeline say how far they are.
#pragma once

#include <functional>
#include <string_view>

namespace nacre {

/// Stage, share of the whole command that is done (0..1), iteration and mean energy (0 where there are none).
using TellStage = std::function<void(std::string_view stage, double fraction, int iteration, double energy)>;

}  // namespace nacre
