// Nacre: test bodies for the memory pool and the arrays in it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "tests/compute/on_devices.hpp"

namespace nacre::test {

inline std::uintptr_t address(const void* p) { return reinterpret_cast<std::uintptr_t>(p); }

template <class Backend>
void HeadAndTailNeverOverlap(Executor<Backend>& exec) {
  Arena arena(exec.device(), 1 << 20);
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> blocks;
  auto note = [&](const auto& array) {
    EXPECT_EQ(address(array.data()) % 256, 0u);
    blocks.emplace_back(address(array.data()), address(array.data()) + array.bytes());
  };
  Arena::Scope scope(arena);
  try {
    for (std::size_t n = 1;; n += 97) {
      note(arena.permanent<double>(n));
      note(arena.temporary<std::uint8_t>(3 * n));
      note(arena.temporary<std::uint32_t>(n));
    }
  } catch (const Error&) {
  }
  ASSERT_GT(blocks.size(), 60u);
  std::sort(blocks.begin(), blocks.end());
  for (std::size_t i = 1; i < blocks.size(); ++i) EXPECT_LE(blocks[i - 1].second, blocks[i].first);
  EXPECT_LE(blocks.back().second - blocks.front().first, std::size_t(1) << 20);
}

template <class Backend>
void ScopesGiveBackAndRewindDrops(Executor<Backend>& exec) {
  Arena arena(exec.device(), 64 << 10);
  const std::size_t all = arena.free_bytes();
  EXPECT_EQ(all, std::size_t(64) << 10);
  arena.permanent<std::uint8_t>(1);
  EXPECT_EQ(arena.free_bytes(), all - 256);
  const std::size_t mark = arena.mark();
  void* inner = nullptr;
  {
    Arena::Scope outer(arena);
    arena.temporary<std::uint8_t>(1000);
    {
      Arena::Scope scope(arena);
      inner = arena.temporary<std::uint8_t>(2000).data();
      EXPECT_EQ(arena.free_bytes(), all - 256 - 1024 - 2048);
    }
    EXPECT_EQ(arena.free_bytes(), all - 256 - 1024);
    EXPECT_EQ(arena.temporary<std::uint8_t>(2000).data(), inner);
  }
  EXPECT_EQ(arena.free_bytes(), all - 256);
  arena.permanent<std::uint8_t>(5000);
  arena.rewind(mark);
  EXPECT_EQ(arena.free_bytes(), all - 256);
  EXPECT_EQ(arena.peak_bytes(), 256u + 5120u);
}

template <class Backend>
void AFullBlockIsAnError(Executor<Backend>& exec) {
  Arena arena(exec.device(), 4096);
  EXPECT_THROW(arena.permanent<std::uint8_t>(4097), Error);
  EXPECT_THROW(arena.temporary<double>(513), Error);
  EXPECT_THROW(arena.permanent<double>(~std::size_t(0) / 8), Error);
  EXPECT_THROW(arena.temporary<double>((~std::size_t(0) >> 3) + 2), Error);  // 8 times this is 8 once it has wrapped
  EXPECT_EQ(arena.free_bytes(), 4096u);
  EXPECT_NO_THROW(arena.permanent<std::uint8_t>(4096));
  EXPECT_EQ(arena.free_bytes(), 0u);
  EXPECT_THROW(arena.temporary<std::uint8_t>(1), Error);
  EXPECT_NO_THROW(arena.temporary<std::uint8_t>(0));
}

template <class Backend>
void TheLastArrayGrowsAndShrinks(Executor<Backend>& exec) {
  Arena arena(exec.device(), 4096);
  const Array<std::uint32_t> other = arena.permanent_copy<std::uint32_t>(std::vector<std::uint32_t>{1, 2, 3});
  Array<std::uint32_t> array = arena.permanent<std::uint32_t>(0);
  arena.resize_last(array, 2);
  array.upload(std::vector<std::uint32_t>{7, 8});
  arena.resize_last(array, 500);
  EXPECT_EQ(array.size(), 500u);
  EXPECT_EQ(arena.free_bytes(), 4096u - 256u - 2048u);
  EXPECT_EQ(array.download(0, 2), (std::vector<std::uint32_t>{7, 8}));
  EXPECT_THROW(arena.resize_last(array, 961), Error);
  EXPECT_THROW(arena.resize_last(array, (~std::size_t(0) >> 2) + 2), Error);  // 4 times this is 4 once it has wrapped
  EXPECT_EQ(array.size(), 500u);
  EXPECT_EQ(arena.free_bytes(), 4096u - 256u - 2048u);
  arena.resize_last(array, 960);
  EXPECT_EQ(arena.free_bytes(), 0u);
  arena.resize_last(array, 1);
  EXPECT_EQ(array.download(), (std::vector<std::uint32_t>{7}));
  EXPECT_EQ(other.download(), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_NE(address(arena.permanent<std::uint8_t>(1).data()), address(array.data()));
  EXPECT_EQ(arena.peak_bytes(), 4096u);
}

template <class Backend>
void ArraysComeBackAsTheyWent(Executor<Backend>& exec) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  std::vector<std::uint32_t> host(10007);
  std::iota(host.begin(), host.end(), 5u);
  const Array<std::uint32_t> copied = arena.permanent_copy<std::uint32_t>(host);
  EXPECT_EQ(copied.download(), host);
  EXPECT_EQ(copied.download(100, 3), (std::vector<std::uint32_t>{105, 106, 107}));
  Array<std::uint32_t> array = arena.temporary<std::uint32_t>(host.size());
  array.fill_bytes(0xff);
  EXPECT_EQ(array.download(), std::vector<std::uint32_t>(host.size(), 0xffffffffu));
  array.upload(std::span<const std::uint32_t>(host).first(2));
  EXPECT_EQ(array.download(0, 3), (std::vector<std::uint32_t>{5, 6, 0xffffffffu}));
  Array<std::uint8_t> large = arena.temporary<std::uint8_t>((std::size_t(5) << 20) + 3);  // filled in pieces
  large.fill_bytes(7);
  EXPECT_EQ(large.download(), std::vector<std::uint8_t>(large.size(), 7));
  EXPECT_TRUE(arena.temporary<float>(0).download().empty());
  EXPECT_FALSE(Array<float>());
}

NACRE_DEVICE_TEST(Arena, HeadAndTailNeverOverlap)
NACRE_DEVICE_TEST(Arena, ScopesGiveBackAndRewindDrops)
NACRE_DEVICE_TEST(Arena, AFullBlockIsAnError)
NACRE_DEVICE_TEST(Arena, TheLastArrayGrowsAndShrinks)
NACRE_DEVICE_TEST(Arena, ArraysComeBackAsTheyWent)

}  // namespace nacre::test
