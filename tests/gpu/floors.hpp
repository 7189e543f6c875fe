// Nacre: how long the tree solver's parts take on many particles; what check.sh holds against the floors.
#pragma once

#include <cstdint>

#include "compute/device/backend.hpp"
#include "compute/device/device.hpp"

namespace nacre::gpu_tests {

/// Medians of wall time in seconds, from an idle device to an idle device.
struct ParticleTimes {
  double tree_build = 0;   ///< keys, sort, order, nodes and their sums
  double energy_pass = 0;  ///< energies and forces of all, and the mean energy on the host
  std::int64_t nodes = 0;
  double mean_energy = 0;  ///< of particles one h apart: about that of a hexagonal lattice
};

/// Of `particles` spread evenly on a sphere, h apart, in random order.
ParticleTimes time_particles(Cpu, Device& device, std::int64_t particles, int runs);
ParticleTimes time_particles(Cuda, Device& device, std::int64_t particles, int runs);

}  // namespace nacre::gpu_tests
