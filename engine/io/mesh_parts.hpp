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

#include "compute/meshing/surface_mesh.hpp"

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

  std::span<const Vec3d> points;
  std::span<const Triangle> triangles;      ///< seen from the side of the pair's first, corners run counter-clockwise
  std::span<const MaterialPair> materials;  ///< of each triangle
  std::span<const std::array<std::uint32_t, 4>> cells;  ///< positive volume; empty if the mesh is a surface
  std::span<const std::uint16_t> material;              ///< of each cell
  std::map<MaterialPair, Group> interfaces;             ///< pairs that occur, numbered from 1
  std::map<std::uint16_t, Group>
      volumes;         ///< materials that cells have; the labels if all are positive, else materials
  std::string origin;  ///< how the mesh came about (engine/run/origin.hpp); empty if that is not known
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
