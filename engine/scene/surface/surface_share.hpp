// Nacre: a surface that several processes have in shares, and its preparation without any of them having all of it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compute/device/ranks.hpp"
#include "compute/math/vec.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// A series of which each process loads its share: triangles that follow each other in the order of the processes, the
/// points that these use, and arrays on the points. All processes have arrays of the same names.
struct SharedSeries {
  SurfaceSeries series;
  /// Of each point of the share: the same number for the same point of the whole, ascending.
  std::vector<std::uint64_t> point_id;
};

/// Throws Error where a process has another number than the first. Collective.
void require_same(Ranks& ranks, std::uint64_t hash);

/// Gives each process an equal number of the triangles of a series that all of them can load whole. Throws Error where
/// they have different ones. Collective, as all that follow.
SharedSeries share_series(const SurfaceSeries& whole, Ranks& ranks);

/// Triangles `first` .. `last` - 1 of a surface, with the points that they use; appends the numbers of these to `used`.
Surface cut_share(const Surface& whole, std::size_t first, std::size_t last, std::vector<std::uint32_t>& used);

/// What a process has of a prepared surface: its share, and before and after it the triangles of others that touch it,
/// in the order of the whole, so that whatever is summed up around a point of the share is complete, and in order.
struct Share {
  Ranks* ranks = nullptr;
  std::size_t first_triangle = 0, triangles = 0;  ///< its own ones, in the prepared surface
  std::size_t points = 0;                         ///< of the series; those of others come after them
  std::vector<std::uint8_t> counted;              ///< per point: this process counts it; each is counted once
  std::uint64_t all_points = 0, all_triangles = 0;
  std::uint64_t peak_bytes = 0;  ///< arrays of the surface while it is prepared, when they are most
  std::uint64_t halo_bytes = 0;  ///< in there: of what is not its own
  std::uint64_t kept_bytes = 0;  ///< after that
};

struct PreparedShare {
  PreparedSurface surface;
  Share share;
  /// Why this surface cannot be prepared in shares; empty: it is.
  std::string whole_needed;
};

/// What `prepare` does with the whole of the shares; to the byte the same triangles and normals in the end. `warnings`
/// are those of the whole. Throws Error where no triangle is left. A surface with second sheets, or with parts that
/// cannot be wound consistently, is left to `prepare`.
PreparedShare prepare_share(Ranks& ranks, const Surface& share, std::span<const std::uint64_t> point_id,
                            double crease_degrees, std::vector<std::string>* warnings);

/// The triangles of a share, and the points that this process counts.
inline std::span<const Triangle> own_triangles(const PreparedSurface& surface, const Share* share) {
  const std::span<const Triangle> all(surface.triangles);
  return share ? all.subspan(share->first_triangle, share->triangles) : all;
}
inline bool is_counted(const Share* share, std::size_t point) { return !share || share->counted[point] != 0; }

}  // namespace nacre
