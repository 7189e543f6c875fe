// Nacre: a hash by which processes see whether they have the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace nacre {

inline constexpr std::uint64_t hash_begin = 0xcbf29ce484222325;

/// FNV-1a: goes on from `hash`, with the bytes of an array.
template <class Value>
std::uint64_t hash_of(std::uint64_t hash, std::span<const Value> values) {
  for (const std::byte byte : std::as_bytes(values)) hash = (hash ^ std::uint64_t(byte)) * 0x100000001b3;
  return hash;
}

}  // namespace nacre
