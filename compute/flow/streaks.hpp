// Nacre: streaks for the eye: the moving texture, high-passed and convolved along the flow of the frame (Cabral &
// Leedom 1993, Okada & Kao 1997). What particles carry is not touched by it, so the texture moves as before; its
// direction is that of the present flow, also where the flow is slow and particles leave no lines.
#pragma once

#include "compute/embedding/band.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/refined_grid.hpp"
#include "compute/flow/filter.hpp"

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

/// A surface cell that was found for a cell of space.
struct NearSurfaceCell {
  CellIndex cell = no_cell;
  bool direct = false;  ///< it is that cell itself, not the one that holds its closest point
};

/// The closest point of a surface cell, from its centre, in texture cells, and the triangle that it lies on.
struct SurfaceFoot {
  Vec3f offset;
  std::uint32_t triangle;
};

/// How streamlines find surface cells on the grid.
struct GridStreaks {
  RefinedGridView texture;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex s, const Int3&) const {
    const Float4 offset = texture.seed[s];
    return {{offset.x, offset.y, offset.z}, texture.seed_triangle[s]};
  }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const GridStreaks& streaks) : texture_(streaks.texture) {}
    NACRE_HD_INLINE NearSurfaceCell find(const Int3& cell) {
      const Int3 outer = texture_.outer(cell);
      if (!(outer == outer_)) {
        outer_ = outer;
        block_ = texture_.block_of(outer);
      }
      if (block_ == none) return {};
      const std::uint32_t value = texture_.texel[texture_.entry_in(block_, cell, outer)];
      if (value == none) return {};
      return {value & ~RefinedGridView::extended, !(value & RefinedGridView::extended)};
    }

   private:
    const RefinedGridView& texture_;
    Int3 outer_{-1, -1, -1};
    std::uint32_t block_ = none;
  };
};

/// The same on the octree of bricks.
struct BrickStreaks {
  BrickOctreeView view;

  NACRE_HD_INLINE SurfaceFoot foot(CellIndex, const Int3& position) const {
    const CellPoint point = view.point[BrickOctreeView::Cursor(view).find(position)];
    return {point.offset(view.quantum), point.triangle};
  }

  class Cursor {
   public:
    NACRE_HD_INLINE explicit Cursor(const BrickStreaks& streaks) : view_(streaks.view), cursor_(view_) {}
    NACRE_HD_INLINE NearSurfaceCell find(const Int3& cell) {
      const CellIndex at = cursor_.find_surface(cell);
      if (at != no_cell) return {at, true};
      const CellIndex beside = cursor_.find(cell);
      if (beside == no_cell) return {};
      return {cursor_.find_surface(closest_point_of(cell, view_.point[beside], view_.quantum).cell()), false};
    }

   private:
    const BrickOctreeView& view_;
    BrickOctreeView::Cursor cursor_;
  };
};

/// Runs `kernel(surface_cell, place)` on all surface cells, of the grid or of the octree.
template <class Kernel>
struct OnGridStreaks {
  RefinedGridView texture;
  Kernel kernel;
  NACRE_HD void operator()(std::int64_t i) const { kernel(CellIndex(i), texture.cell(std::uint32_t(i))); }
};

template <class Kernel>
struct OnBrickStreaks {
  Kernel kernel;
  NACRE_HD void operator()(CellIndex s, CellIndex, const Int3& position, BrickOctreeView::Cursor&) const {
    kernel(s, position);
  }
};

template <class Backend, class Kernel>
void for_each_streak_cell(Executor<Backend>& exec, const GridStreaks& streaks, std::int64_t n, const Kernel& kernel) {
  exec.for_each(n, OnGridStreaks<Kernel>{streaks.texture, kernel});
}

template <class Backend, class Kernel>
void for_each_streak_cell(Executor<Backend>& exec, const BrickStreaks& streaks, std::int64_t, const Kernel& kernel) {
  for_each_surface_cell(exec, streaks.view, OnBrickStreaks<Kernel>{kernel});
}

/// Fills in the flow and the surface of each surface cell, from the triangle of its closest point: exact where vectors
/// kept on a coarser grid are blurred, and at creases.
template <class Streaks>
struct MarkStreakCells {
  Streaks streaks;
  MeshView mesh;
  double cell;           ///< edge of a texture cell in units of the mesh's points
  const Vec3f* vectors;  ///< one per point of the mesh, at the time of the frame
  float least;           ///< speed below which nothing flows
  StreakCell* cells;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    const SurfaceFoot foot = streaks.foot(s, position);
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

/// What streaks are made of: the mean of the values at a cell and one cell up and down the flow, less half of the mean
/// of those around. Without that they would be as wide as the lines that particles draw; less all of it they are
/// thinner than a cell and lose their way.
template <class Streaks>
struct HighPass {
  Streaks streaks;
  const float* value;  ///< 0..1
  StreakCell* cells;

  static constexpr float share = 0.5f;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    typename Streaks::Cursor cursor(streaks);
    const auto at = [&](const Int3& cell) {
      const NearSurfaceCell found = cursor.find(cell);
      return value[found.cell == no_cell ? s : found.cell] - 0.5f;
    };
    const float own = value[s] - 0.5f;
    float along = own, around = 0;
    if (const std::uint32_t direction = cells[s].direction) {
      const Vec3f d = PackedDirection::unpack(direction);
      const Vec3f p = Vec3f(0.5f) + PackedDirection::unpack(cells[s].normal) * cells[s].plane;
      along = 0.5f * own + 0.25f * (at(position + floor_cell(p + d)) + at(position + floor_cell(p - d)));
    }
    for (int k = 0; k < 6; ++k) {
      Int3 next = position;
      next[k / 2] += k & 1 ? 1 : -1;
      around += at(next);
    }
    cells[s].value = along - share * (around / 6);
  }
};

/// The mean of the values along the streamline through the closest point of a surface cell, `reach` cells each way or
/// to where the flow or the surface ends or turns back.
template <class Streaks>
struct ConvolveAlongFlow {
  Streaks streaks;
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
    const int steps = (reach + 1) / 2;
    const Vec3f along = PackedDirection::unpack(own.direction);
    const Vec3f start = Vec3f(0.5f) + PackedDirection::unpack(own.normal) * own.plane;
    for (int side = -1; side <= 1; side += 2) {
      typename Streaks::Cursor cursor(streaks);
      Vec3f p = start, d = along * float(side), before = d;
      for (int i = 0; i < steps; ++i) {
        p = p + d * 3.0f - before;  // two cells by Adams and Bashforth's second order: one direction a step
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
