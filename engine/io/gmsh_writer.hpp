// Nacre: writes meshes for Gmsh (.msh, version 2.2, binary).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// The contents of a .msh: blocks of cells of one kind each, with every cell in one physical group. Cells are numbered
/// through all blocks.
struct GmshMesh {
  struct Group {
    std::int32_t tag;  ///< > 0; triangles and tetrahedra have different tags
    std::string name;  ///< is cut to 127 bytes; if another group has it, the tag is added
  };
  struct Block {
    int dimension = 2;  ///< 2 triangles, 3 tetrahedra
    int points = 3;     ///< per cell: 3 or 4 corners, or 6 or 10 with the nodes on edges
    std::size_t cells = 0;
    std::function<std::uint32_t(std::size_t cell, int k)> point;
    std::function<std::int32_t(std::size_t cell)> group;  ///< the tag of its group
    std::vector<Group> groups;
  };
  struct Numbers {
    std::string name;
    std::function<double(std::size_t block, std::size_t cell)> of;
  };

  std::span<const Vec3d> points;
  std::span<const Vec3d> nodes = {};  ///< numbered behind `points`
  std::vector<Block> blocks;
  std::vector<Numbers> numbers;  ///< written as $ElementData of all cells; meshio 5.3 reads them if there is one block
  std::string origin = {};       ///< becomes $Comments

  std::size_t cells() const;
};

/// A name in quotes as Gmsh accepts it, at most 127 bytes long, unique among those in `taken`, to which it is added:
/// readers such as meshio identify groups by their names.
std::string gmsh_name(const std::string& name, std::int32_t tag, std::set<std::string>& taken);

/// What Gmsh calls a triangle or a tetrahedron with so many points.
std::int32_t gmsh_type(std::size_t points);
/// Which of the points of MeshParts::Element is Gmsh's point `k` of an element with `points` of them.
std::size_t gmsh_order(std::size_t points, std::size_t k);

/// Readable by Gmsh, meshio and other programs that know version 2.2. Throws Error if there are more than 2^31 - 1
/// points or cells, or if the file cannot be written.
void write_gmsh(const std::filesystem::path& file, const GmshMesh& mesh);

}  // namespace nacre
