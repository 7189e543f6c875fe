// Nacre: the launches that everything stands on, the same bodies on both backends.
#include <algorithm>
#include <numeric>

#include "compute/device/random.hpp"
#include "tests/gpu/each_backend.hpp"

namespace nacre::gpu_tests {
namespace {

class Primitives : public EachBackend {};
INSTANTIATE_TEST_SUITE_P(On, Primitives, testing::Values("cpu", "cuda"), backend_name);

const std::int64_t sizes[] = {1, 2, 31, 255, 256, 257, 65'537, 1'000'003};

TEST_P(Primitives, ForEachVisitsEveryElementOnce) {
  for (const std::int64_t n : sizes) {
    const std::vector<std::uint32_t> out = runs->random_bits(n);
    for (std::int64_t i = 0; i < n; ++i) ASSERT_EQ(out[i], philox(std::uint32_t(i), 0, 7).a) << n << " " << i;
  }
  EXPECT_TRUE(runs->random_bits(0).empty());
}

TEST_P(Primitives, AtomicSumsAreExact) {
  const std::int64_t n = 1'000'000;  // bucket k: k + 1, k + 11, ..: 100 000 terms, 10 apart
  const std::vector<std::uint64_t> count = runs->count_by_remainder(n, 10);
  for (std::uint64_t k = 0; k < 10; ++k)
    EXPECT_EQ(count[k], 100'000 * (k + 1) + 10 * (std::uint64_t(99'999) * 100'000 / 2)) << k;
}

template <class T>
void expect_scan(BackendRuns& runs, std::int64_t n, bool in_place) {
  std::vector<T> in(n), expected(n + 1);
  for (std::int64_t i = 0; i < n; ++i) in[i] = T(i % 7);
  std::exclusive_scan(in.begin(), in.end(), expected.begin(), T(0));
  expected[n] = std::accumulate(in.begin(), in.end(), T(0));
  EXPECT_EQ(runs.scan(std::span<const T>(in), in_place), expected) << n << (in_place ? " in place" : "");
}

TEST_P(Primitives, ExclusiveScan) {
  for (const std::int64_t n : sizes)
    for (const bool in_place : {false, true}) {
      expect_scan<std::uint32_t>(*runs, n, in_place);
      expect_scan<std::uint64_t>(*runs, n, in_place);
    }
}

TEST_P(Primitives, ScanOfNothingIsZero) {
  EXPECT_EQ(runs->scan(std::span<const std::uint32_t>(), true), std::vector<std::uint32_t>{0});
}

TEST_P(Primitives, ScanCountsIn64Bits) {
  const std::vector<std::uint64_t> in{std::uint64_t(1) << 40, std::uint64_t(1) << 41, 5};
  const std::vector<std::uint64_t> sums{0, in[0], in[0] + in[1], in[0] + in[1] + 5};
  EXPECT_EQ(runs->scan(std::span<const std::uint64_t>(in), true), sums);
}

TEST_P(Primitives, SortsKeysOf64Bits) {
  for (const std::int64_t n : sizes) {
    std::vector<std::uint64_t> keys(n);
    for (std::int64_t i = 0; i < n; ++i) {
      const Random2 r = philox(std::uint32_t(i), 1, 9);
      keys[i] = std::uint64_t(r.a) << 32 | r.b;
    }
    std::vector<std::uint64_t> expected = keys;
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(runs->sort(keys), expected) << n;
  }
}

TEST_P(Primitives, Reduce) {
  for (const std::int64_t n : sizes) {
    std::vector<std::uint32_t> in(n);
    for (std::int64_t i = 0; i < n; ++i) in[i] = 4'000'000'000u + std::uint32_t(i % 3);
    EXPECT_EQ(runs->sum(in), std::accumulate(in.begin(), in.end(), std::uint64_t(0))) << n;
    std::vector<float> values(n, 0.25f);
    values[n * 2 / 3] = 7.5f;
    EXPECT_EQ(runs->maximum(values), 7.5f) << n;
  }
  EXPECT_EQ(runs->sum({}), 0u);
  EXPECT_EQ(runs->maximum({}), -1.0f);
}

TEST(PrimitivesOnCuda, ScanOfMoreThan2To31Elements) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const std::int64_t n = (std::int64_t(1) << 31) + 12'345;
  const std::size_t needed = std::size_t(n) * 4 + (std::size_t(256) << 20);
  const auto device = make_cuda_device(needed);
  if (device->arena_bytes() < needed) GTEST_SKIP() << "this GPU has no " << (needed >> 20) << " MiB free";
  const auto [last, sum] = make_runs(Cuda{}, *device)->scan_flags(n, 5);
  EXPECT_EQ(sum, std::uint32_t((n + 4) / 5));
  EXPECT_EQ(last, std::uint32_t((n - 1 + 4) / 5));
}

}  // namespace
}  // namespace nacre::gpu_tests
