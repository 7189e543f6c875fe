// Nacre: reads .vti.
#include "engine/io/vtk_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/io/file_bytes.hpp"
#include "engine/io/text_cursor.hpp"
#include "engine/io/vtk_xml.hpp"

namespace nacre {
namespace {

/// The N numbers of an attribute. False where it is missing. Throws Error if they are not N numbers.
template <std::size_t N>
bool read_numbers(pugi::xml_node node, const char* name, std::array<double, N>& values,
                  const std::filesystem::path& path) {
  const std::string_view content = node.attribute(name).value();
  TextCursor text(content);
  if (text.at_end()) return false;
  for (double& value : values)
    if (!text.number(value) || !std::isfinite(value))
      fail_reading(path, fmt::format("its {} is '{}', not {} numbers", name, content.substr(0, 60), N));
  return true;
}

}  // namespace

VtkImage read_vtk_grid(const VtkXmlFile& file) {
  const std::filesystem::path& path = file.path();
  const pugi::xml_node grid = file.dataset();
  if (file.type() != "ImageData") fail_reading(path, fmt::format("it holds {}, not ImageData", file.type()));
  const pugi::xml_node piece = grid.child("Piece");
  if (!piece) fail_reading(path, "it has no <Piece>");
  if (piece.next_sibling("Piece")) fail_reading(path, "it is in several pieces", "save it as one piece");

  std::array<double, 6> extent{};
  if (!read_numbers(piece, "Extent", extent, path) && !read_numbers(grid, "WholeExtent", extent, path))
    fail_reading(path, "it has no extent");
  VtkImage image;
  std::array<double, 3> origin{}, spacing{1, 1, 1};
  read_numbers(grid, "Origin", origin, path);
  read_numbers(grid, "Spacing", spacing, path);
  read_numbers(grid, "Direction", image.direction, path);
  for (int axis = 0; axis < 3; ++axis) {
    const double count = extent[2 * axis + 1] - extent[2 * axis] + 1;
    if (!(count >= 1 && count <= 1 << 20)) fail_reading(path, "its extent is empty or implausibly large");
    for (const double end : {extent[2 * axis], extent[2 * axis + 1]})
      if (end != std::floor(end)) fail_reading(path, fmt::format("its extent ends at {}, not at a whole number", end));
    image.dimensions[axis] = int(count);
    image.spacing[axis] = spacing[axis];
    image.origin[axis] = origin[axis];
  }
  for (int row = 0; row < 3; ++row)
    for (int axis = 0; axis < 3; ++axis)
      image.origin[row] += image.direction[3 * row + axis] * spacing[axis] * extent[2 * axis];
  return image;
}

VtkImage read_vtk_image(std::string bytes, const std::filesystem::path& path) {
  const VtkXmlFile file(std::move(bytes), path);
  VtkImage image = read_vtk_grid(file);
  const pugi::xml_node piece = file.dataset().child("Piece");
  std::size_t cells = 1;
  for (int axis = 0; axis < 3; ++axis) cells *= std::size_t(std::max(image.dimensions[axis] - 1, 1));
  image.point_arrays = file.arrays(piece.child("PointData"), image.points());
  image.cell_arrays = file.arrays(piece.child("CellData"), cells);
  if (image.point_arrays.empty() && image.cell_arrays.empty()) fail_reading(path, "it has no numeric arrays");
  return image;
}

}  // namespace nacre
