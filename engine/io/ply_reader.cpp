// Nacre: PLY, text and binary: points, faces, strips, and every real property as an array.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/ply_header.hpp"
#include "engine/io/readers.hpp"
#include "engine/io/text_cursor.hpp"

namespace nacre {
namespace {

/// One row of an element: a number per plain property, a list per list property.
struct PlyRow {
  std::vector<double> numbers;
  std::vector<std::vector<std::int64_t>> lists;
};

/// The numbers behind the header one after the other, whatever the encoding.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, const PlyHeader& header)
      : ascii_(header.encoding == PlyHeader::Encoding::ascii),
        order_(header.encoding == PlyHeader::Encoding::big ? std::endian::big : std::endian::little),
        at_(bytes.data() + header.body),
        end_(bytes.data() + bytes.size()),
        text_(bytes.substr(header.body)) {}

  /// False where the data end or are no number.
  bool read(PlyType type, double& value) {
    if (ascii_) return text_.number(value);
    const std::size_t size = ply_size(type);
    if (std::size_t(end_ - at_) < size) return false;
    value = load(type);
    at_ += size;
    return true;
  }

  /// No more items of at least `bytes` bytes (or one digit and a space) can follow.
  std::size_t room_for(std::size_t bytes, std::size_t numbers) const {
    return ascii_ ? text_.remaining() / (2 * std::max<std::size_t>(numbers, 1)) + 1
                  : std::size_t(end_ - at_) / std::max<std::size_t>(bytes, 1);
  }

  /// Whether anything but white space follows.
  bool has_more() {
    return ascii_ ? !text_.at_end()
                  : std::string_view(at_, end_).find_first_not_of(" \t\r\n") != std::string_view::npos;
  }

 private:
  double load(PlyType type) const {
    switch (type) {
      case PlyType::int8: return load_number<std::int8_t>(at_, order_);
      case PlyType::uint8: return load_number<std::uint8_t>(at_, order_);
      case PlyType::int16: return load_number<std::int16_t>(at_, order_);
      case PlyType::uint16: return load_number<std::uint16_t>(at_, order_);
      case PlyType::int32: return load_number<std::int32_t>(at_, order_);
      case PlyType::uint32: return load_number<std::uint32_t>(at_, order_);
      case PlyType::float32: return load_number<float>(at_, order_);
      case PlyType::float64: return load_number<double>(at_, order_);
      case PlyType::none: break;
    }
    return 0;
  }

  bool ascii_;
  std::endian order_;
  const char* at_;
  const char* end_;
  TextCursor text_;
};

/// A list entry as an index; what is no whole number in range is no point.
std::int64_t as_index(double value) {
  return std::abs(value) < 4e9 && value == std::floor(value) ? std::int64_t(value) : -1;
}

bool read_row(PlyBody& body, const PlyElement& element, PlyRow& row) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (!property.is_list()) {
      if (!body.read(property.type, row.numbers[i])) return false;
      continue;
    }
    double length = 0;
    if (!body.read(property.count_type, length) || !(length >= 0 && length < 4e9) || length != std::floor(length))
      return false;
    if (std::size_t(length) > body.room_for(ply_size(property.type), 1)) return false;
    row.lists[i].resize(std::size_t(length));
    for (std::int64_t& entry : row.lists[i]) {
      double value = 0;
      if (!body.read(property.type, value)) return false;
      entry = as_index(value);
    }
  }
  return true;
}

/// Calls `use(row)` for every row of the element. Throws Error where the data end too early.
template <class Use>
void for_each_row(PlyBody& body, const PlyElement& element, const std::filesystem::path& path, Use use) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += ply_size(property.is_list() ? property.count_type : property.type);
  if (element.properties.empty()) return;
  if (element.count > body.room_for(bytes, element.properties.size()))
    fail_reading(path, fmt::format("its header promises {} of element '{}', more than the file can hold", element.count,
                                   element.name));
  PlyRow row{std::vector<double>(element.properties.size()),
             std::vector<std::vector<std::int64_t>>(element.properties.size())};
  for (std::size_t i = 0; i < element.count; ++i) {
    if (!read_row(body, element, row))
      fail_reading(path,
                   fmt::format("it ends or is damaged in element '{}', {} of {}", element.name, i + 1, element.count));
    use(row);
  }
}

/// Which properties of an element make one array.
struct ArrayPlan {
  std::string name;
  std::vector<int> properties;
};

