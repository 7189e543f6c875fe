// Nacre: writes surfaces, point clouds and polylines as VTK PolyData (.vtp).
#include "engine/io/vtp_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

static_assert(sizeof(Vec3f) == 12 && sizeof(Vec3d) == 24 && sizeof(Triangle) == 12);

std::string announce_cells(Inline& numbers, std::uint64_t points, std::span<const Triangle> triangles) {
  const auto self = [](std::uint64_t i) { return i; };
  const auto after = [](std::uint64_t i) { return i + 1; };
  if (triangles.empty())
    return "<Verts>\n" + announce_indices(numbers, "connectivity", points, points, self) +
           announce_indices(numbers, "offsets", points, points, after) + "</Verts>\n";
  const std::string corners =
      numbers.announce("UInt32", "connectivity", 1, triangles.size_bytes(),
                       [triangles](Base64Text& file) { file.write(triangles.data(), triangles.size_bytes()); });
  const auto end = [](std::uint64_t i) { return 3 * i + 3; };
  return "<Polys>\n" + corners + announce_indices(numbers, "offsets", triangles.size(), 3 * triangles.size(), end) +
         "</Polys>\n";
}

std::string announce_arrays(Inline& numbers, std::span<const PointArray> arrays,
                            std::span<const PointPositions> positions) {
  std::string xml = "<PointData>\n";
  for (const PointArray& array : arrays)
    xml += numbers.announce(
        "Float32", array.name, array.components, array.values.size() * sizeof(float),
        [&array](Base64Text& file) { file.write(array.values.data(), array.values.size() * sizeof(float)); });
  for (const PointPositions& each : positions)
    xml += numbers.announce("Float64", each.name, 3, each.values.size_bytes(),
                            [&each](Base64Text& file) { file.write(each.values.data(), each.values.size_bytes()); });
  return xml + "</PointData>\n";
}

/// What comes before the piece.
std::string poly_data_start(std::optional<double> time, const std::string& field_data) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n";
  if (time && std::isfinite(*time))
    xml += fmt::format(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{}</DataArray>\n</FieldData>\n",
        *time);
  return xml + field_data;
}

template <class Real>
std::string announce_points(Inline& numbers, std::span<const Vec3<Real>> points) {
  return "<Points>\n" +
         numbers.announce(std::is_same_v<Real, double> ? "Float64" : "Float32", "Points", 3, points.size_bytes(),
                          [points](Base64Text& file) { file.write(points.data(), points.size_bytes()); }) +
         "</Points>\n";
}

/// Throws where an array has not one tuple per point.
void check_array(const std::filesystem::path& path, const std::string& name, std::size_t values, int components,
                 std::size_t points) {
  if (components < 1 || values != points * std::size_t(components))
    throw Error(
        fmt::format("cannot write {}", path.string()),
        fmt::format("array \"{}\" has {} values in tuples of {} for {} points", name, values, components, points));
}

template <class Real>
void write(const std::filesystem::path& path, std::span<const Vec3<Real>> points, std::span<const Triangle> triangles,
           std::span<const PointArray> arrays, std::optional<double> time, std::span<const CellNumbers> cells,
           const std::string& field_data, std::span<const PointPositions> positions,
           const std::function<void()>& before_it_appears) {
  for (const PointArray& array : arrays)
    check_array(path, array.name, array.values.size(), array.components, points.size());
  for (const PointPositions& each : positions) check_array(path, each.name, 3 * each.values.size(), 3, points.size());
  Inline numbers;
  std::string xml = poly_data_start(time, field_data);
  xml += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      points.size(), triangles.empty() ? points.size() : 0, triangles.size());
  xml += announce_arrays(numbers, arrays, positions) + announce_cell_data(numbers, triangles.size(), cells);
  xml += announce_points(numbers, points);
  xml += announce_cells(numbers, points.size(), triangles) + "</Piece>\n</PolyData>\n</VTKFile>\n";

  OutputFile file(path);
  numbers.write(file, xml);
  if (before_it_appears) before_it_appears();
  file.commit();
}

}  // namespace

void write_vtp(const std::filesystem::path& file, std::span<const Vec3d> points, std::span<const Triangle> triangles,
               std::span<const PointArray> arrays, std::optional<double> time, std::span<const CellNumbers> cells,
               const std::string& field_data, std::span<const PointPositions> positions,
               const std::function<void()>& before_it_appears) {
  write<double>(file, points, triangles, arrays, time, cells, field_data, positions, before_it_appears);
}

void write_vtp(const std::filesystem::path& file, std::span<const Vec3f> points, std::span<const Triangle> triangles,
               std::span<const PointArray> arrays, std::optional<double> time) {
  write<float>(file, points, triangles, arrays, time, {}, "", {}, {});
}

void write_pvtp(const std::filesystem::path& path, std::span<const std::string> pieces,
                std::span<const PointArray> arrays, std::span<const std::string> positions,
                const std::string& comment) {
  const auto entry = [](const char* type, const std::string& name, int components) {
    return fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", type, xml_escaped(name),
                       components);
  };
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n" +
      comment + "<PPolyData GhostLevel=\"0\">\n<PPointData>\n";
  for (const PointArray& array : arrays) xml += entry("Float32", array.name, array.components);
  for (const std::string& name : positions) xml += entry("Float64", name, 3);
  xml += "</PPointData>\n<PPoints>\n" + entry("Float64", "Points", 3) + "</PPoints>\n";
  for (const std::string& piece : pieces) xml += "<Piece Source=\"" + xml_escaped(piece) + "\"/>\n";
  OutputFile file(path);
  file.write(xml + "</PPolyData>\n</VTKFile>\n");
  file.commit();
}

void write_vtp_lines(const std::filesystem::path& path, std::span<const Vec3d> points, std::size_t vertices,
                     std::span<const std::uint64_t> line_starts, std::span<const PointArray> arrays,
                     std::optional<double> time, const std::string& field_data) {
  const std::size_t lines = line_starts.empty() ? 0 : line_starts.size() - 1;
  const std::uint64_t first = lines > 0 ? line_starts.front() : points.size();
  if (vertices > first || (lines > 0 && line_starts.back() != points.size()))
    throw Error(fmt::format("cannot write {}", path.string()), "the lines do not fit the points");
  for (const PointArray& array : arrays)
    check_array(path, array.name, array.values.size(), array.components, points.size());
  Inline numbers;
  std::string xml = poly_data_start(time, field_data);
  xml += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      points.size(), vertices, lines);
  xml += announce_arrays(numbers, arrays, {}) + announce_points(numbers, points);
  const auto from_first = [first](std::uint64_t i) { return first + i; };
  const auto end = [line_starts, first](std::uint64_t i) { return line_starts[i + 1] - first; };
  xml += "<Verts>\n" +
         announce_indices(numbers, "connectivity", vertices, points.size(), [](std::uint64_t i) { return i; }) +
         announce_indices(numbers, "offsets", vertices, points.size(), [](std::uint64_t i) { return i + 1; }) +
         "</Verts>\n<Lines>\n" +
         announce_indices(numbers, "connectivity", points.size() - first, points.size(), from_first) +
         announce_indices(numbers, "offsets", lines, points.size(), end) +
         "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  OutputFile file(path);
  numbers.write(file, xml);
  file.commit();
}

}  // namespace nacre
