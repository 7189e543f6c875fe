// Nacre: the values of a flow as a file.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Arrays for points of the surface; empty: none.
using MoreArrays = std::function<std::vector<PointArray>(std::span<const Vec3d>)>;

/// Writes the values as .vtp: one point per surface cell, at its centre, with the arrays `value` (0..1), `velocity`,
/// `normal` and `closest_point`, and those that `more` gives. `time` becomes TimeValue. `origin` says how they came
/// about (engine/run/origin.hpp). `before_it_appears` as for write_vtp. Throws Error where the file cannot be written.
void write_flow_values(const FlowValues& values, const std::filesystem::path& file, double time,
                       const std::string& origin = "", const MoreArrays& more = {},
                       const std::function<void()>& before_it_appears = {});

/// The name of part `k` of the values that a .pvtp lists: a.pvtp has a_0.vtp, a_1.vtp and so on.
std::filesystem::path flow_values_piece(const std::filesystem::path& file, int k);

/// Writes the .pvtp that lists these parts, which are there already; `origin` and `more` are theirs.
void write_flow_values_list(const std::filesystem::path& file, std::span<const int> parts, const std::string& origin,
                            const MoreArrays& more = {});

}  // namespace nacre
