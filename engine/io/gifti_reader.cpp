// Nacre: reads GIFTI (.gii): surfaces of the brain, and the shapes and vectors on their points.
#include <fmt/format.h>
#include <zlib.h>

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>

#include "engine/io/build_surface.hpp"
#include "engine/io/byte_order.hpp"
#include "engine/io/byte_stream.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/readers.hpp"
#include "engine/io/text_cursor.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// One <DataArray>, its numbers in rows.
struct GiftiArray {
  std::string intent;  ///< without NIFTI_INTENT_
  std::string name;    ///< from its metadata; may be empty
  std::size_t rows = 0, columns = 1;
  std::vector<double> values;
};

std::string attribute_of(pugi::xml_node node, const char* name) { return node.attribute(name).value(); }

/// Rows and columns as the attributes say.
void read_gifti_size(pugi::xml_node node, GiftiArray& array, const fs::path& path) {
  std::int64_t dimensions = 0;
  const auto count = [&](const std::string& name) {
    const std::string text = attribute_of(node, name.c_str());
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > std::int64_t(1) << 40)
      fail_reading(path, fmt::format("{} of an array is '{}'", name, text.substr(0, 40)));
    return value;
  };
  dimensions = count("Dimensionality");
  if (dimensions < 1 || dimensions > 6) fail_reading(path, fmt::format("an array has {} dimensions", dimensions));
  array.rows = std::size_t(count("Dim0"));
  for (std::int64_t d = 1; d < dimensions; ++d) {
    array.columns *= std::size_t(count(fmt::format("Dim{}", d)));
    if (array.columns > 1000000) fail_reading(path, fmt::format("an array has {} columns", array.columns));
  }
  if (array.rows * array.columns > std::size_t(1) << 40) fail_reading(path, "an array has too many values");
}

std::string inflated(const std::string& packed, std::size_t needed, const fs::path& path) {
  if (needed > packed.size() * zlib_ratio + 64) fail_reading(path, "an array is cut short");
  std::string bytes(needed, '\0');
  uLongf size = uLongf(needed);
  const int state = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                               reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size()));
  if ((state != Z_OK && needed > 0) || size != needed) fail_reading(path, "the packed data of an array are damaged");
  return bytes;
}

/// The bytes of `needed` in any binary encoding.
std::string gifti_bytes(pugi::xml_node node, std::size_t needed, const fs::path& path) {
  const std::string encoding = attribute_of(node, "Encoding");
  const bool packed = encoding == "GZipBase64Binary";
  if (encoding == "ExternalFileBinary")
    fail_reading(path, "its values are in another file", "convert it with `wb_command -gifti-convert`");
  if (!packed && encoding != "Base64Binary") fail_reading(path, fmt::format("its encoding is '{}'", encoding));
  ByteStream stream(node.child_value("Data"), true);
  if (packed) return inflated(stream.rest(), needed, path);
  if (needed > stream.at_most()) fail_reading(path, "an array is cut short");
  std::string bytes(needed, '\0');
  if (!stream.read(bytes.data(), needed)) fail_reading(path, "an array is cut short, or is not base64");
  if (char more = 0; stream.read(&more, 1)) fail_reading(path, "an array has more values than its size says");
  return bytes;
}

template <class T>
void load_gifti_values(const std::string& bytes, std::endian order, std::vector<double>& values) {
  for (std::size_t i = 0; i < bytes.size() / sizeof(T); ++i)
    values.push_back(double(load_number<T>(bytes.data() + i * sizeof(T), order)));
}

void read_gifti_values(pugi::xml_node node, GiftiArray& array, const fs::path& path) {
  const std::size_t count = array.rows * array.columns;
  if (attribute_of(node, "Encoding") == "ASCII") {
    const std::string_view text = node.child_value("Data");
    if (count > text.size()) fail_reading(path, "an array is cut short");
    TextCursor cursor(text);
    for (double value = 0; array.values.size() < count;) {
      if (!cursor.number(value)) fail_reading(path, "an array is cut short, or has a word that is not a number");
      array.values.push_back(value);
    }
    if (!cursor.at_end()) fail_reading(path, "an array has more values than its size says");
    return;
  }
  const std::string type = attribute_of(node, "DataType");
  const std::size_t size = type == "NIFTI_TYPE_UINT8" ? 1 : type == "NIFTI_TYPE_FLOAT64" ? 8 : 4;
  const std::string bytes = gifti_bytes(node, count * size, path);
  const std::string endian = attribute_of(node, "Endian");
  const bool ordered = type == "NIFTI_TYPE_FLOAT32" || type == "NIFTI_TYPE_INT32" || type == "NIFTI_TYPE_UINT32" ||
                       type == "NIFTI_TYPE_FLOAT64";
  if (endian != "BigEndian" && endian != "LittleEndian" && ordered)
    fail_reading(path, fmt::format("the Endian of an array is '{}'", endian.substr(0, 40)));
  const std::endian order = endian == "BigEndian" ? std::endian::big : std::endian::little;
  array.values.reserve(count);
  if (type == "NIFTI_TYPE_FLOAT32") return load_gifti_values<float>(bytes, order, array.values);
  if (type == "NIFTI_TYPE_INT32") return load_gifti_values<std::int32_t>(bytes, order, array.values);
  if (type == "NIFTI_TYPE_UINT32") return load_gifti_values<std::uint32_t>(bytes, order, array.values);
  if (type == "NIFTI_TYPE_UINT8") return load_gifti_values<std::uint8_t>(bytes, order, array.values);
  if (type == "NIFTI_TYPE_FLOAT64") return load_gifti_values<double>(bytes, order, array.values);
  fail_reading(path, fmt::format("an array is of type '{}', not plain numbers", type.substr(0, 40)));
}

