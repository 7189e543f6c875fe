// Nacre: the processes of a library user, as the engine sees them.
#include "api/shared_run.hpp"

#include <chrono>
#include <cstring>
#include <string>

#include "compute/device/error.hpp"
#include "compute/device/exchange_bytes.hpp"

namespace nacre {

RanksOfCaller::RanksOfCaller(Processes& processes)
    : processes_(processes), rank_(processes.rank()), count_(processes.count()) {
  if (rank_ < 0 || rank_ >= count_)
    throw Error("there is no process " + std::to_string(rank_) + " among " + std::to_string(count_));
}

void RanksOfCaller::sum(std::span<std::uint64_t> values) {
  if (count_ == 1) return;
  const auto begun = std::chrono::steady_clock::now();
  processes_.sum(values);
  waited_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  sent_ += values.size_bytes();
}

/// First each tells all others how much comes.
std::vector<Ranks::Bytes> RanksOfCaller::exchange(const std::vector<Bytes>& send) {
  constexpr std::size_t width = sizeof(std::uint64_t);
  std::vector<Bytes> sizes(send.size(), Bytes(width));
  std::vector<std::uint64_t> coming(send.size(), width);
  for (std::size_t q = 0; q < send.size(); ++q) {
    const std::uint64_t size = send[q].size();
    std::memcpy(sizes[q].data(), &size, width);
  }
  const std::vector<Bytes> told = exchange_bytes(*this, sizes, coming);
  for (std::size_t q = 0; q < send.size(); ++q) std::memcpy(&coming[q], told[q].data(), width);
  return exchange_bytes(*this, send, coming);
}

void RanksOfCaller::begin(std::span<const Part> send, std::span<const Part> receive) {
  to_.clear(), from_.clear();
  for (const Part& part : send) {
    to_.push_back({part.rank, part.bytes});
    sent_ += part.bytes.size();
  }
  for (const Part& part : receive) from_.push_back({part.rank, part.bytes});
}

/// The caller's exchange waits, so nothing is sent before.
void RanksOfCaller::finish() {
  if (count_ == 1) return;
  const auto begun = std::chrono::steady_clock::now();
  processes_.exchange(to_, from_);
  waited_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

}  // namespace nacre
