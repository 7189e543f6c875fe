// Nacre: what of a volume is which material, as the mesh pipeline takes it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// How voxels become materials.
struct MaterialOptions {
  enum class Mode {
    automatic,  ///< by what is given below and what the values are like
    labels,     ///< every different value is a material
    isovalue,   ///< cut at `isovalues`
  };
  Mode mode = Mode::automatic;
  std::vector<double> isovalues;                             ///< of one scalar volume; any order
  std::optional<std::pair<double, double>> threshold;        ///< the one material lies between; whole values on the
                                                             ///< bounds are inside
  std::vector<std::int64_t> materials;                       ///< labels to keep, the others become outside; empty: all
  std::vector<std::pair<std::int64_t, std::int64_t>> merge;  ///< label first becomes label second, all at once; before
                                                             ///< `materials`
  std::int64_t min_component = 0;  ///< 6-connected parts of fewer voxels take the material around them; 0: all stay
};

/// Materials of a label map (any whole numbers, also stored as floats), of a scalar volume cut at iso-values or by a
/// threshold, or of several indicator volumes on one grid, one per material.
///
/// Label maps: label 0 is the outside unless `materials` names it; then the outside is one below the smallest label.
/// Indicators: labels are 1..n in the order of the files, names are the files' stems. Probabilities are divided by
/// their common maximum (floats up to 1 are left alone), and the outside takes what is missing from 1. Where any value
/// is negative they are functions, used as they are: the largest wins, and the outside is where a material that is not
/// kept would be. Scalars: material m lies between level m - 1 and level m. Voxels that are no number become outside;
/// infinite ones take the nearest finite value of the volume.
///
/// `material` is filled for every kind. What was assumed or dropped is added to `warnings` (may be null), full
/// sentences. Throws Error for a label that is not there, values that are no labels where labels are wanted, an
/// iso-value beyond the values, a volume with one value only, nothing inside, options that do not go together, or
/// indicators on different grids.
MeshVolume make_mesh_volume(std::span<const Volume> volumes, const MaterialOptions& options,
                            std::vector<std::string>* warnings = nullptr);

/// A volume is no label map, and nobody said where to cut it.
class MissingIsovalue : public Error {
 public:
  MissingIsovalue(const std::string& name, const std::string& why, double proposal, const std::string& otherwise);
  double proposal() const { return proposal_; }  ///< by `otsu_threshold`

 private:
  double proposal_;
};

/// The iso-value that splits the values best into two groups (Otsu: largest variance between them), from a histogram
/// of 256 bins; in the middle of a gap.
double otsu_threshold(const Volume& volume);

}  // namespace nacre
