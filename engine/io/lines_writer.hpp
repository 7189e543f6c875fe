// Nacre: writes points and polylines as VTK PolyData (.vtp).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Writes `points`, of which the first `vertices` become a vertex cell each; `line_starts`: for each polyline the
/// number of its first point, ascending, and how many points there are (empty: no lines). `arrays`: a tuple per point.
/// Numbers as `write_vtp` writes them. Throws Error if the file cannot be written, or a length does not fit.
void write_vtp_lines(const std::filesystem::path& file, std::span<const Vec3d> points, std::size_t vertices,
                     std::span<const std::uint64_t> line_starts, std::span<const PointArray> arrays,
                     std::optional<double> time = std::nullopt);

}  // namespace nacre
