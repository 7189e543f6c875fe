// Nacre: the processes of a library user, as the engine sees them.
#include "api/shared_run.hpp"

#include <chrono>
#include <string>

#include "compute/device/error.hpp"

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
  const auto n = static_cast<std::size_t>(count_), own = static_cast<std::size_t>(rank_);
  std::vector<std::uint64_t> out(n), in(n);
  std::vector<Part> to, from;
  const auto others = [&](const auto& visit) {
    for (std::size_t q = 0; q < n; ++q)
      if (q != own) visit(q, int(q));
  };
  others([&](std::size_t q, int rank) {
    out[q] = send[q].size();
    to.push_back({rank, std::as_writable_bytes(std::span(&out[q], 1))});
    from.push_back({rank, std::as_writable_bytes(std::span(&in[q], 1))});
  });
  Ranks::exchange(to, from);
  to.clear(), from.clear();
  std::vector<Bytes> received(n);
  received[own] = send[own];
  others([&](std::size_t q, int rank) {
    received[q].resize(in[q]);
    // What is sent is not written to; a part is for both ways.
    if (out[q]) to.push_back({rank, {const_cast<std::byte*>(send[q].data()), send[q].size()}});
    if (in[q]) from.push_back({rank, received[q]});
  });
  Ranks::exchange(to, from);
  return received;
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
