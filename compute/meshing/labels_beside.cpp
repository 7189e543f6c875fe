// Nacre: materials of Delaunay cells beside triangles that are known.
#include "compute/meshing/labels_beside.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "compute/meshing/interface_facets.hpp"

namespace nacre {
namespace {

/// Turned so that the smallest corner comes first.
Triangle turned(Triangle t) {
  while (t.a > t.b || t.a > t.c) t = {t.b, t.c, t.a};
  return t;
}

/// Triangles by their corners.
class TriangleTable {
 public:
  explicit TriangleTable(std::span<const Triangle> triangles) : slots_(std::bit_ceil(2 * triangles.size() + 2), none) {
    for (const Triangle& t : triangles) triangles_.push_back(turned(t));
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) slots_[slot_of(triangles_[i])] = i;
  }

  /// The triangle with these corners, or `none`; `same`: it runs the same way round.
  std::uint32_t find(const Triangle& facet, bool& same) const {
    const Triangle t = turned(facet);
    const std::uint32_t found = slots_[slot_of(t)];
    same = found != none && triangles_[found].b == t.b;
    return found;
  }

 private:
  /// The slot of the triangle, or the empty one where it would go.
  std::size_t slot_of(const Triangle& t) const {
    const auto [low, high] = std::minmax(t.b, t.c);
    std::uint64_t key = t.a;
    for (const std::uint32_t corner : {low, high}) key = (std::rotl(key, 21) ^ corner) * 0x9e3779b97f4a7c15u;
    std::size_t slot = (key ^ key >> 32) & (slots_.size() - 1);
    while (slots_[slot] != none && !has_corners(triangles_[slots_[slot]], t.a, low, high))
      slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  static bool has_corners(const Triangle& t, std::uint32_t first, std::uint32_t low, std::uint32_t high) {
    return t.a == first && std::min(t.b, t.c) == low && std::max(t.b, t.c) == high;
  }

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace

void label_beside(const DelaunayCells& cells, std::span<const Triangle> triangles,
                  std::span<const std::array<std::uint16_t, 2>> materials, std::span<std::uint16_t> label) {
  if (triangles.empty()) return;
  const TriangleTable table(triangles);
  std::vector<std::uint8_t> is_corner;
  for (const Triangle& t : triangles) {
    is_corner.resize(std::max(is_corner.size(), std::size_t(std::max({t.a, t.b, t.c})) + 1), 0);
    is_corner[t.a] = is_corner[t.b] = is_corner[t.c] = 1;
  }
  const auto may_be = [&](std::uint32_t v) { return v < is_corner.size() && is_corner[v]; };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, label.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const auto& v = cells.vertices[i];
      bool known = false, agree = true;
      std::uint16_t material = 0;
      for (const auto& [a, b, c] : facet_corners) {
        if (!may_be(v[a]) || !may_be(v[b]) || !may_be(v[c])) continue;
        bool same = false;
        const std::uint32_t t = table.find({v[a], v[b], v[c]}, same);
        if (t == none) continue;
        // A triangle is seen from the side of its first material, a facet from outside of its cell.
        const std::uint16_t inside = materials[t][same ? 1 : 0];
        agree = agree && (!known || inside == material);
        known = true, material = inside;
      }
      if (known && agree) label[i] = material;
    }
  });
}

}  // namespace nacre
