// Nacre: positions on junctions that are kept from one mesh to the next.
#include "compute/pipeline/kept_nearest.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <bit>

#include "compute/math/point_hash.hpp"

namespace nacre {
namespace {

std::uint64_t hash_of(const Vec3d& point, const Junction& junction) {
  const std::uint64_t hash = hash_point(junction.packed, point);
  return hash ^ hash >> 32;
}

}  // namespace

const std::vector<Vec3d>& KeptNearest::operator()(std::span<const Vec3d> points, std::span<const Junction> junctions) {
  std::vector<Vec3d> on(points.size()), asked;
  std::vector<std::uint32_t> known(points.size(), none), fresh;
  if (!slots_.empty())
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
      known[i] = slots_[slot_of(points[i], junctions[i])];
      if (known[i] != none) on[i] = on_[known[i]];
    });
  std::vector<Junction> asked_of;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (known[i] == none) fresh.push_back(i), asked.push_back(points[i]), asked_of.push_back(junctions[i]);
  const std::vector<Vec3d> answer = asked.empty() ? std::vector<Vec3d>() : onto_(asked, asked_of);
  for (std::size_t k = 0; k < fresh.size(); ++k) on[fresh[k]] = answer[k];
  keep(points, junctions, std::move(on));
  return on_;
}

std::size_t KeptNearest::slot_of(const Vec3d& point, const Junction& junction) const {
  std::size_t slot = hash_of(point, junction) & (slots_.size() - 1);
  while (slots_[slot] != none && !(points_[slots_[slot]] == point && junctions_[slots_[slot]] == junction))
    slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void KeptNearest::keep(std::span<const Vec3d> points, std::span<const Junction> junctions, std::vector<Vec3d> on) {
  points_.assign(points.begin(), points.end()), junctions_.assign(junctions.begin(), junctions.end());
  on_ = std::move(on);
  slots_.assign(std::bit_ceil(2 * points.size() + 2), none);
  // Which thread takes a slot is left to chance, but not what is found: equal points have equal answers.
  tbb::parallel_for(std::uint32_t(0), std::uint32_t(points_.size()), [&](std::uint32_t i) {
    for (std::size_t slot = hash_of(points_[i], junctions_[i]);; ++slot) {
      std::uint32_t taken = none;
      std::atomic_ref<std::uint32_t> at(slots_[slot & (slots_.size() - 1)]);
      if (at.compare_exchange_strong(taken, i)) return;
      if (points_[taken] == points_[i] && junctions_[taken] == junctions_[i]) return;
    }
  });
}

}  // namespace nacre
