// Nacre: diffusion on a surface by the closest point method, with a tensor along vectors (docs/method/
// reaction-diffusion.md).
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/math/selling.hpp"

namespace nacre {

/// Two values of a cell: what reacts and diffuses.
struct alignas(8) Pair {
  float u, v;
};

/// Half width of the band that diffusion needs, in cells: a cubic stencil on the surface reaches 2 cells along each
/// axis, and the 26 neighbours one more: 3 sqrt 3. (With the 6 neighbours of an isotropic operator alone it would be
/// sqrt(2^2 + 2^2 + 3^2) = 4.12, Ruuth & Merriman 2008.)
inline constexpr double diffusion_radius = 5.2;

/// Weights of cubic interpolation (Lagrange) at `x` in [0, 1] between the second and the third of four samples.
struct LagrangeWeights {
  float of[4];
  NACRE_HD_INLINE explicit LagrangeWeights(float x) {
    const float a = x + 1, b = x - 1, c = x - 2;
    of[0] = -x * b * c * (1.0f / 6);
    of[1] = a * b * c * 0.5f;
    of[2] = -a * x * c * 0.5f;
    of[3] = a * x * b * (1.0f / 6);
  }
};

/// The 4^3 cells around a point, for cubic interpolation.
struct CubicCells {
  Stencil<4> stencil;
  Vec3f f;  ///< of the point from the centre of cell 1, 0..1

  /// False where a brick is missing.
  NACRE_HD_INLINE bool find(const ClosestPointGridView& grid, const Vec3f& p) {
    const Int3 lower = floor_cell(p - Vec3f(0.5f));
    f = p - cell_centre(lower);
    return stencil.find(grid, lower - Int3(1));
  }

  NACRE_HD_INLINE Pair interpolate(const ClosestPointGridView& grid, const Pair* values) const {
    const LagrangeWeights wx(f.x), wy(f.y), wz(f.z);
    std::uint32_t column[4];
    for (int a = 0; a < 4; ++a)
      column[a] = std::uint32_t(stencil.local[0] + a - (a >= stencil.split[0] ? grid.sub : 0));
    Lanes low = lanes(0, 0, 0), high = low;  // u, v of the first two columns and of the last two
    for (int c = 0; c < 4; ++c) {
      const int hz = c >= stencil.split[2], z = stencil.local[2] + c - hz * grid.sub;
      for (int b = 0; b < 4; ++b) {
        const int hy = b >= stencil.split[1], y = stencil.local[1] + b - hy * grid.sub;
        const std::uint32_t line = std::uint32_t((z * grid.sub + y) * grid.sub);
        const Pair* lower = values + stencil.base[hz][hy][0] + line;
        const Pair* upper = stencil.split[0] < 4 ? values + stencil.base[hz][hy][1] + line : lower;
        const Pair p = lower[column[0]], q = (1 < stencil.split[0] ? lower : upper)[column[1]];
        const Pair r = (2 < stencil.split[0] ? lower : upper)[column[2]];
        const Pair s = (3 < stencil.split[0] ? lower : upper)[column[3]];
        const float w = wy.of[b] * wz.of[c];
        low = low + lanes(p.u, p.v, q.u, q.v) * w;
        high = high + lanes(r.u, r.v, s.u, s.v) * w;
      }
    }
    const Lanes sum =
        low * lanes(wx.of[0], wx.of[0], wx.of[1], wx.of[1]) + high * lanes(wx.of[2], wx.of[2], wx.of[3], wx.of[3]);
    const Float4 all = store(sum);
    return {all.x + all.z, all.y + all.w};
  }
};

/// Closest point of the cell at `at`, in cells.
NACRE_HD_INLINE Vec3f closest_point_of(const ClosestPointGridView& grid, std::uint32_t at) {
  const Float4 o = grid.offset[at];
  return cell_centre(grid.cell(at)) + Vec3f(o.x, o.y, o.z);
}

namespace detail {

/// Flags the cells that interpolation at the closest points of the band needs.
struct FlagInterpolated {
  ClosestPointGridView grid;
  float reach;
  std::uint32_t* flag;
  NACRE_HD void operator()(std::int64_t i) const {
    if (!(grid.offset[i].w <= reach)) return;
    CubicCells cells;
    if (!cells.find(grid, closest_point_of(grid, std::uint32_t(i)))) return;
    for (int c = 0; c < 4; ++c)
      for (int b = 0; b < 4; ++b)
        for (int a = 0; a < 4; ++a) relaxed_store(flag + cells.stencil.address(grid, a, b, c), 1);
  }
};

/// Flags the inner cells and their 26 neighbours, which the band holds.
struct FlagNeighbours {
  ClosestPointGridView grid;
  const std::uint32_t* inner;
  std::uint32_t* flag;
  NACRE_HD void operator()(std::int64_t i) const {
    if (!inner[i]) return;
    Stencil<3> around;
    if (!around.find(grid, grid.cell(std::uint32_t(i)) - Int3(1))) return;
    for (int n = 0; n <= GridSteps::neighbours; ++n)
      relaxed_store(flag + around.address(grid, n % 3, n / 3 % 3, n / 9), 1);
  }
};

struct ListFlagged {
  const std::uint32_t* flag;
  const std::uint32_t* number;  ///< exclusive scan of the flags
  std::uint32_t* list;
  NACRE_HD void operator()(std::int64_t i) const {
    if (flag[i]) list[number[i]] = std::uint32_t(i);
  }
};

}  // namespace detail

/// The cells that diffusion works on, by address, ascending.
struct DiffusionBand {
  Array<std::uint32_t> inner;  ///< whose values interpolation on the surface reads: the operator is computed there
  Array<std::uint32_t> outer;  ///< these and their 26 neighbours: they get the values of their closest points

