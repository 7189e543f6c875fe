// Nacre: what a flow keeps from step to step as bytes.
#include "compute/pipeline/kept_arrays.hpp"

namespace nacre {
namespace {

constexpr std::uint64_t piece_bytes = std::uint64_t(1) << 24;  // so that nobody holds a whole array twice

/// Visits the pieces of an array in the order of the processes: `visit(rank, data, bytes)`, where `data` is null on
/// all but the process that has the piece. Collective.
template <class Visit>
void for_each_piece(Ranks* ranks, const KeptArray& array, const Visit& visit) {
  const auto own = static_cast<std::size_t>(ranks ? ranks->rank() : 0);
  std::vector<std::uint64_t> bytes(static_cast<std::size_t>(ranks ? ranks->count() : 1));
  bytes[own] = array.bytes;
  if (ranks) ranks->sum(bytes);
  for (std::size_t r = 0; r < bytes.size(); ++r)
    for (std::uint64_t at = 0; at < bytes[r]; at += piece_bytes)
      visit(int(r), r == own ? array.data + at : nullptr, std::size_t(std::min(piece_bytes, bytes[r] - at)));
}

/// From process `from` to process `to`; the others take no part.
void pass(Ranks& ranks, int from, int to, std::span<std::byte> bytes) {
  const Ranks::Part out{to, bytes}, in{from, bytes};
  if (ranks.rank() == from)
    ranks.exchange({&out, 1}, {});
  else if (ranks.rank() == to)
    ranks.exchange({}, {&in, 1});
}

}  // namespace

void put_arrays(Device& device, Ranks* ranks, std::span<const KeptArray> arrays, const PutBytes& put) {
  std::vector<std::byte> piece;
  for (const KeptArray& array : arrays)
    for_each_piece(ranks, array, [&](int rank, std::byte* data, std::size_t bytes) {
      piece.resize(bytes);
      if (data) device.copy_to_host(piece.data(), data, bytes);
      if (rank != 0) pass(*ranks, rank, 0, piece);
      if (!ranks || ranks->first()) put(piece);
    });
}

void take_arrays(Device& device, Ranks* ranks, std::span<const KeptArray> arrays, const TakeBytes& take) {
  std::vector<std::byte> piece;
  for (const KeptArray& array : arrays)
    for_each_piece(ranks, array, [&](int rank, std::byte* data, std::size_t bytes) {
      piece.resize(bytes);
      if (!ranks || ranks->first()) take(piece);
      if (rank != 0) pass(*ranks, 0, rank, piece);
      if (data) device.copy_to_device(data, piece.data(), bytes);
    });
}

}  // namespace nacre
