// Nacre: what the GPU tests run on a backend, behind plain host vectors, so that nvcc never sees GoogleTest.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compute/device/device.hpp"
#include "compute/math/lanes.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre::gpu_tests {

/// An embedding brought to the host: the arrays of ClosestPointGrid and RefinedGrid.
struct HostEmbedding {
  std::vector<std::uint64_t> brick_code;
  std::vector<Float4> offset;
  std::vector<std::uint32_t> triangle, texel, block_cell, position, neighbour;
  std::vector<Float4> seed;
};

/// Each call uploads, launches on the backend and brings the result back.
class BackendRuns {
 public:
  virtual ~BackendRuns() = default;

  virtual std::vector<std::uint32_t> random_bits(std::int64_t n) = 0;  ///< for_each: philox(i, 0, 7).a
  virtual std::vector<std::uint64_t> count_by_remainder(std::int64_t n, int buckets) = 0;  ///< atomic_add of i + 1
  /// Exclusive scan followed by its returned sum.
  virtual std::vector<std::uint32_t> scan(std::span<const std::uint32_t> in, bool in_place) = 0;
  virtual std::vector<std::uint64_t> scan(std::span<const std::uint64_t> in, bool in_place) = 0;
  /// Scan of n bytes of which every `every`-th element is one, made on the device: (last output, returned sum).
  virtual std::pair<std::uint32_t, std::uint32_t> scan_flags(std::int64_t n, std::uint32_t every) = 0;
  virtual std::vector<std::uint64_t> sort(std::span<const std::uint64_t> keys) = 0;
  virtual std::uint64_t sum(std::span<const std::uint32_t> in) = 0;
  virtual float maximum(std::span<const float> in) = 0;  ///< -1 for none
  /// A repeated part, called once for each of `sizes`: clears n numbers, makes number i random, adds all up, puts sums
  /// of those before in their position. Returns the numbers and their sum after each call.
  virtual std::vector<std::vector<std::uint64_t>> repeat(std::span<const std::int64_t> sizes) = 0;
  virtual long graphs_made() const = 0;  ///< by all calls of `repeat` so far; 0 where there are none
  /// Calls of a repeated part of ten launches, of which the fifth asks to stop; how many of `calls` were interrupted.
  virtual int stop_inside(int calls) = 0;
  virtual StageTimers timers() = 0;  ///< stage "repeat" lies inside of the repeated part
  virtual HostEmbedding embed(const FlowMesh& mesh, const FlowParameters& parameters) = 0;
};

std::unique_ptr<BackendRuns> make_runs(Cpu, Device& device);
std::unique_ptr<BackendRuns> make_runs(Cuda, Device& device);

}  // namespace nacre::gpu_tests
