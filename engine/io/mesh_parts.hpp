// Nacre: what every format of meshes is written from: the triangles and tetrahedra, and what their groups are called.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compute/meshing/second_order.hpp"

namespace nacre {

using MaterialPair = std::array<std::uint16_t, 2>;

/// A mesh with one group per pair of materials (of triangles) and one per material (of tetrahedra). It refers to the
/// meshes that it was made of.
struct MeshParts {
  struct Group {
    std::int32_t tag;  ///< > 0; triangles and tetrahedra are numbered apart
    std::string name;
    std::size_t cells;  ///< > 0
  };
  /// The points of a triangle or a tetrahedron: its corners and, at second order, the nodes on its edges 01 12 20, and
  /// 03 13 23 of a tetrahedron.
  class Element {
   public:
    template <std::size_t corners, std::size_t sides>
    Element(const std::array<std::uint32_t, corners>& corner, const std::array<std::uint32_t, sides>* node,
            std::size_t first_node)
        : size_(corners + (node ? sides : 0)) {
      for (std::size_t k = 0; k < corners; ++k) point_[k] = corner[k];
      for (std::size_t k = corners; k < size_; ++k) point_[k] = std::uint32_t(first_node + (*node)[k - corners]);
    }
    std::size_t size() const { return size_; }
    std::uint32_t operator[](std::size_t k) const { return point_[k]; }
    const std::uint32_t* begin() const { return point_.data(); }
    const std::uint32_t* end() const { return point_.data() + size_; }

   private:
    std::array<std::uint32_t, 10> point_{};
    std::size_t size_;
  };

  std::span<const Vec3d> points;
  std::span<const Triangle> triangles;      ///< seen from the side of the pair's first, corners run counter-clockwise
  std::span<const MaterialPair> materials;  ///< of each triangle
  std::span<const std::array<std::uint32_t, 4>> cells;  ///< positive volume; empty if the mesh is a surface
  std::span<const std::uint16_t> material;              ///< of each cell
  std::map<MaterialPair, Group> interfaces;             ///< pairs that occur, numbered from 1
  std::map<std::uint16_t, Group>
      volumes;                          ///< materials that cells have; the labels if all are positive, else materials
  const SecondOrder* second = nullptr;  ///< nodes on edges, numbered behind `points`; null: there are none
  std::string origin;                   ///< how the mesh came about (engine/run/origin.hpp); empty if that is not known

  std::size_t point_count() const { return points.size() + (second ? second->nodes.size() : 0); }
  const Vec3d& point(std::size_t i) const { return i < points.size() ? points[i] : second->nodes[i - points.size()]; }
  Element triangle(std::size_t i) const {
    const Triangle& t = triangles[i];
    return {std::array{t.a, t.b, t.c}, second ? &second->triangles[i] : nullptr, points.size()};
  }
  Element cell(std::size_t i) const { return {cells[i], second ? &second->cells[i] : nullptr, points.size()}; }
};

/// The names of materials for a file: each is followed by its label if another material has the same name, and is
/// "material_LABEL" if none is given. Empty if no material has one.
std::vector<std::string> full_names(std::span<const std::int64_t> labels, std::span<const std::string> given);

/// The name of one material, and of the interface of two. `names`: as full_names gives them.
std::string material_name(std::uint16_t material, std::span<const std::int64_t> labels,
                          std::span<const std::string> names);
std::string interface_name(const MaterialPair& pair, std::span<const std::int64_t> labels,
                           std::span<const std::string> names);

/// `names`: as full_names gives them.
MeshParts surface_parts(const SurfaceMesh& mesh, std::span<const std::int64_t> labels,
                        std::span<const std::string> names);
MeshParts volume_parts(const TetrahedralMesh& mesh, const SurfaceMesh& surface, std::span<const std::int64_t> labels,
                       std::span<const std::string> names);

/// Gives each name as a word that every solver accepts: at most 60 ASCII letters, digits and underscores, a letter
/// first, and different from all before it even without regard to case.
class Identifiers {
 public:
  std::string of(const std::string& name);

 private:
  std::set<std::string> taken_;
};

/// Throws Error unless points and cells can be counted in 31 bits, as `format` demands.
void check_counts(const std::filesystem::path& file, const MeshParts& mesh, const char* format);

}  // namespace nacre
