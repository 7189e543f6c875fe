// Nacre: how long the tree solver's parts take, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/gpu/floors_impl.hpp"

nacre::gpu_tests::ParticleTimes nacre::gpu_tests::time_particles(Cpu, Device& device, std::int64_t particles,
                                                                 int runs) {
  return time_particles_on<Cpu>(device, particles, runs);
}
