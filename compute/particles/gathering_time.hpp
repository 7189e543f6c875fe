// Nacre: how long the red-black solver takes to gather neighbourhoods, without working on them (sec. 3.3.3).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "compute/device/device.hpp"
#include "compute/math/lanes.hpp"

namespace nacre {

/// Seconds of one turn over all bins.
struct GatheringTime {
  double binning = 0;  ///< particles sorted into bins
  double copying = 0;  ///< every bin's neighbourhood copied into contiguous memory
};

/// Particles in host memory, as ParticleSet has them: one entry of each array per particle.
struct ParticleSpans {
  std::span<const Float4> position, direction;
  std::span<const std::uint32_t> interface;
};

/// The fastest of a few turns. `device` is a CPU device. Throws Interrupted when `stop` is set.
GatheringTime time_gathering(Device& device, const ParticleSpans& particles, const std::atomic<bool>* stop);

}  // namespace nacre
