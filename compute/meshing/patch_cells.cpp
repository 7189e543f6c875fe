// Nacre: Delaunay cells of patches, kept from one mesh to the next.
#include <algorithm>
#include <utility>

#include "compute/math/point_hash.hpp"
#include "compute/meshing/star_patches.hpp"

namespace nacre {
namespace {

constexpr double label_reach = 1;  // sizes: as far from a point the material of its cells is looked up

/// Where the material of each cell is looked up: in the direction of its circumcentre, and near one of its points. The
/// ball of a large cell may contain particles that are not in the patch, so that its centre says nothing; but near a
/// point whose facets are wanted the ball is empty.
std::vector<Vec3d> label_points(const PatchCells::Points& points, const DelaunayCells& cells) {
  std::vector<Vec3d> at(cells.circumcentres);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto& cell = cells.vertices[i];
    const auto wanted = std::find_if(cell.begin(), cell.end(), [&](std::uint32_t v) { return points.wanted[v] != 0; });
    const std::uint32_t near = wanted != cell.end() ? *wanted : *std::min_element(cell.begin(), cell.end());
    const Vec3d away = at[i] - points.places[near];
    const double far = length(away), most = label_reach * points.size[near];
    if (far > most) at[i] = points.places[near] + away * (most / far);
  }
  return at;
}

std::uint64_t key_of(std::span<const Vec3d> places) {
  std::uint64_t key = places.size();
  for (const Vec3d& p : places) key = hash_point(key, p), key ^= key >> 32;
  return key;
}

}  // namespace

void PatchCells::begin() {
  before_ = std::move(now_);
  now_.clear();
  in_patch_before_ = std::move(in_patch_);
  in_patch_.clear();
}

bool PatchCells::was_in_patch(const Vec3d& point) const { return in_patch_before_.contains(key_of({&point, 1})); }

void PatchCells::keep_in_patch(const Vec3d& point) { in_patch_.insert(key_of({&point, 1})); }

std::shared_ptr<const PatchCells::Made> PatchCells::make(Points points, const PatchWorld& world,
                                                         const std::atomic<bool>* stop) {
  const std::uint64_t key = key_of(points.places);
  for (Kept* kept : {&now_, &before_}) {
    const auto [first, last] = kept->equal_range(key);
    const auto same = std::find_if(first, last, [&](const auto& made) { return made.second->points == points; });
    if (same == last) continue;
    const std::shared_ptr<const Made> made = same->second;
    if (kept == &before_) now_.insert(before_.extract(same));
    return made;
  }
  const auto made = std::make_shared<Made>();
  made->points = std::move(points);
  made->cells = delaunay_.cells(made->points.places, stop);
  made->label = world.material_at(label_points(made->points, made->cells));
  now_.insert({key, made});
  return made;
}

}  // namespace nacre
