// Nacre: what a flow keeps from step to step as bytes, for a run that goes on later, perhaps on other processes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/device/device.hpp"
#include "compute/device/ranks.hpp"

namespace nacre {

using PutBytes = std::function<void(std::span<const std::byte>)>;  ///< takes the next bytes
using TakeBytes = std::function<void(std::span<std::byte>)>;       ///< fills in the next bytes

/// Memory of a device; on several processes the part of this one, and the parts follow each other.
struct KeptArray {
  std::byte* data = nullptr;
  std::uint64_t bytes = 0;
};

/// Of an array's entries first .. first + n - 1.
template <class Values>
KeptArray kept(const Values& values, std::size_t first, std::size_t n) {
  return {reinterpret_cast<std::byte*>(values.data() + first), n * sizeof(*values.data())};
}

/// Gives the arrays to `put`, piece by piece; on several processes all of them to that of the first one, so that the
/// bytes do not depend on how many there are. `ranks`: null: this process is alone. Collective.
void put_arrays(Device& device, Ranks* ranks, std::span<const KeptArray> arrays, const PutBytes& put);

/// The reverse: on the first process, `take` gives what `put` got.
void take_arrays(Device& device, Ranks* ranks, std::span<const KeptArray> arrays, const TakeBytes& take);

}  // namespace nacre
