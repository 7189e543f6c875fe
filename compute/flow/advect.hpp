// Nacre: particles that carry the texture along pathlines on the surface (sec. 5.2.2), on the grid.
#pragma once

#include "compute/flow/deposit.hpp"
#include "compute/flow/velocity.hpp"

namespace nacre {

/// The end of a path from `p` over the fraction `h` of a step from time `u` in it: by the midpoint rule where both of
/// its velocities agree to `straight` cells over the path, else by Runge and Kutta's fourth order. False where a stage
/// leaves the band.
NACRE_HD inline bool follow(const FlowField& field, const Vec3f& p, float u, float h, float straight, Vec3f& end) {
  Vec3f k1, k2, k3, k4;
  const float middle = u + 0.5f * h, last = u + h < 1 ? u + h : 1;
  if (!field.velocity(p, u, k1)) return false;
  if (!field.velocity(p + k1 * (0.5f * h), middle, k2)) return false;
  const Vec3f turn = (k2 - k1) * h;
  if (dot(turn, turn) < straight * straight) {
    end = p + k2 * h;
    return true;
  }
  if (!field.velocity(p + k2 * (0.5f * h), middle, k3)) return false;
  if (!field.velocity(p + k3 * h, last, k4)) return false;
  end = p + (k1 + (k2 + k3) * 2.0f + k4) * (h / 6.0f);
  return true;
}

#if defined(NACRE_PACKETS)
/// The same for several paths over a whole step, of those that `mask` has: which ones do not leave the band.
inline Packet::Mask follow_all(const FlowField& field, const Vec3<Packet::Float>& p, float straight, Packet::Mask mask,
                               Vec3<Packet::Float>& end) {
  const auto from = [&](const Vec3<Packet::Float>& k, float h) { return multiply_add(k, Packet::all(h), p); };
  const Vec3<Packet::Float> k1 = velocities(field, p, 0, mask), k2 = velocities(field, from(k1, 0.5f), 0.5f, mask);
  const Vec3<Packet::Float> turn = k2 - k1;
  Packet::Mask bent = mask & (fused_dot(turn, turn) >= straight * straight);
  end = p + k2;
  if (!any(bent)) return mask;
  const Packet::Mask straight_ones = mask & ~bent;
  const Vec3<Packet::Float> k3 = velocities(field, from(k2, 0.5f), 0.5f, bent);
  const Vec3<Packet::Float> k4 = velocities(field, from(k3, 1), 1, bent);
  const Vec3<Packet::Float> curved = from(k1 + multiply_add(k2 + k3, Packet::all(2.0f), k4), 1.0f / 6);
  end = {select(bent, curved.x, end.x), select(bent, curved.y, end.y), select(bent, curved.z, end.z)};
  return straight_ones | bent;
}
#endif

/// Moves all particles through a step. A cell holds those that arrived there and outlived the step before, and a new
/// one. They move along one path, from the cell's closest point, leave what they carry in the cells under it (Shen &
/// Kao 1997), and are handed over to the cell where it ends: so one path serves all ages (as in Liu & Moorhead 2005).
///
/// A piece of the path that ends off the surface is halved until it ends near it, projected (WENO4), drawn; then the
/// rest of the path follows, so that its total length is kept (Fig. 5.5). The end of the last piece is not projected
/// where a surface cell holds it.
struct MoveParticles {
  FlowField field;
  RefinedGridView texture;
  const float* carried;            ///< by new particles, per surface cell, 0..1
  const std::uint64_t* arrived;    ///< per surface cell: Deposit of the particles that begin the step there
  std::uint64_t *crossed, *ended;  ///< what paths leave, and where they end; zero before
  std::int64_t n;                  ///< surface cells
  int ttl;
  Vec3f rounding;  ///< how displacements are rounded to cells; see FlowMethodOn::rounding_of

  static constexpr float straight = 0.5f;       // texture cells
  static constexpr float near_surface = 0.6f;   // texture cells that a projection may move a point
  static constexpr float shortest = 1.0f / 64;  // of a step; shorter pieces are projected from wherever they end

  using Wide = Widest;  ///< as many particles move side by side
  using Float = Wide::Float;
  using Int = Wide::Int;
  using Mask = Wide::Mask;