  std::uint64_t bytes() const { return inner.bytes() + outer.bytes(); }
};

/// Lists the cells of a grid whose radius is at least `diffusion_radius`. Permanent in the executor's arena.
template <class Backend>
DiffusionBand find_diffusion_band(Executor<Backend>& exec, const ClosestPointGridView& grid, std::uint64_t cells) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  Array<std::uint32_t> inner = arena.temporary<std::uint32_t>(cells), outer = arena.temporary<std::uint32_t>(cells);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(cells);
  inner.fill_bytes(0);
  outer.fill_bytes(0);
  const auto n = std::int64_t(cells);
  const auto list = [&](const Array<std::uint32_t>& flag) {
    const std::uint32_t count = exec.exclusive_scan(flag.data(), number.data(), n);
    const Array<std::uint32_t> all = arena.permanent<std::uint32_t>(count);
    exec.for_each(n, detail::ListFlagged{flag.data(), number.data(), all.data()});
    return all;
  };
  DiffusionBand band;
  exec.for_each(n, detail::FlagInterpolated{grid, float(diffusion_radius), inner.data()});
  band.inner = list(inner);
  exec.for_each(n, detail::FlagNeighbours{grid, inner.data(), outer.data()});
  band.outer = list(outer);
  return band;
}

/// How much farther than across diffusion goes along vectors, by their speed: I + extra t t^T, where
/// extra = (1 + (stretch - 1) s)^2 - 1 and s = v^2 / (v^2 + slow^2). It is smooth where vectors vanish.
struct StretchBySpeed {
  float stretch = 1;
  float slow = 1;  ///< the speed at which half of the stretch is reached; 0: nothing moves

  NACRE_HD float operator()(float speed) const {
    const float square = speed * speed, s = slow > 0 ? square / (square + slow * slow) : 0.0f;
    const float length = 1 + (stretch - 1) * s;
    return length * length - 1;
  }
};

/// The tensor at the closest point of each outer cell, as weights of the 13 directions.
struct WeighDirections {
  MeshView mesh;
  ClosestPointGridView grid;
  const std::uint32_t* outer;
  const Vec3f* vectors;  ///< one per point of the mesh
  StretchBySpeed stretch;
  float* weight;  ///< 13 per cell of the grid

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = outer[i], t = grid.triangle[at];
    const Float4 o = grid.offset[at];
    const Vec3d p = Vec3d(grid.cell(at)) + Vec3d(0.5) + Vec3d(o.x, o.y, o.z);
    const Vec3f w = barycentric_in_float(mesh.corners(t), p);
    const Vec3f along = mesh.tangential(vectors, t, w);
    const float speed = length(along);
    const bool moves = speed > 1e-6f * stretch.slow && std::isfinite(speed);
    selling_weights(moves ? along / speed : Vec3f{}, moves ? stretch(speed) : 0.0f,
                    weight + std::size_t(at) * GridSteps::directions);
  }
};

