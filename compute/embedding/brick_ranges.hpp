// Nacre: the bricks of an octree, cut into ranges of equal work along the Morton curve, and what lies around a range.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

/// Where each of `parts` ranges of consecutive bricks begins, and the end of the last: parts + 1 ascending entries, the
/// first 0. Range r ends before the brick in whose middle the work passes the share (r + 1) / parts of the whole, so
/// that either end is off by half a brick at most. With fewer bricks than parts some ranges are empty.
/// `work`: per brick.
std::vector<std::size_t> cut_by_work(std::span<const std::uint64_t> work, int parts);

/// The Morton codes of all positions within `depth` bricks (on every axis, also diagonally) of `bricks`, which are
/// ascending codes in a domain of 1 << levels bricks per axis; ascending, each once, `bricks` among them. Depth 0:
/// `bricks` themselves.
std::vector<std::uint64_t> codes_around(std::span<const std::uint64_t> bricks, int depth, int levels);

}  // namespace nacre
