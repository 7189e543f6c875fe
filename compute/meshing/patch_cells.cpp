// Nacre: Delaunay cells of patches, kept from one mesh to the next.
#include <algorithm>
#include <utility>

#include "compute/math/point_hash.hpp"
#include "compute/meshing/interface_facets.hpp"
#include "compute/meshing/star_patches.hpp"

namespace nacre {
namespace {

constexpr double label_reach = 1.5;  // sizes: as far from a facet the material of its cell is looked up

/// The circumcentre of a triangle.
Vec3d circumcentre(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u = b - a, v = c - a, n = cross(u, v);
  const double n2 = dot(n, n);
  if (!(n2 > 0)) return (a + b + c) / 3;
  return a + cross(dot(u, u) * v - dot(v, v) * u, n) / (2 * n2);
}

/// Where the material of each cell is looked up: at its circumcentre, where that is near its smallest facet. Of a
/// farther one, whose ball would hold particles that are not in the patch, only the direction is used.
std::vector<Vec3d> label_points(const PatchCells::Made& made) {
  std::vector<Vec3d> at(made.cells.circumcentres);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto& cell = made.cells.vertices[i];
    double least = 0;
    Vec3d foot;
    double size = 0;
    for (const auto& [a, b, c] : facet_corners) {
      const Vec3d centre = circumcentre(made.places[cell[a]], made.places[cell[b]], made.places[cell[c]]);
      const double radius = length(centre - made.places[cell[a]]);
      if (size > 0 && radius >= least) continue;
      least = radius, foot = centre;
      size = std::max({made.size[cell[a]], made.size[cell[b]], made.size[cell[c]]});
      // That of a needle is far from it.
      if (radius > label_reach * size) foot = (made.places[cell[a]] + made.places[cell[b]] + made.places[cell[c]]) / 3;
    }
    const Vec3d away = at[i] - foot;
    const double far = length(away);
    if (far > label_reach * size) at[i] = foot + away * (label_reach * size / far);
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

std::shared_ptr<const PatchCells::Made> PatchCells::make(std::vector<Vec3d> places, std::vector<double> size,
                                                         const PatchWorld& world, const std::atomic<bool>* stop) {
  const std::uint64_t key = key_of(places);
  for (Kept* kept : {&now_, &before_}) {
    const auto [first, last] = kept->equal_range(key);
    const auto same = std::find_if(
        first, last, [&](const auto& made) { return made.second->places == places && made.second->size == size; });
    if (same == last) continue;
    const std::shared_ptr<const Made> made = same->second;
    if (kept == &before_) now_.insert(before_.extract(same));
    return made;
  }
  const auto made = std::make_shared<Made>();
  made->places = std::move(places), made->size = std::move(size);
  made->cells = delaunay_.cells(made->places, stop);
  made->label = world.material_at(label_points(*made));
  now_.insert({key, made});
  return made;
}

}  // namespace nacre
