// Nacre: VTK image data (.vti): a regular grid of values.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "compute/math/vec.hpp"
#include "engine/io/raw_mesh.hpp"
#include "engine/io/vtk_xml.hpp"

namespace nacre {

/// Values on a regular grid; x runs fastest. Point (i, j, k) lies at origin + direction * (spacing * (i, j, k)).
struct VtkImage {
  Int3 dimensions;  ///< points along each axis
  Vec3d origin;     ///< of point (0, 0, 0), whatever index it has in the file
  Vec3d spacing{1, 1, 1};
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row
  std::vector<RawArray> point_arrays;                          ///< one item per point
  std::vector<RawArray> cell_arrays;                           ///< one item per cell between the points
  std::size_t points() const { return std::size_t(dimensions.x) * dimensions.y * dimensions.z; }
};

/// The grid of a .vti of one piece, without its arrays. Throws Error if it is damaged, empty, or in several pieces.
VtkImage read_vtk_grid(const VtkXmlFile& file);

/// Reads a .vti of one piece. Throws Error if it is damaged, empty, or in several pieces.
VtkImage read_vtk_image(std::string bytes, const std::filesystem::path& path);

}  // namespace nacre
