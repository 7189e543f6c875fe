// Nacre: writes surfaces in the format of the file's extension.
#include "engine/io/surface_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <system_error>

#include "compute/device/error.hpp"
#include "engine/io/chunks.hpp"
#include "engine/io/vtp_writer.hpp"
#include "engine/system/extension.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

void write_obj(Chunks& out, const Surface& surface, const std::string& origin) {
  if (!origin.empty()) out.print("# {}\n", origin);
  for (const Vec3d& p : surface.points) out.point(p, "v ");
  for (const Triangle& t : surface.triangles)
    out.print("f {} {} {}\n", std::uint64_t(t.a) + 1, std::uint64_t(t.b) + 1, std::uint64_t(t.c) + 1);
}

void write_off(Chunks& out, const Surface& surface, const std::string& origin) {
  out.print("OFF\n");
  if (!origin.empty()) out.print("# {}\n", origin);
  out.print("{} {} 0\n", surface.points.size(), surface.triangles.size());
  for (const Vec3d& p : surface.points) out.point(p, "");
  for (const Triangle& t : surface.triangles) out.print("3 {} {} {}\n", t.a, t.b, t.c);
}

void write_stl(Chunks& out, const Surface& surface) {
  std::array<char, 80> header{};
  constexpr std::string_view title = "binary STL written by Nacre";  // must not begin with "solid"
  std::copy(title.begin(), title.end(), header.begin());
  out.raw(header);
  out.raw(std::uint32_t(surface.triangles.size()));
  for (const Triangle& t : surface.triangles) {
    const Vec3d a = surface.points[t.a], b = surface.points[t.b], c = surface.points[t.c];
    out.raw(Vec3f(normalized(cross(b - a, c - a))));
    for (const Vec3d& p : {a, b, c}) out.raw(Vec3f(p));
    out.raw(std::uint16_t(0));
  }
}

/// Property names of one array: name, or name_x name_y name_z, or name_0 name_1 ...; without blanks, all different.
std::vector<std::string> ply_names(const PointArray& array, std::set<std::string>& taken) {
  std::string stem = array.name.empty() ? "array" : array.name;
  for (char& c : stem)
    if (std::isspace(static_cast<unsigned char>(c)) || std::iscntrl(static_cast<unsigned char>(c))) c = '_';
  const auto component = [&](int i) {
    if (array.components == 1) return stem;
    return array.components == 3 ? fmt::format("{}_{}", stem, "xyz"[i]) : fmt::format("{}_{}", stem, i);
  };
  const auto is_taken = [&] {
    for (int i = 0; i < array.components; ++i)
      if (taken.count(component(i)) > 0) return true;
    return false;
  };
  while (is_taken()) stem += '_';
  std::vector<std::string> names;
  for (int i = 0; i < array.components; ++i) names.push_back(component(i));
  taken.insert(names.begin(), names.end());
  return names;
}

void write_ply(Chunks& out, const Surface& surface, const std::string& origin) {
  out.print("ply\nformat binary_little_endian 1.0\n");
  if (!origin.empty()) out.print("comment {}\n", origin);
  out.print("element vertex {}\n", surface.points.size());
  out.print("property double x\nproperty double y\nproperty double z\n");
  std::set<std::string> taken = {"x", "y", "z"};
  for (const PointArray& array : surface.arrays)
    for (const std::string& name : ply_names(array, taken)) out.print("property float {}\n", name);
  out.print("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", surface.triangles.size());
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    out.raw(surface.points[p]);
    for (const PointArray& array : surface.arrays)
      for (int k = 0; k < array.components; ++k)
        out.raw(array.values[p * std::size_t(array.components) + std::size_t(k)]);
  }
  for (const Triangle& t : surface.triangles) {
    out.raw(std::uint8_t(3));
    out.raw(t);
  }
}

/// Checks the indices and lengths on which the writers rely.
void check(const fs::path& file, const Surface& surface) {
  const auto fail = [&](const std::string& why) { throw Error(fmt::format("cannot write {}", file.string()), why); };
  for (const Triangle& t : surface.triangles)
    if (std::max({t.a, t.b, t.c}) >= surface.points.size()) fail("a triangle refers to a point that does not exist");
  for (const PointArray& array : surface.arrays)
    if (array.components < 1 || array.values.size() != surface.points.size() * std::size_t(array.components))
      fail(fmt::format("array \"{}\" does not have one tuple per point", array.name));
  if (surface.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    fail("it has more than 4,294,967,295 triangles");
}

fs::path step_path(const fs::path& file, std::size_t step) {
  return file.parent_path() / fmt::format("{}_{:04}.vtp", file.stem().string(), step);
}

std::string attribute(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

void write_pvd(const fs::path& file, const std::vector<fs::path>& steps, const std::vector<double>& times) {
  OutputFile out(file);
  out.write(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n");
  for (std::size_t k = 0; k < steps.size(); ++k)
    out.write(fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", times[k],
                          attribute(steps[k].filename().string())));
  out.write("</Collection>\n</VTKFile>\n");
  out.commit();
}

}  // namespace

std::vector<std::string> surface_writer_extensions() { return {".vtp", ".obj", ".ply", ".stl", ".off"}; }

void write_surface(const fs::path& file, const Surface& surface, std::optional<double> time,
                   const std::string& origin) {
  const std::string extension = lower_extension(file);
  const std::vector<std::string> known = surface_writer_extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end())
    throw Error(fmt::format("cannot write {}", file.string()),
                extension.empty() ? "its name has no extension" : fmt::format("{} files cannot be written", extension),
                fmt::format("use one of {}", fmt::join(known, " ")));
  check(file, surface);
  if (extension == ".vtp")
    return write_vtp(file, std::span<const Vec3d>(surface.points), surface.triangles, surface.arrays, time, {},
                     xml_origin(origin));
  OutputFile target(file);
  Chunks out(target);
  if (extension == ".obj") write_obj(out, surface, origin);
  if (extension == ".ply") write_ply(out, surface, origin);
  if (extension == ".stl") write_stl(out, surface);
  if (extension == ".off") write_off(out, surface, origin);
  out.flush();
  target.commit();
}

std::vector<fs::path> write_series(const fs::path& file, const SurfaceSeries& series) {
  if (lower_extension(file) != ".pvd")
    throw Error(fmt::format("cannot write {}", file.string()), "a series of time steps needs the extension .pvd");
  std::vector<fs::path> written;
  try {
    for (std::size_t k = 0; k < series.steps(); ++k) {
      const fs::path step = step_path(file, k);
      write_surface(step, series.load(k), series.times[k]);
      written.push_back(step);
    }
    write_pvd(file, written, series.times);
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& step : written) fs::remove(step, ignored);
    throw;
  }
  written.push_back(file);
  return written;
}

}  // namespace nacre
