// Nacre: speckle: small parts of a material, given to what surrounds them.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "engine/scene/volume/materials_parts.hpp"

namespace nacre::materials {
namespace {

/// The 6 neighbours of voxels.
class Neighbours {
 public:
  explicit Neighbours(const Int3& dims)
      : nx_(std::size_t(dims.x)), ny_(std::size_t(dims.y)), nz_(std::size_t(dims.z)) {}

  /// Calls `use(voxel)` for each; true where the voxel lies on a face of the volume.
  template <class Use>
  bool each(std::size_t voxel, const Use& use) const {
    const std::size_t x = voxel % nx_, y = voxel / nx_ % ny_, z = voxel / (nx_ * ny_);
    if (x > 0) use(voxel - 1);
    if (x + 1 < nx_) use(voxel + 1);
    if (y > 0) use(voxel - nx_);
    if (y + 1 < ny_) use(voxel + nx_);
    if (z > 0) use(voxel - nx_ * ny_);
    if (z + 1 < nz_) use(voxel + nx_ * ny_);
    return x == 0 || y == 0 || z == 0 || x + 1 == nx_ || y + 1 == ny_ || z + 1 == nz_;
  }

 private:
  std::size_t nx_, ny_, nz_;
};

using Part = std::vector<std::size_t>;  ///< voxels, the first in scan order first

/// Walks through the part that holds `seed`, front by front. Its voxels, or nothing where there are `fewest` or more.
class PartWalk {
 public:
  PartWalk(const MeshVolume& volume, std::size_t fewest)
      : volume_(volume), neighbours_(volume.dims), fewest_(fewest), seen_(volume.voxels(), false) {}

  bool seen(std::size_t voxel) const { return seen_[voxel]; }

  Part part_at(std::size_t seed) {
    const std::uint16_t material = volume_.material[seed];
    Part part{seed}, front{seed}, next;
    bool on_face = false, large = false;
    seen_[seed] = true;
    while (!front.empty()) {
      next.clear();
      for (const std::size_t voxel : front)
        on_face |= neighbours_.each(voxel, [&](std::size_t other) {
          if (seen_[other] || volume_.material[other] != material) return;
          seen_[other] = true;
          next.push_back(other);
        });
      large = large || part.size() + next.size() >= fewest_;
      if (large)
        part.clear();
      else
        part.insert(part.end(), next.begin(), next.end());
      front.swap(next);
    }
    // The outside goes on beyond the volume's faces.
    const bool stays = large || part.size() >= fewest_ || (material == 0 && on_face);
    return stays ? Part{} : part;
  }

 private:
  const MeshVolume& volume_;
  Neighbours neighbours_;
  std::size_t fewest_;
  std::vector<bool> seen_;
};

std::vector<Part> small_parts(const MeshVolume& volume, std::size_t fewest) {
  PartWalk walk(volume, fewest);
  std::vector<Part> parts;
  for (std::size_t voxel = 0; voxel < volume.material.size(); ++voxel)
    if (!walk.seen(voxel))
      if (Part part = walk.part_at(voxel); !part.empty()) parts.push_back(std::move(part));
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.size() < b.size(); });
  return parts;
}

/// Makes `to` win where `from` does.
void move_values(MeshVolume& volume, std::size_t voxel, std::uint16_t from, std::uint16_t to) {
  if (volume.kind == MeshVolume::Kind::indicators) {
    std::swap(volume.values[from][voxel], volume.values[to][voxel]);
  } else if (volume.kind == MeshVolume::Kind::scalar) {
    // Mirrored at the level that bounds the new material, but not beyond the middle of that.
    const std::vector<float>& levels = volume.levels;
    const bool down = to < from;
    const float level = down ? levels[to] : levels[to - 1];
    const bool bounded = down ? to > 0 : to < levels.size();
    const float far = bounded ? 0.5f * (down ? levels[to - 1] + level : level + levels[to]) : 0.0f;
    float& value = volume.values[0][voxel];
    value = 2 * level - value;
    if (bounded) value = down ? std::max(value, far) : std::min(value, far);
    if (down) value = std::min(value, std::nextafter(level, level - 1));
  }
}

/// One round. Parts beside one that was just given away wait for the next: they may have grown.
std::size_t give_away(MeshVolume& volume, const std::vector<Part>& parts) {
  const Neighbours neighbours(volume.dims);
  std::vector<bool> changed(volume.voxels(), false);
  std::vector<std::uint16_t>& material = volume.material.own();
  std::size_t given = 0;
  for (const Part& part : parts) {
    const std::uint16_t own = material[part[0]];
    std::map<std::uint16_t, std::size_t> counts;
    bool waits = false;
    for (const std::size_t voxel : part)
      neighbours.each(voxel, [&](std::size_t other) {
        waits = waits || changed[other];
        if (material[other] != own) ++counts[material[other]];
      });
    if (waits || counts.empty()) continue;
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const std::size_t voxel : part) {
      move_values(volume, voxel, own, most->first);
      material[voxel] = most->first;
      changed[voxel] = true;
    }
    ++given;
  }
  return given;
}

/// Takes materials without voxels out, but the outside. A scalar volume's levels stay what they are.
void remove_vanished(MeshVolume& volume, const std::set<std::uint16_t>& before, const Notes& notes) {
  std::vector<bool> there(std::size_t(volume.materials()), false);
  for (const std::uint16_t material : volume.material.own()) there[material] = true;
  std::vector<std::uint16_t> number(there.size(), 0);
  std::uint16_t next = 1;
  for (std::size_t m = 1; m < there.size(); ++m) {
    if (!there[m] && before.count(std::uint16_t(m)))
      notes.add(fmt::format("Nothing is left of label {}: all its components were too small.", volume.labels[m]));
    if (volume.kind == MeshVolume::Kind::scalar || there[m] || !before.count(std::uint16_t(m))) {
      number[m] = next;
      volume.labels[next] = volume.labels[m];
      if (!volume.names.empty() && next != m) volume.names[next] = std::move(volume.names[m]);
      if (volume.kind == MeshVolume::Kind::indicators && next != m) volume.values[next] = std::move(volume.values[m]);
      ++next;
    }
  }
  volume.labels.resize(next);
  if (!volume.names.empty()) volume.names.resize(next);
  if (volume.kind == MeshVolume::Kind::indicators) volume.values.resize(next);
  for (std::uint16_t& material : volume.material.own()) material = number[material];
}

}  // namespace

std::size_t drop_small_components(MeshVolume& volume, std::int64_t fewest, const Notes& notes) {
  const std::vector<std::uint16_t> original = volume.material.own();
  const std::set<std::uint16_t> before(original.begin(), original.end());
  const std::size_t limit = std::size_t(std::min<std::int64_t>(fewest, std::int64_t(volume.voxels()) + 1));
  std::size_t all = 0, voxels = 0;
  // Each round merges parts, so that there are fewer in the next.
  for (std::size_t given = 1; given > 0; all += given) given = give_away(volume, small_parts(volume, limit));
  for (std::size_t i = 0; i < original.size(); ++i) voxels += original[i] != volume.material[i];
  if (all > 0)
    notes.add(fmt::format("{} components of fewer than {} voxels ({} voxels) were given to the material around them.",
                          all, fewest, voxels));
  remove_vanished(volume, before, notes);
  return all;
}

}  // namespace nacre::materials
