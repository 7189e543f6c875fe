// Nacre: onto the junctions of a field of materials by their inside/outside functions (sec. 3.6): one lane, or a team
// that spreads the materials over its lanes (Fig. 3.12).
#pragma once

#include "compute/field/interface.hpp"
#include "compute/field/smooth_maximum.hpp"

namespace nacre {

/// As many materials take part in a smooth maximum; where a block lists more, the junction's own and the strongest
/// others.
inline constexpr int mixed_materials = 16;

/// A team of one, for code that is written for teams.
struct OneLane {
  template <class Body>
  NACRE_HD_INLINE void each(int n, const Body& body) {
    for (int k = 0; k < n; ++k) body(k);
  }
  template <class T, class Get>
  NACRE_HD_INLINE T sum(int n, const T& zero, const Get& get) {
    T total = zero;
    for (int k = 0; k < n; ++k) total = total + get(k);
    return total;
  }
  NACRE_HD bool first() const { return true; }
  NACRE_HD void wait() {}
};

namespace detail {

/// How the step leaves J, where the equations of the junction do not say: down its gradient (Eq. 3.5, sign corrected).
NACRE_HD inline bool indicator_step(const FieldSample& j, Vec3f& step) {
  const float gg = dot(j.gradient, j.gradient);
  if (!(gg > 1e-12f)) return false;
  step = j.gradient * (-j.value / gg);
  return true;
}

/// The materials that matter at a position: the junction's first, then the other ones of the block. When there are too
/// many, the version with one lane keeps the strongest.
class MaterialMix {
 public:
  NACRE_HD MaterialMix(const MaterialBricksView& field, const Junction& junction, const Vec3f& p)
      : field_(field), junction_(junction), stencil_(field, p), own_(junction.materials()) {
    const std::int64_t block = field.block_at(p);
    first_ = field.block_start[block], last_ = field.block_start[block + 1];
    total_ = own_;
    for (std::uint32_t k = first_; k < last_; ++k) total_ += junction.has(field.brick_material[k]) ? 0 : 1;
  }

  /// Samples them all, each once, into memory that the group shares; returns how many.
  template <class Group>
  NACRE_HD int sample(Group& group, FieldSample* f) const {
    if (total_ > mixed_materials) {
      group.each(1, [&](int) { sample_strongest(f); });
      return mixed_materials;
    }
    group.each(total_, [&](int k) { f[k] = stencil_.sample(field_, material(k)); });
    return total_;
  }

 private:
  NACRE_HD std::uint32_t material(int k) const {
    if (k < own_) return junction_.material(k);
    std::uint32_t at = first_;
    for (k -= own_;; ++at)
      if (!junction_.has(field_.brick_material[at]) && k-- == 0) return field_.brick_material[at];
  }

  NACRE_HD void sample_strongest(FieldSample* f) const {
    int n = 0;
    for (; n < own_; ++n) f[n] = stencil_.sample(field_, junction_.material(n));
    for (std::uint32_t k = first_; k < last_; ++k) {
      if (junction_.has(field_.brick_material[k])) continue;
      const FieldSample s = stencil_.sample(field_, field_.brick_material[k]);
      if (n < mixed_materials) {
        f[n++] = s;
        continue;
      }
      int weakest = own_;
      for (int i = own_ + 1; i < n; ++i)
        if (f[i].value < f[weakest].value) weakest = i;
      if (s.value > f[weakest].value) f[weakest] = s;
    }
  }

  const MaterialBricksView& field_;
  Junction junction_;
  CubicStencil stencil_;
  int own_, total_;
  std::uint32_t first_, last_;
};

}  // namespace detail

/// Inside/outside functions of the junction's materials at `p`, into inside[0] .. inside[junction.materials() - 1]. The
/// look-ups are made once into `shared` (mixed_materials samples); for each material of the junction the others' shares
/// are then spread over the lanes, its own sample being the one left out.
template <class Group>
NACRE_HD inline void inside_outside_at(Group& group, FieldSample* shared, const MaterialBricksView& field,
                                       const Junction& junction, const Vec3f& p, FieldSample* inside) {
  const int m = detail::MaterialMix(field, junction, p).sample(group, shared);
  for (int i = 0; i < junction.materials(); ++i) {
    const float reference = shared[i == 0 ? 1 : 0].value;
    const SmoothShare all = group.sum(
        m, SmoothShare{}, [&](int k) { return k == i ? SmoothShare{} : smooth_share(shared, m, i, k, reference); });
    const FieldSample others = smooth_maximum(all, reference);
    inside[i] = {shared[i].value - others.value, shared[i].gradient - others.gradient};
  }
  group.wait();  // before the next look-ups overwrite these
}

/// Newton's method onto the junction from `p`, by inside/outside functions: up to 10 steps of at most half a voxel
/// along the projection vectors (Eq. 3.12) until the cell indicator J is below 1e-5 (2 or 3 materials) or 1e-4 (4).
/// Unlike `project` of interface.hpp this also tests the other materials: false where one of them covers the position,
/// or where the junction is not within `reach` voxels of `p`. All lanes of the group get the same answer.
template <class Group>
NACRE_HD inline bool project_by_indicator(Group& group, FieldSample* shared, const MaterialBricksView& field,
                                          const Junction& junction, const Vec3f& p, float reach, JunctionPoint& at) {
  const int count = junction.materials();
  const float tolerance = count == 4 ? 1e-4f : 1e-5f;
  at.p = p;
  for (int k = 0; k <= 10; ++k) {
    if (!field.inside(at.p, 2.5f)) return false;
    FieldSample inside[4];
    inside_outside_at(group, shared, field, junction, at.p, inside);
    const FieldSample j = cell_indicator(inside, count);
    // Differences of inside/outside functions are twice those of the materials' own functions.
    for (int i = 0; i < count; ++i) inside[i] = {0.5f * inside[i].value, inside[i].gradient * 0.5f};
    Vec3f step;
    const bool direct = detail::junction_step(inside, count, step, at);
    if (j.value < tolerance) return direct;
    if (k == 10 || (!direct && !detail::indicator_step(j, step))) return false;
    const float size = length(step);
    at.p += size > 0.5f ? step * (0.5f / size) : step;
    if (dot(at.p - p, at.p - p) > reach * reach) return false;
  }
  return false;
}

/// The same in one lane.
NACRE_HD inline bool project_by_indicator(const MaterialBricksView& field, const Junction& junction, const Vec3f& p,
                                          float reach, JunctionPoint& at) {
  OneLane alone;
  FieldSample shared[mixed_materials];
  return project_by_indicator(alone, shared, field, junction, p, reach, at);
}

}  // namespace nacre
