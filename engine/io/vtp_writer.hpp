// Nacre: writes surfaces, point clouds and polylines as VTK PolyData (.vtp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "compute/math/vec.hpp"
#include "engine/io/vtk_inline.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// A position per point, in the precision of the points themselves.
struct PointPositions {
  std::string name;
  std::span<const Vec3d> values;
};

/// Writes `points`, `triangles` (empty: every point becomes a vertex cell) and `arrays` (one tuple per point each) as
/// VTK XML PolyData: little-endian numbers in base64, 64-bit headers, no compression; coordinates keep their type.
/// `time` becomes the field array TimeValue, or `field_data` is a complete <FieldData> element; `cells` are arrays on
/// the triangles, `positions` more arrays on the points. `before_it_appears` is called when all is
/// written. Data are written directly, never through a second copy. Throws Error if the file cannot be written, or if
/// the length of an array is not that of the points.
void write_vtp(const std::filesystem::path& file, std::span<const Vec3d> points, std::span<const Triangle> triangles,
               std::span<const PointArray> arrays, std::optional<double> time = std::nullopt,
               std::span<const CellNumbers> cells = {}, const std::string& field_data = "",
               std::span<const PointPositions> positions = {}, const std::function<void()>& before_it_appears = {});
void write_vtp(const std::filesystem::path& file, std::span<const Vec3f> points, std::span<const Triangle> triangles,
               std::span<const PointArray> arrays, std::optional<double> time = std::nullopt);

/// Writes the .pvtp of `pieces`, names of files beside it that `write_vtp` has written with such arrays and positions;
/// of those only names and components count. `comment`: an XML comment, or nothing.
void write_pvtp(const std::filesystem::path& file, std::span<const std::string> pieces,
                std::span<const PointArray> arrays, std::span<const std::string> positions,
                const std::string& comment = "");

/// Writes `points`, of which the first `vertices` become a vertex cell each; `line_starts`: for each polyline the
/// number of its first point, ascending, and how many points there are (empty: no lines). The rest is as for
/// `write_vtp`. Throws Error as that does, or where the lines do not fit the points.
void write_vtp_lines(const std::filesystem::path& file, std::span<const Vec3d> points, std::size_t vertices,
                     std::span<const std::uint64_t> line_starts, std::span<const PointArray> arrays,
                     std::optional<double> time = std::nullopt, const std::string& field_data = "");

}  // namespace nacre
