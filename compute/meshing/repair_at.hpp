// Nacre: labels of Delaunay cells repaired at some of their points only.
#pragma once

#include "compute/meshing/repair.hpp"

namespace nacre {

/// As `repair_labels`, but of the edges and vertices where the surface touches itself only those are looked at that
/// have a point which `there` marks, and what their changes concern. Cells that have a point beyond the end of `there`
/// keep their label.
LabelRepair repair_labels_at(std::span<const std::uint8_t> there, std::span<const Vec3d> points,
                             const DelaunayCells& cells, std::vector<std::uint16_t>& label,
                             const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
