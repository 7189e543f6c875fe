// Nacre: Delaunay cells of patches, kept from one mesh to the next.
#include <oneapi/tbb/parallel_for.h>

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

std::shared_ptr<const PatchCells::Made> PatchCells::find(std::uint64_t key, const Points& points) {
  for (Kept* kept : {&now_, &before_}) {
    const auto [first, last] = kept->equal_range(key);
    const auto same = std::find_if(first, last, [&](const auto& made) { return made.second->points == points; });
    if (same == last) continue;
    const std::shared_ptr<const Made> made = same->second;
    if (kept == &before_) now_.insert(before_.extract(same));
    return made;
  }
  return nullptr;
}

std::vector<std::shared_ptr<const PatchCells::Made>> PatchCells::make(std::vector<Wanted> wanted,
                                                                      const PatchWorld& world,
                                                                      const std::atomic<bool>* stop) {
  std::vector<std::shared_ptr<const Made>> all(wanted.size());
  struct Fresh {
    std::size_t number;
    std::uint64_t key;
    std::shared_ptr<Made> made = std::make_shared<Made>();
    std::vector<Vec3d> label_points = {};
  };
  std::vector<Fresh> fresh;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::uint64_t key = key_of(wanted[i].points.places);
    all[i] = find(key, wanted[i].points);
    if (!all[i]) fresh.push_back({i, key});
  }
  tbb::parallel_for(std::size_t(0), fresh.size(), [&](std::size_t k) {
    Made& made = *fresh[k].made;
    Wanted& of = wanted[fresh[k].number];
    made.points = std::move(of.points);
    made.cells = of.delaunay->cells(made.points.places, stop);
    fresh[k].label_points = label_points(made.points, made.cells);
  });
  std::vector<Vec3d> at;
  for (const Fresh& f : fresh) at.insert(at.end(), f.label_points.begin(), f.label_points.end());
  const std::vector<std::uint16_t> label = at.empty() ? std::vector<std::uint16_t>() : world.material_at(at);
  auto from = label.begin();
  for (Fresh& f : fresh) {
    const auto to = from + std::ptrdiff_t(f.label_points.size());
    f.made->label.assign(from, to);
    from = to;
    now_.insert({f.key, f.made});
    all[f.number] = std::move(f.made);
  }
  return all;
}

}  // namespace nacre
