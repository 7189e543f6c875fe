// Nacre: the overlapping layers of a segmentation of 3D Slicer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/io/label_names.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// Puts the layers of `volume` into one: where segments overlap, the later one counts, as in 3D Slicer. Segments keep
/// their label values if all differ, otherwise they are numbered from 1. Sets values, label_names and warnings.
/// `value(voxel, layer)` is what the file has there; values that belong to no segment are outside.
void merge_layers(Volume& volume, std::int64_t layers, const std::vector<Segment>& segments,
                  const std::function<std::int64_t(std::size_t voxel, std::int64_t layer)>& value);

}  // namespace nacre
