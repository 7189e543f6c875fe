// Nacre: the triangles of a large mesh at some of its points.
#include "compute/meshing/triangles_around.hpp"

#include <algorithm>

#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr int rings_beyond = 2;  // rings of triangles that are there, too: points come near those that there are
}  // namespace

void TrianglesAround::include(std::span<const std::uint8_t> marks, std::span<const std::uint32_t> points) {
  if (at_ && std::ranges::all_of(points, [&](std::uint32_t v) { return there_[v] != 0; })) return;
  std::vector<std::uint8_t> wider(marks.begin(), marks.end());
  const auto widen = [&] {
    for (const std::uint32_t i : at_marked(wider)) wider[all_[i].a] = wider[all_[i].b] = wider[all_[i].c] = 1;
  };
  for (int ring = 0; ring < rings_beyond; ++ring) widen();
  there_ = wider;
  widen();
  numbers_ = at_marked(wider);
  listed_.clear();
  for (const std::uint32_t i : numbers_) listed_.push_back(all_[i]);
  at_.emplace(listed_, there_.size());
}

/// The numbers of triangles with a marked corner.
std::vector<std::uint32_t> TrianglesAround::at_marked(std::span<const std::uint8_t> marks) const {
  return select_where(all_.size(), [&](std::size_t i) {
    const Triangle& t = all_[i];
    return marks[t.a] || marks[t.b] || marks[t.c];
  });
}

}  // namespace nacre
