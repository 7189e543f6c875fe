// Nacre: names and colours of labels, if the file of a volume has them.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// What a file says of its labels.
struct LabelTable {
  LabelNames names;
  LabelColours colours;
};

/// Reads the label table in the XML that Caret, Connectome Workbench and TotalSegmentator write into the extension of a
/// NIfTI file. Empty if it is damaged or missing: names are optional, so this is not an error.
LabelTable label_table_in_xml(std::string_view xml);

/// A segment of a NRRD written by 3D Slicer.
struct Segment {
  std::string name;        ///< in one line; may be empty
  std::int64_t label = 0;  ///< its value in its layer
  std::int64_t layer = 0;
  std::optional<std::array<float, 3>> colour;
};

/// Reads the segments, in the order of the file. `field(key)` is the value of a key in the header, or nothing; the keys
/// are "Segment0_Name", "Segment0_LabelValue", "Segment0_Layer", "Segment0_Color", and so on. Segments without
/// a label value are left out.
std::vector<Segment> find_segments(const std::function<std::optional<std::string>(const std::string& key)>& field);

/// Names and colours by label of the segments in `layer`; of two for one label, the first is kept.
LabelTable table_of_segments(const std::vector<Segment>& segments, std::int64_t layer = 0);

/// Reads the colour table that FreeSurfer writes at the end of a volume: big-endian, from its version or number of
/// entries on. Empty if it is damaged.
LabelTable label_table_in_bytes(std::string_view bytes);

/// Reads a file of names for `--names`: a label description of ITK-SNAP (number, six numbers, the name in quotes), a
/// colour table of FreeSurfer or 3D Slicer (number, name, three or four numbers), or simply a number and a name on each
/// line; # begins a comment. Throws Error if the file cannot be read, if a line has no number and name, or if there are
/// no names.
LabelTable read_label_table(const std::filesystem::path& path);

/// The names alone.
LabelNames read_label_names(const std::filesystem::path& path);

}  // namespace nacre
