// Nacre: the readers of single files, one per format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/raw_mesh.hpp"

namespace nacre {

/// Each takes the content of the file and its path (for messages and, in .pvtp/.pvtu, to find the pieces). Throws Error
/// if the content is not such a file, is truncated, or announces more than it contains.
RawMesh read_obj(std::string bytes, const std::filesystem::path& path);
RawMesh read_ply(std::string bytes, const std::filesystem::path& path);
RawMesh read_stl(std::string bytes, const std::filesystem::path& path);
RawMesh read_off(std::string bytes, const std::filesystem::path& path);
RawMesh read_gifti(std::string bytes, const std::filesystem::path& path);
RawMesh read_vtk_xml(std::string bytes, const std::filesystem::path& path);

/// A file that a .pvtp or .pvtu names.
struct VtkPiece {
  std::filesystem::path file, list;
  std::string list_type;  ///< what the list says it holds
};
std::vector<VtkPiece> vtk_pieces(const std::filesystem::path& list);
RawMesh read_vtk_piece(const VtkPiece& piece);
inline constexpr const char* faces_between_pieces =
    "Faces between the pieces of the volume are kept as part of its surface.";

}  // namespace nacre