/// Where the rows of the operator are: 27 weights for each inner cell, in the order of GridSteps, of 32 cells at a time
/// interleaved, so that neighbouring threads of a GPU read neighbouring numbers.
struct OperatorRows {
  static constexpr int weights = GridSteps::neighbours + 1, together = 32;
  float* data;

  static std::size_t size(std::size_t cells) { return (cells + together - 1) / together * (together * weights); }
  /// The first weight of a row; the others follow at distances of `together`.
  NACRE_HD_INLINE float* row(std::int64_t i) const {
    return data + std::size_t(i / together) * (together * weights) + std::size_t(i % together);
  }
};

/// The operator's row at each inner cell: the weight of a neighbour is the mean of those at both ends, so that a step
/// counts alike from either side (the divergence form). That of the cell itself makes the sum 0.
struct WeighNeighbours {
  ClosestPointGridView grid;
  const std::uint32_t* inner;
  const float* weight;  ///< of WeighDirections
  OperatorRows rows;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = inner[i];
    Stencil<3> around{};
    around.find(grid, grid.cell(at) - Int3(1));
    float* out = rows.row(i);
    float sum = 0;
    for (int n = 0; n <= GridSteps::neighbours; ++n) {
      if (n == GridSteps::middle) continue;
      const int d = GridSteps::direction(n);
      const std::uint32_t there = around.address(grid, n % 3, n / 3 % 3, n / 9);
      const float w = 0.5f * (weight[std::size_t(at) * GridSteps::directions + d] +
                              weight[std::size_t(there) * GridSteps::directions + d]);
      out[n * OperatorRows::together] = w;
      sum += w;
    }
    out[GridSteps::middle * OperatorRows::together] = -sum;
  }
};

/// Sum of a row's weights of neighbours: by Gershgorin's theorem the operator's eigenvalues lie between minus twice the
/// largest one and 0.
struct RowSum {
  OperatorRows rows;
  NACRE_HD float operator()(std::int64_t i) const { return -rows.row(i)[GridSteps::middle * OperatorRows::together]; }
};

struct Larger {
  NACRE_HD float operator()(float a, float b) const { return a < b ? b : a; }
};

/// How two values diffuse: diffusivities across the vectors, cells^2 per time, and the share of the tensor's extra part
/// that each of them has (0: isotropic).
struct Diffusivities {
  float u = 1, v = 1;
  float share_u = 1, share_v = 1;
};

/// The largest rate at which diffusion takes a value away, of u and of v: the sum of a row.
struct DiffusionRates {
  double u, v;
  DiffusionRates(const Diffusivities& d, double largest_row)
      : u(d.u * (d.share_u * largest_row + (1 - d.share_u) * 6)),
        v(d.v * (d.share_v * largest_row + (1 - d.share_v) * 6)) {}
};

/// The change of each inner cell's values in a step, and the part of the values that is extended anew with it.
template <class Reaction>
struct ReactAndDiffuse {
  ClosestPointGridView grid;
  const std::uint32_t* inner;
  OperatorRows rows;
  Diffusivities diffusivities;
  Reaction reaction;
  float step;   ///< time
  float renew;  ///< share of the values that is extended anew in a step
  const Pair* value;
  Pair* change;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = inner[i];
    Stencil<3> around;
    around.find(grid, grid.cell(at) - Int3(1));
    const float* weight = rows.row(i);
    const auto w = [&](int n) { return weight[n * OperatorRows::together]; };
    const Pair own = value[at];
    const int sub = grid.sub;
    Lanes two = lanes(0, 0, 0), third = two, axes = lanes(-6 * own.u, -6 * own.v, 0);
    for (int r = 0; r < 9; ++r) {  // rows of three cells: two together, and one
      const int hy = r % 3 >= around.split[1], hz = r / 3 >= around.split[2];
      const int y = around.local[1] + r % 3 - hy * sub, z = around.local[2] + r / 3 - hz * sub;
      const std::int64_t line = (z * sub + y) * sub, lower = around.base[hz][hy][0] + line + around.local[0];
      const std::int64_t upper = around.split[0] < 3 ? around.base[hz][hy][1] + line - around.split[0] : lower;
      const Pair a = value[lower], b = value[(1 < around.split[0] ? lower : upper) + 1];
      const Pair c = value[(2 < around.split[0] ? lower : upper) + 2];
      two = two + lanes(a.u, a.v, b.u, b.v) * lanes(w(3 * r), w(3 * r), w(3 * r + 1), w(3 * r + 1));
      third = third + lanes(c.u, c.v, 0) * w(3 * r + 2);
      if (r == 4) axes = axes + lanes(a.u + c.u, a.v + c.v, 0);
      if (r == 1 || r == 3 || r == 5 || r == 7) axes = axes + lanes(b.u, b.v, 0);
    }
    const Float4 t = store(two), e = store(third), x = store(axes);
    const float tensor_u = t.x + t.z + e.x, tensor_v = t.y + t.w + e.y;
    const Diffusivities& d = diffusivities;
    const Pair r = reaction(own);
    const float u = d.u * (d.share_u * tensor_u + (1 - d.share_u) * x.x);
    const float v = d.v * (d.share_v * tensor_v + (1 - d.share_v) * x.y);
    change[at] = {step * (u + r.u) + renew * own.u, step * (v + r.v) + renew * own.v};
  }
};

