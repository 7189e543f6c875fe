// Nacre: writes surfaces in the format of the file's extension.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Writes `surface` as .vtp, .ply (binary), .stl (binary), .obj or .off. Only .vtp and .ply keep arrays; .stl has
/// 32-bit coordinates. Only .vtp keeps `time`. `origin` says how the surface came about
/// (engine/run/origin.hpp): a comment, except in .stl. Throws Error for other extensions and if writing fails.
void write_surface(const std::filesystem::path& file, const Surface& surface, std::optional<double> time = std::nullopt,
                   const std::string& origin = "");

/// Writes each step beside `file` (name.pvd: name_0000.vtp, name_0001.vtp, ...), then `file` itself, which lists them
/// with their times. If a step fails, those already written are removed. Returns all files, `file` last. Throws Error.
std::vector<std::filesystem::path> write_series(const std::filesystem::path& file, const SurfaceSeries& series);

/// The extensions that `write_surface` accepts, lower case, with dot.
std::vector<std::string> surface_writer_extensions();

}  // namespace nacre