  NACRE_HD void operator()(std::int64_t packet) const {
    const GridCells<Wide> cells(texture, packet * Wide::lanes, n);
    const Vec3<Float> centre = corners_of(cells.position) + Vec3<Float>(Wide::all(0.5f));
    Vec3<Float> start;
    std::uint64_t word[Wide::lanes];
    for (int lane = 0; lane < Wide::lanes; ++lane) {
      const auto home = std::uint32_t(element(cells.number, lane));
      const Float4 seed = texture.seed[home];
      set_element(start.x, lane, seed.x), set_element(start.y, lane, seed.y), set_element(start.z, lane, seed.z);
      word[lane] = Deposit::beginning(arrived[home], carried[home], ttl);
    }
    start = centre + start;
    Vec3<Float> end;
    const Mask own = counted<Wide>(0, INT32_MAX) < cells.count, moved = go_in_one_piece(start, word, own, end);
    for (int lane = 0; lane < cells.count; ++lane) {
      if (is_set(moved, lane)) continue;
      const Vec3f there = walk({element(start.x, lane), element(start.y, lane), element(start.z, lane)}, word[lane]);
      set_element(end.x, lane, there.x), set_element(end.y, lane, there.y), set_element(end.z, lane, there.z);
    }
    const auto surface_cells = [&](const Vec3<Float>& p, Mask mask) {
      return SurfaceCellCursors<Wide>(texture).texel(cells_of(p), mask);
    };
    const Vec3<Float> shift{Wide::all(rounding.x), Wide::all(rounding.y), Wide::all(rounding.z)};
    const Int rounded = surface_cells(centre + (end - start) + shift, own);
    const Int exact = any(own & (rounded == -1)) ? surface_cells(end, own) : rounded;
    for (int lane = 0; lane < cells.count; ++lane) {
      const auto texel = std::uint32_t(element(element(rounded, lane) == -1 ? exact : rounded, lane));
      const std::uint32_t home = element(cells.number, lane);
      atomic_add(ended + (texel == none ? home : texel & ~RefinedGridView::extended), word[lane]);
    }
  }

  /// Where the path from `start` ends; both in texture cells.
  NACRE_HD Vec3f walk(const Vec3f& start, std::uint64_t word) const {
    const float scale = float(texture.refine);
    Vec3f p = start * texture.inverse_refine;
    float u = 0, h = 1;
    while (u < 1) {
      h = h < 1 - u ? h : 1 - u;
      Vec3f end;
      bool moved = follow(field, p, u, h, straight * texture.inverse_refine, end);
      Vec3f landed = end;
      bool near = moved && u + h >= 1 && is_on_surface(end * scale);
      if (!near) {
        moved = moved && project(field.grid, end, landed);
        const Vec3f off = (landed - end) * scale;
        near = moved && dot(off, off) <= near_surface * near_surface;
      }
      if (!near) {
        if (h > shortest) {
          h *= 0.5f;
          continue;
        }
        if (!moved) break;  // off the rim of an open surface: the path ends there
      }
      deposit_line(texture, crossed, p * scale, landed * scale, word);
      p = landed;
      u += h;
      h = 1;
    }
    return p * scale;
  }

#if defined(NACRE_PACKETS)
  /// Moves the particles of a packet whose paths are one piece, most of them, as `walk` does: which ones, and where
  /// they end.
  Mask go_in_one_piece(const Vec3<Float>& start, const std::uint64_t* word, Mask own, Vec3<Float>& end) const {
    const Vec3<Float> p = start * Wide::all(texture.inverse_refine);
    Vec3<Float> there;
    Mask arrive = follow_all(field, p, straight * texture.inverse_refine, own, there);
    end = there * Wide::all(float(texture.refine));
    SurfaceCellCursors<Wide> cursor(texture);
    arrive = arrive & (cursor.texel(cells_of(end), arrive) >= 0);  // the surface passes through it
    deposit_lines(start, end, word, arrive);
    return arrive;
  }

  /// `deposit_line` for those of a packet that `mask` has.
  void deposit_lines(const Vec3<Float>& a, const Vec3<Float>& b, const std::uint64_t* word, Mask mask) const {
    const Vec3<Int> from = cells_of(a), to = cells_of(b);
    const auto larger = [](const Int& x, const Int& y) { return select(x > y, x, y); };
    const auto size = [&](const Int& x) { return larger(x, -x); };
    const Int cells = larger(size(to.x - from.x), larger(size(to.y - from.y), size(to.z - from.z)));
    const Float step = Wide::all(1.0f) / to_float(larger(cells, Wide::all(1)));
    const Vec3<Float> d = b - a;
    SurfaceCellCursors<Wide> cursor(texture);
    for (int i = 1;; ++i) {
      mask = mask & (cells >= i);
      if (!any(mask)) return;
      const Int texel = cursor.texel(cells_of(multiply_add(d, step * float(i), a)), mask);
      for (int lane = 0; lane < Wide::lanes; ++lane)
        if (texel[lane] != -1)
          atomic_add(crossed + (std::uint32_t(texel[lane]) & ~RefinedGridView::extended), word[lane]);
    }
  }
#else
  NACRE_HD_INLINE static Mask go_in_one_piece(const Vec3f&, const std::uint64_t*, Mask, Vec3f&) { return false; }
#endif

  NACRE_HD bool is_on_surface(const Vec3f& p) const {
    const std::uint32_t at = texture.entry(floor_cell(p));
    return at != none && !(texture.texel[at] & RefinedGridView::extended);
  }
};

}  // namespace nacre