/// Closest-point extension of the changes to every outer cell (explicit embedded method of lines: von Glehn, Maerz &
/// Macdonald, arXiv:1307.5657).
struct ExtendChange {
  ClosestPointGridView grid;
  const std::uint32_t* outer;
  float renew, most;  ///< values stay within -most..most
  const Pair* change;
  Pair* value;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = outer[i];
    CubicCells cells;
    if (!cells.find(grid, closest_point_of(grid, at))) return;
    const Pair d = cells.interpolate(grid, change);
    const float u = value[at].u * (1 - renew) + d.u, v = value[at].v * (1 - renew) + d.v;
    value[at] = {min(max(u, -most), most), min(max(v, -most), most)};
  }
};

/// The operator of diffusion along given vectors, and a step with it.
template <class Backend>
class SurfaceDiffusion {
 public:
  SurfaceDiffusion() = default;

  /// Arrays for a grid of `cells` cells: permanent in the arena.
  SurfaceDiffusion(Executor<Backend>& exec, const ClosestPointGridView& grid, std::uint64_t cells,
                   const DiffusionBand& band)
      : grid_(grid), cells_(cells), band_(band) {
    row_ = exec.arena().template permanent<float>(OperatorRows::size(band.inner.size()));
  }

  /// Takes the vectors of this time. `vectors`: one per point of the mesh.
  void weigh(Executor<Backend>& exec, const MeshView& mesh, const Vec3f* vectors, const StretchBySpeed& stretch) {
    Arena::Scope scope(exec.arena());
    const auto weight = exec.arena().template temporary<float>(cells_ * GridSteps::directions);
    exec.for_each(outer(), WeighDirections{mesh, grid_, band_.outer.data(), vectors, stretch, weight.data()});
    exec.for_each(inner(), WeighNeighbours{grid_, band_.inner.data(), weight.data(), rows()});
    largest_row_ = exec.reduce(inner(), 0.0f, RowSum{rows()}, Larger());
  }

  /// Cells^-2, for diffusivity 1: 6 without vectors.
  double largest_row() const { return largest_row_; }

  template <class Reaction>
  void step(Executor<Backend>& exec, const Diffusivities& diffusivities, const Reaction& reaction, float step,
            float renew, float most, Pair* value, Pair* change) const {
    exec.for_each(inner(), ReactAndDiffuse<Reaction>{grid_, band_.inner.data(), rows(), diffusivities, reaction, step,
                                                     renew, value, change});
    exec.for_each(outer(), ExtendChange{grid_, band_.outer.data(), renew, most, change, value});
  }

 private:
  OperatorRows rows() const { return {row_.data()}; }
  std::int64_t inner() const { return std::int64_t(band_.inner.size()); }
  std::int64_t outer() const { return std::int64_t(band_.outer.size()); }

  ClosestPointGridView grid_;
  std::uint64_t cells_ = 0;
  DiffusionBand band_;
  Array<float> row_;
  double largest_row_ = 0;
};

}  // namespace nacre
