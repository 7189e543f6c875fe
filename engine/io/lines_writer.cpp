// Nacre: writes points and polylines as VTK PolyData (.vtp).
#include "engine/io/lines_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "compute/device/error.hpp"
#include "engine/io/vtk_inline.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {

void write_vtp_lines(const std::filesystem::path& file, std::span<const Vec3d> points, std::size_t vertices,
                     std::span<const std::uint64_t> line_starts, std::span<const PointArray> arrays,
                     std::optional<double> time) {
  const std::size_t lines = line_starts.empty() ? 0 : line_starts.size() - 1;
  const std::uint64_t first = lines > 0 ? line_starts.front() : points.size();
  const auto fail = [&](const std::string& why) { throw Error(fmt::format("cannot write {}", file.string()), why); };
  if (vertices > first || (lines > 0 && line_starts.back() != points.size())) fail("the lines do not fit the points");
  for (const PointArray& array : arrays)
    if (array.components < 1 || array.values.size() != points.size() * std::size_t(array.components))
      fail(fmt::format("array \"{}\" does not have one tuple per point", array.name));

  Inline numbers;
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n";
  if (time && std::isfinite(*time))
    xml += fmt::format(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{}</DataArray>\n</FieldData>\n",
        *time);
  xml += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n<PointData>\n",
      points.size(), vertices, lines);
  for (const PointArray& array : arrays)
    xml += numbers.announce(
        "Float32", array.name, array.components, array.values.size() * sizeof(float),
        [&array](Base64Text& out) { out.write(array.values.data(), array.values.size() * sizeof(float)); });
  xml += "</PointData>\n<Points>\n" +
         numbers.announce("Float64", "Points", 3, points.size_bytes(),
                          [points](Base64Text& out) { out.write(points.data(), points.size_bytes()); }) +
         "</Points>\n";
  xml += "<Verts>\n" +
         announce_indices(numbers, "connectivity", vertices, points.size(), [](std::uint64_t i) { return i; }) +
         announce_indices(numbers, "offsets", vertices, points.size(), [](std::uint64_t i) { return i + 1; }) +
         "</Verts>\n<Lines>\n" +
         announce_indices(numbers, "connectivity", points.size() - first, points.size(),
                          [first](std::uint64_t i) { return first + i; }) +
         announce_indices(numbers, "offsets", lines, points.size(),
                          [line_starts, first](std::uint64_t i) { return line_starts[i + 1] - first; }) +
         "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  OutputFile out(file);
  numbers.write(out, xml);
  out.commit();
}

}  // namespace nacre
