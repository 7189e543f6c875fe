// Nacre: how long the tree solver's parts take, on CUDA.
#include "compute/device/executor_cuda.cuh"
#include "tests/gpu/floors_impl.hpp"

nacre::gpu_tests::ParticleTimes nacre::gpu_tests::time_particles(Cuda, Device& device, std::int64_t particles,
                                                                 int runs) {
  return time_particles_on<Cuda>(device, particles, runs);
}
