// Nacre: finds formats by extension, or by the first bytes if the extension does not help.
#include "engine/io/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cctype>

#include "compute/device/error.hpp"
#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/readers.hpp"
#include "engine/io/volume_reader.hpp"

namespace nacre {
namespace {

bool is_binary_stl(const std::string& bytes) {
  if (bytes.size() < 134) return false;
  return 84 + 50 * std::size_t(load_number<std::uint32_t>(bytes.data() + 80, std::endian::little)) == bytes.size();
}

bool looks_like_obj(std::string_view head) {
  for (std::size_t at = 0; at < head.size(); at = std::min(head.find('\n', at), head.size() - 1) + 1)
    if (head.compare(at, 2, "v ") == 0) return true;
  return false;
}

}  // namespace

const std::vector<SurfaceFormat>& surface_formats() {
  static const std::vector<SurfaceFormat> formats = {
      {"OBJ", {"obj"}, read_obj},     {"PLY", {"ply"}, read_ply},
      {"STL", {"stl"}, read_stl},     {"OFF", {"off"}, read_off},
      {"GIFTI", {"gii"}, read_gifti}, {"VTK XML", {"vtp", "vtu", "vti", "pvtp", "pvtu", "pvd"}, read_vtk_xml},
  };
  return formats;
}

const SurfaceFormat* find_format(const std::string& extension) {
  for (const SurfaceFormat& format : surface_formats())
    if (std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end())
      return &format;
  return nullptr;
}

const SurfaceFormat* sniff_format(const std::string& bytes) {
  const std::string_view head = std::string_view(bytes).substr(0, 4096);
  const std::size_t first = std::min(head.find_first_not_of(" \t\r\n"), head.size());
  const std::string_view text = head.substr(first);
  const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
  if (word == "ply") return find_format("ply");
  if (head.find("<GIFTI") != head.npos) return find_format("gii");
  if (head.find("<VTKFile") != head.npos) return find_format("vtp");
  if (is_binary_stl(bytes)) return find_format("stl");
  if (word.size() <= 6 && word.ends_with("OFF")) return find_format("off");
  if (word == "solid" && (text.find("facet") != text.npos || text.find("endsolid") != text.npos))
    return find_format("stl");
  if (looks_like_obj(head)) return find_format("obj");
  return nullptr;
}

std::string mismatch_advice(const std::string& bytes, const SurfaceFormat& format) {
  const SurfaceFormat* looks = sniff_format(bytes);
  if (!looks || looks == &format) return {};
  return fmt::format("its name says {}, its content looks like {}: rename it to .{}", format.name, looks->name,
                     looks->extensions[0]);
}

RawFile read_raw(const std::filesystem::path& path) { return read_raw(read_file(path), path); }

RawFile read_raw(std::string bytes, const std::filesystem::path& path) {
  const SurfaceFormat* format = find_format(format_extension(path));
  if (!format) {
    format = sniff_format(bytes);
    if (!format && is_volume_file(path))
      throw Error(path.string() + " is a volume and has no surface", "", "open a surface for flow");
    if (!format)
      fail_reading(path, "neither its name nor its content is of a known format",
                   fmt::format("known are .{}, and as volumes {}", fmt::join(own_extensions(), " ."),
                               fmt::join(volume_extensions(), " ")));
    return {format, format->read(std::move(bytes), path)};
  }
  const std::string mismatch = mismatch_advice(bytes, *format);
  if (mismatch.empty()) return {format, format->read(std::move(bytes), path)};
  try {
    RawFile file{format, format->read(std::move(bytes), path)};
    if (file.mesh.polygons() > 0 || file.mesh.lines > 0 || !file.mesh.points.empty()) return file;
  } catch (const Error&) {
    // The mismatch of content and extension is the cause, and says more than the reader's message.
  }
  fail_reading(path, fmt::format("it is not {}", format->name), mismatch);
}

std::vector<std::string> own_extensions() {
  std::vector<std::string> extensions;
  for (const SurfaceFormat& format : surface_formats())
    extensions.insert(extensions.end(), format.extensions.begin(), format.extensions.end());
  std::sort(extensions.begin(), extensions.end());
  return extensions;
}

}  // namespace nacre