/// "n" for (nx, ny, nz): the name that three properties share when they are a vector; empty if they are none.
std::string shared_name(const std::string& x, const std::string& y, const std::string& z) {
  if (x == "u" && y == "v" && z == "w") return "uvw";
  if (x == "nx" && y == "ny" && z == "nz") return "normals";
  if (x.size() < 2 || x.size() != y.size() || x.size() != z.size()) return {};
  const std::string stem = x.substr(0, x.size() - 1);
  if (y.substr(0, stem.size()) != stem || z.substr(0, stem.size()) != stem) return {};
  const std::string ends = {x.back(), y.back(), z.back()};
  if (ends != "xyz" && ends != "XYZ") return {};
  const std::size_t last = stem.find_last_not_of("_-. ");
  return last == stem.npos ? stem : stem.substr(0, last + 1);
}

/// One array per real property, or per three that are a vector; `taken` properties have another use.
std::vector<ArrayPlan> plan_arrays(const PlyElement& element, const std::vector<int>& taken) {
  std::vector<ArrayPlan> plans;
  const auto usable = [&](std::size_t i) {
    return i < element.properties.size() && !element.properties[i].is_list() &&
           ply_is_real(element.properties[i].type) && std::find(taken.begin(), taken.end(), int(i)) == taken.end();
  };
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (!usable(i)) continue;
    const auto name = [&](std::size_t k) { return element.properties[k].name; };
    const std::string vector =
        usable(i + 1) && usable(i + 2) ? shared_name(name(i), name(i + 1), name(i + 2)) : std::string{};
    if (vector.empty()) {
      plans.push_back({name(i), {int(i)}});
    } else {
      plans.push_back({vector, {int(i), int(i) + 1, int(i) + 2}});
      i += 2;
    }
  }
  return plans;
}

std::vector<RawArray> empty_arrays(const std::vector<ArrayPlan>& plans) {
  std::vector<RawArray> arrays;
  for (const ArrayPlan& plan : plans) arrays.push_back({plan.name, int(plan.properties.size()), {}});
  return arrays;
}

void add_values(std::vector<RawArray>& arrays, const std::vector<ArrayPlan>& plans, const PlyRow& row) {
  for (std::size_t i = 0; i < plans.size(); ++i)
    for (const int property : plans[i].properties) arrays[i].values.push_back(float(row.numbers[property]));
}

void read_vertices(PlyBody& body, const PlyElement& element, const std::filesystem::path& path, RawMesh& mesh) {
  const int x = element.find("x"), y = element.find("y"), z = element.find("z");
  for (const int axis : {x, y, z})
    if (axis < 0 || element.properties[axis].is_list())
      fail_reading(path, "its vertices have no properties x, y and z", "check how it was written");
  const auto plans = plan_arrays(element, {x, y, z});
  mesh.point_arrays = empty_arrays(plans);
  for_each_row(body, element, path, [&](const PlyRow& row) {
    mesh.points.push_back({row.numbers[x], row.numbers[y], row.numbers[z]});
    add_values(mesh.point_arrays, plans, row);
  });
}

int find_corner_list(const PlyElement& element) {
  for (const char* name : {"vertex_indices", "vertex_index"})
    if (const int found = element.find(name); found >= 0 && element.properties[found].is_list()) return found;
  return -1;
}

void read_faces(PlyBody& body, const PlyElement& element, const std::filesystem::path& path, RawMesh& mesh) {
  const int corners = find_corner_list(element);
  if (corners < 0) fail_reading(path, "its faces have no list of vertex indices", "check how it was written");
  const auto plans = plan_arrays(element, {corners});
  mesh.cell_arrays = empty_arrays(plans);
  for_each_row(body, element, path, [&](const PlyRow& row) {
    for (const std::int64_t corner : row.lists[corners]) mesh.add_corner(corner);
    mesh.close_polygon();
    add_values(mesh.cell_arrays, plans, row);
  });
}

/// Strips of triangles; -1 ends one and begins the next.
void read_strips(PlyBody& body, const PlyElement& element, const std::filesystem::path& path, RawMesh& mesh) {
  const int corners = find_corner_list(element);
  for_each_row(body, element, path, [&](const PlyRow& row) {
    if (corners < 0) return;
    std::vector<std::int64_t> strip;
    for (const std::int64_t corner : row.lists[corners]) {
      if (corner >= 0) {
        strip.push_back(corner);
        continue;
      }
      mesh.add_strip(strip);
      strip.clear();
    }
    mesh.add_strip(strip);
  });
}

}  // namespace

RawMesh read_ply(std::string bytes, const std::filesystem::path& path) {
  const PlyHeader header = read_ply_header(bytes, path);
  PlyBody body(bytes, header);
  RawMesh mesh;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex")
      read_vertices(body, element, path, mesh);
    else if (element.name == "face")
      read_faces(body, element, path, mesh);
    else if (element.name == "tristrips")
      read_strips(body, element, path, mesh);
    else
      for_each_row(body, element, path, [](const PlyRow&) {});
  }
  if (body.has_more()) mesh.warnings.push_back("What follows the elements of its header is ignored.");
  return mesh;
}

}  // namespace nacre
