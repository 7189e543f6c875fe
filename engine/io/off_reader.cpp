// Nacre: OFF and its variants COFF, NOFF, STOFF: points and polygons as text.
#include <fmt/format.h>

#include <cctype>

#include "engine/io/file_bytes.hpp"
#include "engine/io/readers.hpp"
#include "engine/io/text_cursor.hpp"

namespace nacre {
namespace {

struct Counts {
  std::int64_t points = 0, faces = 0;
};

/// Reads the format name, which may be missing, separate, or joined to the first count ("OFF8 6 12"), and the counts.
Counts read_header(TextCursor& text, const std::filesystem::path& path) {
  TextCursor probe = text;
  const std::string_view magic = probe.word();
  const std::size_t at = magic.find("OFF");
  std::int64_t points = -1, faces = -1;
  if (at == magic.npos) {
    if (magic.empty() || !std::isdigit(static_cast<unsigned char>(magic[0])))
      fail_reading(path, "it does not begin with OFF", "check that it is an OFF file");
  } else {
    if (magic.substr(0, at).find_first_of("4n") != magic.npos)
      fail_reading(path, fmt::format("{} has points that are not three-dimensional", magic), "convert it to plain OFF");
    text.word();
    const std::string_view glued = magic.substr(at + 3);
    const char* end = glued.data() + glued.size();
    const auto [last, code] = std::from_chars(glued.data(), end, points);
    if (!glued.empty() && (code != std::errc{} || last != end))
      fail_reading(path, fmt::format("'{}' is not an OFF header", magic), "check that it is an OFF file");
    probe = text;
    if (probe.word() == "BINARY") fail_reading(path, "it is binary OFF", "convert it to text OFF");
  }
  if ((points < 0 && !text.integer(points)) || !text.integer(faces) || points < 0 || faces < 0)
    fail_reading(path, "its header lacks the numbers of points and faces");
  text.rest_of_line();
  // A point needs at least "0 0 0", a face "0", each with a separator.
  const std::size_t size = text.remaining();
  if (std::size_t(points) > size / 6 + 1 || std::size_t(faces) > size / 2 + 1)
    fail_reading(path,
                 fmt::format("its header promises {} points and {} faces, more than the file can hold", points, faces));
  return {points, faces};
}

}  // namespace

RawMesh read_off(std::string bytes, const std::filesystem::path& path) {
  TextCursor text(bytes, '#');
  const Counts counts = read_header(text, path);
  RawMesh mesh;
  mesh.points.resize(std::size_t(counts.points));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    Vec3d& p = mesh.points[i];
    if (!text.number(p.x) || !text.number(p.y) || !text.number(p.z))
      fail_reading(path,
                   fmt::format("point {} of {} is not three numbers, line {}", i + 1, counts.points, text.line()));
    text.rest_of_line();  // normals, colours, texture coordinates
  }
  mesh.offsets.reserve(std::size_t(counts.faces) + 1);
  for (std::int64_t face = 0; face < counts.faces; ++face) {
    std::int64_t corners = 0;
    bool good = text.integer(corners) && corners >= 0 && std::size_t(corners) <= text.remaining() / 2 + 1;
    for (std::int64_t k = 0; good && k < corners; ++k) {
      std::int64_t point = 0;
      good = text.integer(point);
      mesh.add_corner(point);
    }
    if (!good)
      fail_reading(path, fmt::format("face {} of {} is damaged, line {}", face + 1, counts.faces, text.line()));
    mesh.close_polygon();
    text.rest_of_line();  // colours
  }
  if (!text.at_end())
    mesh.warnings.push_back(fmt::format("What follows its {} points and {} faces is ignored, from line {} on.",
                                        counts.points, counts.faces, text.line()));
  return mesh;
}

}  // namespace nacre
