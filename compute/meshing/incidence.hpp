// Nacre: which triangles meet at each edge and at each vertex of a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

inline bool has_corner(const Triangle& t, std::uint32_t v) { return t.a == v || t.b == v || t.c == v; }

/// Marks the points, of which there are so many, that are corners of triangles. In parallel.
std::vector<std::uint8_t> mark_corners(std::span<const Triangle> triangles, std::size_t points);

/// The edges of a mesh, ascending by (a, b), a < b. A use is 3 * triangle + k: the edge from the triangle's corner k to
/// its next one.
class EdgeTable {
 public:
  /// Corners of `triangles` are less than `points`. Edges of a corner with itself (of degenerate triangles) are left
  /// out. Throws Error where there are more than 1.4 billion triangles.
  EdgeTable(std::span<const Triangle> triangles, std::size_t points);

  std::size_t size() const { return a_.size(); }
  std::uint32_t a(std::size_t edge) const { return a_[edge]; }
  std::uint32_t b(std::size_t edge) const { return b_[edge]; }
  /// Ascending.
  std::span<const std::uint32_t> uses(std::size_t edge) const {
    return {uses_.data() + first_[edge], first_[edge + 1] - first_[edge]};
  }

 private:
  std::vector<std::uint32_t> a_, b_, uses_;
  std::vector<std::size_t> first_;
};

/// The triangles at each vertex. An entry is 3 * triangle + k where the vertex is the triangle's corner k; ascending.
class VertexTable {
 public:
  VertexTable(std::span<const Triangle> triangles, std::size_t points);

  std::size_t size() const { return first_.size() - 1; }
  std::span<const std::uint32_t> corners(std::size_t vertex) const {
    return {corners_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace nacre
