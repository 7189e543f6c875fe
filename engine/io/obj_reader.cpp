// Nacre: Wavefront OBJ: points and faces, parsed by tinyobjloader, which is compiled here for double precision: its
// packaged library stores coordinates as float.
#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <charconv>
#include <cstdint>
#include <limits>
#include <sstream>

#include "engine/io/file_bytes.hpp"
#include "engine/io/readers.hpp"

namespace nacre {
namespace {

/// The input of tinyobjloader, and what it would not report.
struct Prepared {
  std::string text;                     ///< the lines of points and faces, without comments
  std::vector<std::size_t> bad_points;  ///< points whose coordinates are not plain numbers, which it would read as 0
  std::size_t points = 0;
  std::size_t lines = 0;
};

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// A decimal number with an exponent of at most three digits, and nothing behind it.
bool is_plain_number(std::string_view word) {
  if (word.find_first_not_of("0123456789+-.eE") != word.npos) return false;
  if (const std::size_t exponent = word.find_first_of("eE"); exponent != word.npos && word.size() - exponent > 5)
    return false;
  double value = 0;
  const char* first = word.data() + word.starts_with('+');
  const auto [end, code] = std::from_chars(first, word.data() + word.size(), value);
  return code != std::errc::invalid_argument && end == word.data() + word.size();
}

/// Whether the corner "12", "12/3/4" or "-1//2" begins with an index that tinyobjloader reads as it is: it cuts larger
/// ones to 32 bits and drops what follows the digits, so that another point would be taken.
bool has_plain_index(std::string_view corner) {
  const std::string_view index = corner.substr(0, corner.find('/'));
  std::int32_t value = 0;
  const char* first = index.data() + index.starts_with('+');
  const auto [end, code] = std::from_chars(first, index.data() + index.size(), value);
  return code == std::errc{} && end == index.data() + index.size();
}

bool has_three_numbers(std::string_view line) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == line.npos) return false;
    const std::size_t last = std::min(line.find_first_of(" \t", first), line.size());
    if (!is_plain_number(line.substr(first, last - first))) return false;
    line.remove_prefix(last);
  }
  return true;
}

/// The line without its comment; "1.#INF" does not start a comment.
std::string_view without_comment(std::string_view line) {
  for (std::size_t hash = line.find('#'); hash != line.npos; hash = line.find('#', hash + 1))
    if (hash == 0 || is_blank(line[hash - 1])) return line.substr(0, hash);
  return line;
}

/// The corners of a face; "0", which is no point, in the place of those that are no index.
void add_corners(std::string& text, std::string_view corners) {
  for (std::size_t at = corners.find_first_not_of(" \t"); at != corners.npos;) {
    const std::size_t end = std::min(corners.find_first_of(" \t", at), corners.size());
    const std::string_view corner = corners.substr(at, end - at);
    (text += ' ') += has_plain_index(corner) ? corner : "0";
    at = corners.find_first_not_of(" \t", end);
  }
}

void add_line(Prepared& prepared, std::string_view line) {
  line = without_comment(line);
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == line.npos || first + 1 >= line.size() || !is_blank(line[first + 1])) return;
  line.remove_prefix(first);
  if (line[0] == 'l') ++prepared.lines;
  if (line[0] != 'v' && line[0] != 'f') return;
  if (line[0] == 'v' && !has_three_numbers(line.substr(1))) prepared.bad_points.push_back(prepared.points);
  prepared.points += line[0] == 'v';
  if (line[0] == 'f') {
    prepared.text += 'f';
    add_corners(prepared.text, line.substr(1));
  } else {
    prepared.text += line;
  }
  prepared.text += '\n';
}

Prepared prepare(const std::string& bytes) {
  Prepared prepared;
  prepared.text.reserve(bytes.size());
  std::string joined;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find_first_of("\r\n", at), bytes.size());
    std::string_view line(bytes.data() + at, end - at);
    at = end + 1 + (end + 1 < bytes.size() && bytes[end] == '\r' && bytes[end + 1] == '\n');
    if (line.ends_with('\\')) {
      joined.append(line.substr(0, line.size() - 1)) += ' ';
    } else if (joined.empty()) {
      add_line(prepared, line);
    } else {
      add_line(prepared, joined.append(line));
      joined.clear();
    }
  }
  if (!joined.empty()) add_line(prepared, joined);
  return prepared;
}

void on_vertex(void* user, double x, double y, double z, double) {
  static_cast<RawMesh*>(user)->points.push_back({x, y, z});
}

void on_face(void* user, tinyobj::index_t* corners, int count) {
  RawMesh& mesh = *static_cast<RawMesh*>(user);
  const auto points = std::int64_t(mesh.points.size());
  for (int i = 0; i < count; ++i) {
    // Indices count from 1, or backwards from the last point so far; 0 is not an index.
    const std::int64_t index = corners[i].vertex_index;
    mesh.add_corner(index > 0 ? index - 1 : index < 0 ? points + index : -1);
  }
  mesh.close_polygon();
}

}  // namespace

RawMesh read_obj(std::string bytes, const std::filesystem::path& path) {
  Prepared prepared = prepare(bytes);
  bytes = {};
  RawMesh mesh;
  mesh.lines = prepared.lines;
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = on_vertex;
  callbacks.index_cb = on_face;
  std::istringstream stream(std::move(prepared.text));
  std::string warning, error;
  if (!tinyobj::LoadObjWithCallback(stream, callbacks, &mesh, nullptr, &warning, &error)) fail_reading(path, error);
  for (const std::size_t bad : prepared.bad_points)
    if (bad < mesh.points.size()) mesh.points[bad] = Vec3d(std::numeric_limits<double>::quiet_NaN());
  return mesh;
}

}  // namespace nacre
