// Nacre: surfaces and point clouds written as VTK PolyData (.vtp).
#include "engine/io/vtp_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

static_assert(std::endian::native == std::endian::little, "appended data are written as they are in memory");
static_assert(sizeof(Vec3f) == 12 && sizeof(Vec3d) == 24 && sizeof(Triangle) == 12);

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) < 32)
      out += ' ';
    else
      out += c;
  }
  return out;
}

/// The blocks behind the XML: each is announced first, which gives it its offset, and written afterwards.
class Appended {
 public:
  /// The XML element of a block of `bytes` that `write` will put into the file.
  std::string announce(const std::string& type, const std::string& name, int components, std::uint64_t bytes,
                       std::function<void(OutputFile&)> write) {
    const std::string element = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
        xml_escaped(name), components, offset_);
    offset_ += sizeof(std::uint64_t) + bytes;
    blocks_.push_back({bytes, std::move(write)});
    return element;
  }

  void write(OutputFile& file) const {
    file.write("<AppendedData encoding=\"raw\">\n_");
    for (const Block& block : blocks_) {
      file.write(&block.bytes, sizeof block.bytes);
      block.write(file);
    }
    file.write("\n</AppendedData>\n");
  }

 private:
  struct Block {
    std::uint64_t bytes;
    std::function<void(OutputFile&)> write;
  };
  std::vector<Block> blocks_;
  std::uint64_t offset_ = 0;
};

/// Writes value(0), value(1), ... value(count - 1) by way of a small buffer.
template <class Index, class Value>
void write_generated(OutputFile& file, std::uint64_t count, const Value& value) {
  std::vector<Index> buffer(std::min<std::uint64_t>(count, 1 << 16));
  for (std::uint64_t begin = 0; begin < count; begin += buffer.size()) {
    const std::uint64_t n = std::min<std::uint64_t>(buffer.size(), count - begin);
    for (std::uint64_t i = 0; i < n; ++i) buffer[i] = Index(value(begin + i));
    file.write(buffer.data(), n * sizeof(Index));
  }
}

/// One DataArray of `count` indices, 32-bit where `largest` allows it.
template <class Value>
std::string announce_indices(Appended& appended, const char* name, std::uint64_t count, std::uint64_t largest,
                             Value value) {
  if (largest <= std::uint64_t(std::numeric_limits<std::int32_t>::max()))
    return appended.announce("Int32", name, 1, 4 * count,
                             [=](OutputFile& file) { write_generated<std::int32_t>(file, count, value); });
  return appended.announce("Int64", name, 1, 8 * count,
                           [=](OutputFile& file) { write_generated<std::int64_t>(file, count, value); });
}

std::string announce_cells(Appended& appended, std::uint64_t points, std::span<const Triangle> triangles) {
  const auto self = [](std::uint64_t i) { return i; };
  const auto after = [](std::uint64_t i) { return i + 1; };
  if (triangles.empty())
    return "<Verts>\n" + announce_indices(appended, "connectivity", points, points, self) +
           announce_indices(appended, "offsets", points, points, after) + "</Verts>\n";
  const std::string corners =
      appended.announce("UInt32", "connectivity", 1, triangles.size_bytes(),
                        [triangles](OutputFile& file) { file.write(triangles.data(), triangles.size_bytes()); });
  const auto end = [](std::uint64_t i) { return 3 * i + 3; };
  return "<Polys>\n" + corners + announce_indices(appended, "offsets", triangles.size(), 3 * triangles.size(), end) +
         "</Polys>\n";
}

std::string announce_arrays(Appended& appended, std::span<const PointArray> arrays) {
  std::string xml = "<PointData>\n";
  for (const PointArray& array : arrays)
    xml += appended.announce(
        "Float32", array.name, array.components, array.values.size() * sizeof(float),
        [&array](OutputFile& file) { file.write(array.values.data(), array.values.size() * sizeof(float)); });
  return xml + "</PointData>\n";
}

template <class Real>
void write(const std::filesystem::path& path, std::span<const Vec3<Real>> points, std::span<const Triangle> triangles,
           std::span<const PointArray> arrays, std::optional<double> time) {
  for (const PointArray& array : arrays)
    if (array.components < 1 || array.values.size() != points.size() * std::size_t(array.components))
      throw Error(fmt::format("cannot write {}", path.string()),
                  fmt::format("array \"{}\" has {} values in tuples of {} for {} points", array.name,
                              array.values.size(), array.components, points.size()));
  Appended appended;
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n";
  if (time && std::isfinite(*time))
    xml += fmt::format(
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{}</DataArray>\n</FieldData>\n",
        *time);
  xml += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      points.size(), triangles.empty() ? points.size() : 0, triangles.size());
  xml += announce_arrays(appended, arrays);
  xml += "<Points>\n" +
         appended.announce(std::is_same_v<Real, double> ? "Float64" : "Float32", "Points", 3, points.size_bytes(),
                           [points](OutputFile& file) { file.write(points.data(), points.size_bytes()); }) +
         "</Points>\n";
  xml += announce_cells(appended, points.size(), triangles) + "</Piece>\n</PolyData>\n";

  OutputFile file(path);
  file.write(xml);
  appended.write(file);
  file.write("</VTKFile>\n");
  file.commit();
}

}  // namespace

void write_vtp(const std::filesystem::path& file, std::span<const Vec3d> points, std::span<const Triangle> triangles,
               std::span<const PointArray> arrays, std::optional<double> time) {
  write<double>(file, points, triangles, arrays, time);
}

void write_vtp(const std::filesystem::path& file, std::span<const Vec3f> points, std::span<const Triangle> triangles,
               std::span<const PointArray> arrays, std::optional<double> time) {
  write<float>(file, points, triangles, arrays, time);
}

}  // namespace nacre
