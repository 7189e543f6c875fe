// Nacre: the triangles of a large mesh at some of its points.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compute/meshing/incidence.hpp"

namespace nacre {

/// The triangles at some points of a mesh, which may become more. Searching them costs as much as there are, however
/// large the mesh is. Refers to the triangles that it was made of.
class TrianglesAround {
 public:
  TrianglesAround(std::span<const Triangle> all, std::size_t points) : all_(all), there_(points, 0) {}

  /// From now on these points are there, with all that has a triangle in common with one. `marks` marks them per point
  /// of the mesh, `points` lists them.
  void include(std::span<const std::uint8_t> marks, std::span<const std::uint32_t> points);

  /// Triangles at a point that was included, or that is a neighbour of one: their places in `numbers`, ascending.
  template <class Visit>
  void visit(std::uint32_t point, const Visit& visit) const {
    if (!at_) return;
    for (const std::uint32_t corner : at_->corners(point)) visit(corner / 3);
  }
  /// The triangles that are listed: their numbers in the mesh, ascending.
  std::span<const std::uint32_t> numbers() const { return numbers_; }
  const Triangle& operator[](std::size_t place) const { return listed_[place]; }

 private:
  std::vector<std::uint32_t> at_marked(std::span<const std::uint8_t> marks) const;

  std::span<const Triangle> all_;
  std::vector<std::uint8_t> there_;  // per point: its triangles are listed, and those of its neighbours
  std::vector<std::uint32_t> numbers_;
  std::vector<Triangle> listed_;
  std::optional<VertexTable> at_;  // of those
};

}  // namespace nacre
