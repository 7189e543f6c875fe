// Nacre: tests of the memory that is expected of a mesh run.
#include "compute/pipeline/memory_estimate.hpp"

#include <gtest/gtest.h>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

VolumeFacts large_facts() {
  VolumeFacts facts;
  facts.bricks = 300000;
  facts.lattice_tiles = 100000;
  facts.boundary.usual = 2.6e6;
  return facts;
}

MeshParameters with_sizes(double low, double high) {
  MeshParameters parameters;
  parameters.min_size = low;
  parameters.max_size = high;
  return parameters;
}

/// A device with so much memory.
class SmallDevice : public Device {
 public:
  SmallDevice(std::size_t free, bool host) : free_(free), host_(host) {}
  std::string backend() const override { return host_ ? "cpu" : "cuda"; }
  std::string name() const override { return "small"; }
  int threads() const override { return 1; }
  bool shares_host_memory() const override { return host_; }
  void* allocate(std::size_t) override { return nullptr; }
  void deallocate(void*, std::size_t) noexcept override {}
  void copy_to_device(void*, const void*, std::size_t) override {}
  void copy_to_host(void*, const void*, std::size_t) override {}
  void fill(void*, unsigned char, std::size_t) override {}
  void synchronize() override {}
  std::size_t available_bytes() const override { return free_; }
  std::size_t arena_bytes() const override { return free_; }
  std::size_t peak_bytes() const override { return 1000000; }

 private:
  std::size_t free_;
  bool host_;
};

std::string refusal_with(const MeshParameters& parameters, std::size_t free) {
  try {
    require_memory(large_facts(), parameters, std::size_t(1) << 40, 0, SmallDevice(free, true));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(MemoryEstimate, GrowsWithAreaAndShrinksWithSizes) {
  const double peak = estimate_memory(large_facts(), with_sizes(2, 3)).peak();
  EXPECT_GT(peak, 1.5e9);
  EXPECT_LT(peak, 4e9);
  EXPECT_LT(estimate_memory(large_facts(), with_sizes(4, 6)).peak(), peak);
  EXPECT_GT(estimate_memory(large_facts(), with_sizes(1, 1.5)).peak(), 1.5 * peak);
  VolumeFacts twice = large_facts();
  twice.bricks *= 2, twice.lattice_tiles *= 2, twice.boundary.usual *= 2;
  EXPECT_NEAR(estimate_memory(twice, with_sizes(2, 3)).peak(), 2 * peak, 0.05 * peak);
}

/// Half of the area is beside plates that are two voxels thin, where particles are as small as the sizes allow.
TEST(MemoryEstimate, ThinMaterialsTakeMoreParticles) {
  VolumeFacts facts = large_facts();
  const MemoryEstimate thick = estimate_memory(facts, with_sizes(2, 3));
  facts.boundary.thin = {{2, 1.3e6}};
  const MemoryEstimate thin = estimate_memory(facts, with_sizes(2, 3));
  const double usual = 2.5, beside = 1.2;  // SizingRule::resolve, of a ball of radius 1
  EXPECT_NEAR(thin.triangulation / thick.triangulation, 0.5 + 0.5 * usual * usual / (beside * beside), 0.01);
  EXPECT_EQ(thin.fields, thick.fields);
}

TEST(MemoryEstimate, WhatFitsIsAccepted) {
  const double peak = estimate_memory(large_facts(), with_sizes(2, 3)).peak();
  EXPECT_EQ(refusal_with(with_sizes(2, 3), std::size_t(peak) + 1000), "");
  const SmallDevice host(std::size_t(8e9), true), other(std::size_t(8e9), false);
  EXPECT_DOUBLE_EQ(require_memory(large_facts(), with_sizes(2, 3), std::size_t(8e9), 500, host), peak + 1e6);
  EXPECT_LT(require_memory(large_facts(), with_sizes(2, 3), std::size_t(8e9), 500, other), peak)
      << "no triangulation there";
}

/// What the message says is enough is enough.
TEST(MemoryEstimate, WhatDoesNotFitIsRefusedWithWhatWould) {
  const auto free = std::size_t(0.9 * estimate_memory(large_facts(), with_sizes(2, 3)).peak());
  const std::string said = refusal_with(with_sizes(2, 3), free);
  EXPECT_NE(said.find("GB are free"), said.npos) << said;
  const std::size_t low = said.find("`min_size` to "), high = said.find("`max_size` to ");
  ASSERT_NE(low, said.npos) << said;
  ASSERT_NE(high, said.npos) << said;
  const double min_size = std::stod(said.substr(low + 14)), max_size = std::stod(said.substr(high + 14));
  EXPECT_GT(min_size, 2);
  EXPECT_EQ(refusal_with(with_sizes(min_size, max_size), free), "");
}

TEST(MemoryEstimate, FieldsAloneMayBeTooMuch) {
  const std::string said = refusal_with(with_sizes(2, 3), std::size_t(3e8));
  EXPECT_NE(said.find("resample it"), said.npos) << said;
}

}  // namespace
}  // namespace nacre
