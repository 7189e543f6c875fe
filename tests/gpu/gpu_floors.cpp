// Nacre: how long a tree and the energies of many particles take, as one JSON object.
// Usage: gpu_floors [cpu|cuda] [PARTICLES] [RUNS]. Status: 0 done, 1 failed or the energies are wrong, 77 no CUDA
// device.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "compute/device/error.hpp"
#include "compute/particles/energy.hpp"
#include "tests/gpu/floors.hpp"

namespace {

void print_times(const std::string& backend, long particles, int runs) {
  using namespace nacre;
  const auto device = backend == "cuda" ? make_cuda_device() : make_cpu_device();
  const gpu_tests::ParticleTimes times = backend == "cuda" ? gpu_tests::time_particles(Cuda{}, *device, particles, runs)
                                                           : gpu_tests::time_particles(Cpu{}, *device, particles, runs);
  std::printf("{\n  \"device\": \"%s\",\n  \"particles\": %ld,\n  \"runs\": %d,\n  \"nodes\": %lld,\n", backend.c_str(),
              particles, runs, static_cast<long long>(times.nodes));
  std::printf("  \"mean_energy\": %.6f,\n  \"tree_build_seconds\": %.9g,\n  \"energy_pass_seconds\": %.9g\n}\n",
              times.mean_energy, times.tree_build, times.energy_pass);
  if (!(std::fabs(times.mean_energy / hexagonal_energy - 1) < 0.1))
    throw Error("the energies are wrong", "their mean is " + std::to_string(times.mean_energy));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string backend = argc > 1 ? argv[1] : "cuda";
  if (backend == "cuda" && nacre::cuda_device_count() == 0) {
    std::puts("no CUDA device: nothing was timed");
    return 77;
  }
  try {
    print_times(backend, argc > 2 ? std::max(1l, std::atol(argv[2])) : 2000000l,
                argc > 3 ? std::max(1, std::atoi(argv[3])) : 15);
    return 0;
  } catch (const nacre::Error& error) {
    std::fprintf(stderr, "gpu_floors: %s\n", error.what());
    return 1;
  }
}
