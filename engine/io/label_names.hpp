// Nacre: what the labels of a volume are called, where its file says so.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// Of the label table in the XML that Caret, Connectome Workbench and TotalSegmentator write into a NIfTI file's
/// extension. Empty where it is damaged or has no table: names are a help, and nothing fails for want of them.
LabelNames names_of_label_table(std::string_view xml);

/// Of the segments in a NRRD that 3D Slicer has written. `field(key)` is the header's value for a key, none where it has
/// none; the keys are "Segment0_Name" and "Segment0_LabelValue", and so on.
LabelNames names_of_segments(const std::function<std::optional<std::string>(const std::string& key)>& field);

}  // namespace nacre
