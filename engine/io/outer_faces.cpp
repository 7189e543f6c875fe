// Nacre: faces that occur once, and which faces each kind of VTK cell has.
#include "engine/io/outer_faces.hpp"

#include <algorithm>
#include <numeric>

namespace nacre {
namespace {

using Faces = std::vector<std::vector<int>>;

/// A key that is equal for faces with the same corners in any order.
using Key = std::array<std::int64_t, 5>;

Key key_of(std::span<const std::int64_t> corners) {
  Key key;
  key.fill(-1);
  std::vector<std::int64_t> sorted(corners.begin(), corners.end());
  std::sort(sorted.begin(), sorted.end());
  std::copy_n(sorted.begin(), std::min<std::size_t>(sorted.size(), 4), key.begin());
  std::uint64_t mixed = sorted.size();
  for (std::size_t i = 4; i < sorted.size(); ++i) mixed = (mixed ^ std::uint64_t(sorted[i])) * 0x9e3779b97f4a7c15u;
  key[4] = std::int64_t(mixed);
  return key;
}

const Faces tetra = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
const Faces hexahedron = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
const Faces voxel = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
const Faces wedge = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
const Faces pyramid = {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

Faces prism(int sides) {
  Faces faces(2);
  for (int i = 0; i < sides; ++i) {
    faces[0].push_back(sides - 1 - i);
    faces[1].push_back(sides + i);
    const int next = (i + 1) % sides;
    faces.push_back({i, next, sides + next, sides + i});
  }
  return faces;
}

const Faces pentagonal_prism = prism(5);
const Faces hexagonal_prism = prism(6);

}  // namespace

void FaceCollector::add(std::span<const std::int64_t> corners, std::size_t cell, bool free) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  offsets_.push_back(corners_.size());
  cells_.push_back(cell);
  free_.push_back(free);
}

std::vector<bool> FaceCollector::find_outer() const {
  std::vector<bool> outer(cells_.size(), true);
  if (std::find(free_.begin(), free_.end(), false) == free_.end()) return outer;
  std::vector<Key> keys(cells_.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i] = key_of(std::span(corners_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]));
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first + 1;
    while (last < order.size() && keys[order[last]] == keys[order[first]]) ++last;
    for (std::size_t i = first; i < last; ++i) outer[order[i]] = free_[order[i]] || last - first == 1;
    first = last;
  }
  return outer;
}

std::span<const std::vector<int>> volume_cell_faces(int type) {
  switch (type) {
    case 10:
    case 24:
    case 71:
    case 78: return tetra;
    case 12:
    case 25:
    case 29:
    case 33:
    case 72:
    case 79: return hexahedron;
    case 11: return voxel;
    case 13:
    case 26:
    case 31:
    case 32:
    case 73:
    case 80: return wedge;
    case 14:
    case 27:
    case 37:
    case 74:
    case 81: return pyramid;
    case 15: return pentagonal_prism;
    case 16: return hexagonal_prism;
    default: return {};
  }
}

std::size_t flat_cell_corners(int type, std::size_t count) {
  switch (type) {
    case 5:
    case 22:
    case 34:
    case 69:
    case 76: return std::min<std::size_t>(count, 3);
    case 8:
    case 9:
    case 23:
    case 28:
    case 30:
    case 70:
    case 77: return std::min<std::size_t>(count, 4);
    case 7: return count;
    case 36: return count / 2;
    default: return 0;
  }
}

}  // namespace nacre
