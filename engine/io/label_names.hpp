// Nacre: names of labels, if the file of a volume has them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// Reads the label table in the XML that Caret, Connectome Workbench and TotalSegmentator write into the extension of a
/// NIfTI file. Empty if it is damaged or missing: names are optional, so this is not an error.
LabelNames names_of_label_table(std::string_view xml);

/// Reads the segments of a NRRD written by 3D Slicer. `field(key)` is the value of a key in the header, or nothing; the
/// keys are "Segment0_Name" and "Segment0_LabelValue", and so on.
LabelNames names_of_segments(const std::function<std::optional<std::string>(const std::string& key)>& field);

}  // namespace nacre
