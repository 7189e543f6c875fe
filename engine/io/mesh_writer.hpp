// Nacre: writes meshes of materials in the format of the file's extension.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "compute/meshing/second_order.hpp"

namespace nacre {

/// Writes `mesh`, in world coordinates, as .vtp, .ply (binary), .msh (Gmsh 2.2, binary), .obj, .off or .stl (binary),
/// or as a format of mesh_format_writers.hpp that has surfaces (.msh4 .inp .glb), with its groups per pair of
/// materials. `labels` has the file's label of each material, that of the outside first; `names` has their names, where
/// known. .vtp, .ply and .msh have `material_0` and `material_1` per triangle: the labels on its two sides, in the
/// order of SurfaceMesh::materials, so that corners run counter-clockwise as seen from the side of `material_0`. .msh
/// also has one physical group per pair of materials, named by their names ("outside - liver") or labels
/// ("material_0_5"); .obj has one group per pair, named by the labels. .vtp has the names as field data: an array of
/// each name that contains the label. .stl has 32-bit coordinates. `origin` says how the mesh came about
/// (engine/run/origin.hpp); it becomes a comment, except in .stl and .foam, which have no place for one. `second` are
/// the nodes of a mesh of second order, which .msh, .msh4 and .inp have a place for; null: it is of first. Throws Error
/// for other extensions, for an empty or broken mesh, and if writing fails.
void write_surface_mesh(const std::filesystem::path& file, const SurfaceMesh& mesh,
                        std::span<const std::int64_t> labels, std::span<const std::string> names = {},
                        const std::string& origin = "", const SecondOrder* second = nullptr);

/// Writes the closed surface of each material except the outside to a file of its own, with normals that point out of
/// it: `file` F.ext becomes F_LABEL.ext. Materials without a surface are left out; each file has only the points that
/// it uses. If one file fails, those already written are removed. Returns the files. Formats and errors as above;
/// nothing is written per triangle.
std::vector<std::filesystem::path> write_material_surfaces(const std::filesystem::path& file, const SurfaceMesh& mesh,
                                                           std::span<const std::int64_t> labels,
                                                           std::span<const std::string> names = {},
                                                           const std::string& origin = "",
                                                           const SecondOrder* second = nullptr);

/// Writes `mesh` as .vtu, with the label of each cell as `material`, as .msh (Gmsh 2.2, binary), or as a format of
/// mesh_format_writers.hpp that has tetrahedra (.msh4 .inp .mesh .feb .foam). `surface` is the mesh that was filled:
/// its points are the first ones of `mesh`, its triangles the facets between materials. .msh also has these, before the
/// tetrahedra: one physical group per pair of materials of the triangles, and one per material of the tetrahedra, whose
/// number is the label if all labels are positive. Names as above, in .vtu as in .vtp. `second` are its nodes of
/// second order, which all formats but .foam have a place for; null: it is of first. Throws Error for other extensions,
/// for an empty or broken mesh, and if writing fails.
void write_tetrahedral_mesh(const std::filesystem::path& file, const TetrahedralMesh& mesh, const SurfaceMesh& surface,
                            std::span<const std::int64_t> labels, std::span<const std::string> names = {},
                            const std::string& origin = "", const SecondOrder* second = nullptr);

/// Throws Error where `file` is of a format that has no elements of second order (of tetrahedra, or of triangles).
void check_second_order(const std::filesystem::path& file, bool tetrahedra);

/// Extensions, lower case, with dot.
std::vector<std::string> surface_mesh_extensions();
std::vector<std::string> tetrahedral_mesh_extensions();
std::vector<std::string> mesh_extensions();  ///< those of both, each once

}  // namespace nacre