/// Values by column instead of by row are put into rows.
void put_into_rows(GiftiArray& array) {
  std::vector<double> values(array.values.size());
  for (std::size_t row = 0; row < array.rows; ++row)
    for (std::size_t column = 0; column < array.columns; ++column)
      values[row * array.columns + column] = array.values[column * array.rows + row];
  array.values = std::move(values);
}

GiftiArray read_gifti_array(pugi::xml_node node, const fs::path& path) {
  GiftiArray array;
  array.intent = attribute_of(node, "Intent");
  if (array.intent.starts_with("NIFTI_INTENT_")) array.intent.erase(0, 13);
  for (const pugi::xml_node entry : node.child("MetaData").children("MD"))
    if (std::string_view(entry.child_value("Name")) == "Name") array.name = entry.child_value("Value");
  read_gifti_size(node, array, path);
  read_gifti_values(node, array, path);
  if (array.columns > 1 && attribute_of(node, "ArrayIndexingOrder") == "ColumnMajorOrder") put_into_rows(array);
  return array;
}

void add_gifti_triangles(RawMesh& mesh, const GiftiArray& array, const fs::path& path) {
  if (array.columns != 3)
    fail_reading(path, fmt::format("its triangles have {} corners", array.columns), "check how it was written");
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    const double corner = array.values[i];
    mesh.add_corner(corner >= 0 && corner < 4e9 && corner == std::floor(corner) ? std::int64_t(corner) : -1);
    if (i % 3 == 2) mesh.close_polygon();
  }
}

/// Names that differ: "shape", or "time_series_0", "time_series_1", ... where several arrays have one name.
void name_arrays(std::vector<RawArray>& arrays) {
  std::map<std::string, std::size_t> times, numbered;
  for (const RawArray& array : arrays) ++times[array.name];
  for (RawArray& array : arrays)
    if (const std::string name = array.name; times[name] > 1) array.name = fmt::format("{}_{}", name, numbered[name]++);
}

}  // namespace

RawMesh read_gifti(std::string bytes, const fs::path& path) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(bytes.data(), bytes.size());
  if (!parsed) fail_reading(path, fmt::format("its XML is damaged: {}", parsed.description()));
  const pugi::xml_node root = document.child("GIFTI");
  if (!root) fail_reading(path, "it is not GIFTI");
  RawMesh mesh;
  std::optional<std::size_t> points;
  std::vector<RawArray> arrays;
  for (const pugi::xml_node node : root.children("DataArray")) {
    GiftiArray array = read_gifti_array(node, path);
    if (array.intent == "POINTSET") {
      if (array.columns != 3) fail_reading(path, fmt::format("its points have {} coordinates", array.columns));
      if (points) fail_reading(path, "it has several sets of points", "write one surface to each file");
      points = array.rows;
      for (std::size_t i = 0; i < array.rows; ++i)
        mesh.points.emplace_back(array.values[3 * i], array.values[3 * i + 1], array.values[3 * i + 2]);
    } else if (array.intent == "TRIANGLE") {
      add_gifti_triangles(mesh, array, path);
    } else {
      std::string name = array.name;
      if (name.empty())
        for (const char c : array.intent) name += char(std::tolower(static_cast<unsigned char>(c)));
      if (array.columns > 0) arrays.push_back({name, int(array.columns), {array.values.begin(), array.values.end()}});
    }
  }
  const std::string promised = attribute_of(root, "NumberOfDataArrays");
  const auto found = std::distance(root.children("DataArray").begin(), root.children("DataArray").end());
  if (!promised.empty() && promised != std::to_string(found))
    mesh.warnings.push_back(fmt::format("It says that it has {} arrays, and has {}.", promised.substr(0, 20), found));
  name_arrays(arrays);
  for (RawArray& array : arrays) {
    if (!points)
      mesh.field_arrays.push_back(std::move(array));
    else if (array.items() == *points)
      mesh.point_arrays.push_back(std::move(array));
    else
      mesh.warnings.push_back(fmt::format("{}: array \"{}\" has {} values for {} points; it is left out.",
                                          path.string(), array.name, with_commas(array.items()), with_commas(*points)));
  }
  return mesh;
}

}  // namespace nacre
