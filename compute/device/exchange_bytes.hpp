// Nacre: the second half of an exchange of bytes, whoever carries the messages.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/device/ranks.hpp"

namespace nacre {

/// Sends `send[q]` to process q, for all q, and returns what came from each: `coming[q]` bytes. Collective.
inline std::vector<Ranks::Bytes> exchange_bytes(Ranks& ranks, const std::vector<Ranks::Bytes>& send,
                                                std::span<const std::uint64_t> coming) {
  std::vector<Ranks::Bytes> received(send.size());
  std::vector<Ranks::Part> to, from;
  for (std::size_t q = 0; q < send.size(); ++q) {
    if (int(q) == ranks.rank()) {
      received[q] = send[q];
      continue;
    }
    received[q].resize(coming[q]);
    // What is sent is not written to; a part is for both ways.
    if (!send[q].empty()) to.push_back({int(q), {const_cast<std::byte*>(send[q].data()), send[q].size()}});
    if (coming[q]) from.push_back({int(q), received[q]});
  }
  ranks.exchange(to, from);
  return received;
}

}  // namespace nacre
