// Nacre: streaks for the eye: the moving texture convolved along the flow of the frame (Cabral & Leedom 1993, Okada &
// Kao 1997). What particles carry is not touched by it, so the texture moves as before; its
// direction is that of the present flow, also where the flow is slow and particles leave no lines.
#pragma once

#include "compute/flow/filter.hpp"
#include "compute/flow/surface_cells.hpp"

namespace nacre {

/// A unit vector in 30 bits, 10 for each component; exact to 0.1 degrees. 0 stands for no direction.
struct PackedDirection {
  NACRE_HD_INLINE static std::uint32_t pack(const Vec3f& v) {
    std::uint32_t all = 0;
    for (int axis = 0; axis < 3; ++axis)
      all |= (std::uint32_t(int(std::floor(v[axis] * 511.0f + 0.5f))) & 0x3ff) << (10 * axis);
    return all;
  }
  NACRE_HD_INLINE static Vec3f unpack(std::uint32_t p) {
    constexpr float scale = 1.0f / 511;
    return {float(std::int32_t(p << 22) >> 22) * scale, float(std::int32_t(p << 12) >> 22) * scale,
            float(std::int32_t(p << 2) >> 22) * scale};
  }
};

/// What a streamline reads of a surface cell.
struct StreakCell {
  std::uint32_t direction;  ///< PackedDirection of the flow, tangential; 0 where nothing flows
  std::uint32_t normal;     ///< PackedDirection
  float plane;              ///< height of the closest point above the cell's centre along the normal, in cells
  float value;
};

/// Fills in the flow and the surface of each surface cell, from the triangle of its closest point: exact where vectors
/// kept on a coarser grid are blurred, and at creases.
template <class Surface>
struct MarkStreakCells {
  Surface surface;
  MeshView mesh;
  double cell;           ///< edge of a texture cell in units of the mesh's points
  const Vec3f* vectors;  ///< one per point of the mesh, at the time of the frame
  float least;           ///< speed below which nothing flows
  StreakCell* cells;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    const SurfaceFoot foot = surface.foot(s, position);
    const Vec3f w(barycentric(mesh.corners(foot.triangle), (Vec3d(position) + Vec3d(0.5) + Vec3d(foot.offset)) * cell));
    const Triangle corner = mesh.triangles[foot.triangle];
    const Vec3f n = mesh.normal(foot.triangle, w);
    const Vec3f v = vectors[corner.a] * w.x + vectors[corner.b] * w.y + vectors[corner.c] * w.z;
    const Vec3f tangential = v - n * dot(n, v);
    const float speed = length(tangential);
    const std::uint32_t direction = speed > least ? PackedDirection::pack(tangential / speed) : 0;
    cells[s] = {direction, PackedDirection::pack(n), dot(n, foot.offset), 0};
  }
};

/// What streaks are made of: the mean of the values at a cell and one cell up and down the flow. It takes out what
/// alternates from cell to cell, which would leave chequers.
template <class Surface>
struct SmoothAlongFlow {
  Surface surface;
  const float* value;  ///< 0..1
  StreakCell* cells;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    typename Surface::Cursor cursor(surface);
    const auto at = [&](const Vec3f& p) {
      const NearSurfaceCell found = cursor.find(position + floor_cell(p));
      return value[found.cell == no_cell ? s : found.cell];
    };
    float mean = value[s];
    if (const std::uint32_t direction = cells[s].direction) {
      const Vec3f d = PackedDirection::unpack(direction);
      const Vec3f p = Vec3f(0.5f) + PackedDirection::unpack(cells[s].normal) * cells[s].plane;
      mean = 0.5f * mean + 0.25f * (at(p + d) + at(p - d));
    }
    cells[s].value = mean - 0.5f;
  }
};

/// The mean of the values along the streamline through the closest point of a surface cell, `reach` cells each way or
/// to where the flow or the surface ends or turns back.
template <class Surface>
struct ConvolveAlongFlow {
  Surface surface;
  const StreakCell* cells;
  int reach;
  float* result;  ///< 0..1, around 1/2

  static constexpr float gain = 4;  ///< a mean of so many values is small

  NACRE_HD void operator()(CellIndex home, const Int3& position) const {
    result[home] = clamp01(0.5f + gain * mean(home, position));
  }

  NACRE_HD_INLINE float mean(CellIndex home, const Int3& position) const {
    const StreakCell own = cells[home];
    float sum = own.value;
    if (own.direction == 0) return sum;
    int count = 1;
    const Vec3f along = PackedDirection::unpack(own.direction);
    const Vec3f start = Vec3f(0.5f) + PackedDirection::unpack(own.normal) * own.plane;
    for (int side = -1; side <= 1; side += 2) {
      typename Surface::Cursor cursor(surface);
      Vec3f p = start, d = along * float(side), before = d;
      for (int i = 0; i < reach; ++i) {
        p = p + d * 1.5f - before * 0.5f;  // a cell by Adams and Bashforth's second order: one direction a step
        const Vec3f low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
        const NearSurfaceCell found = cursor.find(position + Int3(int(low.x), int(low.y), int(low.z)));
        if (found.cell == no_cell) break;
        const StreakCell cell = cells[found.cell];
        const Vec3f next = PackedDirection::unpack(cell.direction) * float(side);
        if (!(dot(next, d) > 0)) break;
        before = d;
        d = next;
        if (found.direct) {
          const Vec3f n = PackedDirection::unpack(cell.normal);
          p = p - n * (dot(n, p - low - Vec3f(0.5f)) - cell.plane);
        }
        sum += cell.value;
        ++count;
      }
    }
    return sum / float(count);
  }
};

}  // namespace nacre
