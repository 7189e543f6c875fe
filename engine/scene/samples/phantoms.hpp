// Nacre: built-in volumes that look and behave like anatomy, and small analytic ones, by name.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

struct PhantomInfo {
  std::string name;       ///< what `make_phantom` takes
  std::string help;       ///< one line
  Int3 dims{};            ///< voxels at its own detail
  bool labelled = false;  ///< labels, else a scalar with values 0 (outside) to 1 and the interface at 0.5
};

/// The iso-value at which scalar phantoms are meant to be cut.
inline constexpr double phantom_isovalue = 0.5;

/// All phantoms, in the order in which to list them.
std::vector<PhantomInfo> phantoms();

/// True where `make_phantom` knows the name.
bool is_phantom(const std::string& name);

/// Makes a phantom: uint8 labels or float values, with voxel (0, 0, 0) at the world's origin, x to the left, y to the
/// back, z up, spacing 1 at its own detail. The same bytes on any number of threads. `detail` is the number of voxels
/// along its longest side (0: its own, which is that of the thesis's data); the shapes keep their size in the
/// world, so that fewer voxels lose thin parts. Throws Error for an unknown name (with the known ones) or a detail
/// outside of 16..1024, Interrupted soon after `*stop` is set.
Volume make_phantom(const std::string& name, int detail = 0, const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
