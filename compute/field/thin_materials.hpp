// Nacre: where too many materials meet for one place, the rarest give way.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Where more than `most` materials lie within 4 voxels of one block of the padded volume (as lay_out_bricks counts
/// them), the rarest of those there are taken away from there: each of their voxels takes the nearest material that
/// stays. The outside, 0, always stays. Of materials that are as rare, higher numbers go first. `material`: per voxel,
/// x fastest. Returns how many voxels have changed. In some places it may not succeed, where blocks around put back
/// what was taken.
std::int64_t thin_materials(const Int3& dims, std::vector<std::uint16_t>& material, int most);

}  // namespace nacre
