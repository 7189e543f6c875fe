// Nacre: the sides of a mesh's triangles, edge by edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/field/interface.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Side k of a triangle, as one of the sides of the mesh.
struct MeshSide {
  std::uint32_t a, b;
  std::array<std::uint16_t, 2> materials;
  std::uint32_t triangle;
  std::uint8_t k;

  bool same_edge(const MeshSide& other) const { return a == other.a && b == other.b; }
};

/// All of them: those at one edge beside each other, and of these the ones between the same two materials.
std::vector<MeshSide> sides_of(const SurfaceMesh& mesh);

/// A curve by its materials in any order.
Junction curve_between(std::uint16_t a, std::uint16_t b, std::uint16_t c);

/// The curve that sides at one edge lie on; no junction where two materials meet there, or more than three.
Junction curve_of(std::span<const MeshSide> sides);

/// Calls visit(sides at one edge) for each edge of what `sides_of` returns.
template <class Visit>
void for_each_edge(std::span<const MeshSide> sides, const Visit& visit) {
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    end = begin + 1;
    while (end < sides.size() && sides[end].same_edge(sides[begin])) ++end;
    visit(sides.subspan(begin, end - begin));
  }
}

}  // namespace nacre
