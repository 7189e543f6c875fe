// Nacre: the parts that materials are made with; for engine/scene/volume/materials*.cpp alone.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/scene/volume/materials.hpp"

namespace nacre::materials {

/// Where sentences about what was assumed go; may lead nowhere.
struct Notes {
  std::vector<std::string>* sentences = nullptr;
  void add(std::string sentence) const {
    if (sentences) sentences->push_back(std::move(sentence));
  }
};

/// Grid, kind and nothing else yet.
MeshVolume on_grid_of(const Volume& volume, MeshVolume::Kind kind);

MeshVolume from_labels(const Volume& volume, const MaterialOptions& options, const Notes& notes);
MeshVolume from_isovalues(const Volume& volume, const MaterialOptions& options, const Notes& notes);
MeshVolume from_threshold(const Volume& volume, const MaterialOptions& options, const Notes& notes);
MeshVolume from_indicators(std::span<const Volume> volumes, const MaterialOptions& options, const Notes& notes);

/// All values as floats; `otherwise` where they are no number, the smallest and largest finite one where infinite.
std::vector<float> as_floats(const Volume& volume, const VolumeStatistics& statistics, float otherwise);

/// Warns of voxels that are not finite.
void note_not_finite(const Volume& volume, const VolumeStatistics& statistics, const Notes& notes);

/// The label that each label becomes by the options: after merging, and the outside's where it is not kept. `present`
/// are those of the input, ascending. Throws Error for labels that are not there.
class LabelPlan {
 public:
  LabelPlan(const std::vector<std::int64_t>& present, const MaterialOptions& options, const std::string& name);
  std::int64_t merged(std::int64_t label) const;                       ///< after merging alone
  std::uint16_t material(std::int64_t label) const;                    ///< of a label of the input
  const std::vector<std::int64_t>& labels() const { return labels_; }  ///< per material, [0] the outside's

 private:
  std::vector<std::pair<std::int64_t, std::int64_t>> merge_;
  std::vector<std::int64_t> labels_;
};

/// Gives 6-connected parts of fewer than `fewest` voxels the material that most of their neighbours have, the smallest
/// part first, until no such part is left. Outside that touches the volume's faces stays. Values follow, so that the
/// new material wins there. Materials that vanish are taken out. Returns how many parts were given away.
std::size_t drop_small_components(MeshVolume& volume, std::int64_t fewest, const Notes& notes);

}  // namespace nacre::materials
