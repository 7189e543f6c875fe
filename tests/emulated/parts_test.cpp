// Nacre: launches in parts where the GPU draws a screen.
#include <gtest/gtest.h>

#include <chrono>

#include "compute/device/executor_cuda.cuh"

namespace nacre {
namespace {

/// 40 us for each number.
struct AddSlowly {
  std::uint32_t* to;
  NACRE_HD void operator()(std::int64_t i) const {
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < std::chrono::microseconds(40)) {
    }
    ++to[i];
  }
};

struct CountTeams {
  std::uint32_t* to;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    if (team.first()) ++to[i];
  }
};

class LaunchesInParts : public testing::TestWithParam<bool> {
 protected:
  LaunchesInParts() {
    emulated::draw_screen(GetParam());
    device_ = make_cuda_device(std::size_t(4) << 20);
    exec_ = std::make_unique<Executor<Cuda>>(*device_);
    numbers_ = exec_->arena().permanent<std::uint32_t>(count);
    numbers_.fill_bytes(0);
  }
  ~LaunchesInParts() override { emulated::draw_screen(false); }

  /// How many kernels `work` launches.
  template <class Work>
  long launches(const Work& work) {
    const long before = emulated::launches();
    work();
    return emulated::launches() - before;
  }

  static constexpr std::int64_t count = 40000;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Executor<Cuda>> exec_;
  Array<std::uint32_t> numbers_;
  Steps steps_;
};
INSTANTIATE_TEST_SUITE_P(On, LaunchesInParts, testing::Bool(),
                         [](const auto& test) { return test.param ? "AScreen" : "NoScreen"; });

/// Slower by far than 200 ms for all: also in a graph, for which what the first call measured must do.
TEST_P(LaunchesInParts, EachElementIsRunOnceWhateverTheParts) {
  const auto add = [&] { exec_->repeat(steps_, [&] { exec_->for_each(count / 4, AddSlowly{numbers_.data()}); }); };
  const long first = launches(add), second = launches(add);
  std::vector<std::uint32_t> expected(count, 0);
  std::fill_n(expected.begin(), count / 4, 2);
  EXPECT_EQ(numbers_.download(), expected);
  EXPECT_EQ(first, 1) << "unknown, and few";
  if (GetParam())
    EXPECT_GE(second, 3) << "400 ms";
  else
    EXPECT_EQ(second, 1);
}

TEST_P(LaunchesInParts, TeamsToo) {
  const long first = launches([&] { exec_->for_each_team(count, CountTeams{numbers_.data()}); });
  EXPECT_EQ(numbers_.download(), std::vector<std::uint32_t>(count, 1));
  EXPECT_GE(first, GetParam() ? 2 : 1);
  EXPECT_LE(first, GetParam() ? 30 : 1);
}

}  // namespace
}  // namespace nacre
