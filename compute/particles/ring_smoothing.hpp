// Nacre: particles that move within the rings of triangles around them, for the triangles' shape alone.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/random.hpp"
#include "compute/meshing/triangle_rings.hpp"
#include "compute/particles/projectors.hpp"
#include "compute/particles/smoothing_rule.hpp"

namespace nacre {

namespace detail {

/// How ill-shaped a triangle is, by its apex in the plane: x along the side of length u opposite, measured from its
/// middle, y across, with derivatives. The inverse of the mean ratio, f = (sum of squared sides) / (4 sqrt(3) area): 1
/// where it is equilateral, infinite where it is flat, and convex in (x, y) for y > 0 (Knupp 2001, algebraic mesh
/// quality).
struct InverseMeanRatio {
  float fx, fy, fxx, fxy, fyy;
  NACRE_HD InverseMeanRatio(float x, float y, float u) {
    const float k = 1 / (2 * 1.7320508f * u * y);
    fx = 4 * x * k;
    fy = (2 * y * y - 2 * x * x - 1.5f * u * u) * k / y;
    fxx = 4 * k;
    fxy = -4 * x * k / y;
    fyy = (4 * x * x + 3 * u * u) * k / (y * y);
  }
};

/// One simultaneous step of every particle that has a ring: `share` of Newton's on the sum of f over its triangles, in
/// the tangent plane of its surface or along its curve. Points stay.
struct RingStep {
  const std::uint32_t* first;  ///< per particle, one more at the end: of its edges
  const RingEdge* edge;
  const std::uint8_t* order;  ///< per interface
  const std::uint32_t* interface;
  const Float4* from;
  const Float4* direction;
  std::uint32_t shake = 0;  ///< not 0: a step at random instead, by this seed

  static constexpr float share = 0.8f;
  static constexpr float longest = 0.3f;  ///< step, by the smallest height of the ring's triangles

  NACRE_HD Vec3f operator()(std::int64_t i) const {
    const std::uint8_t dimension = order[interface[i]];
    if (dimension == 0 || first[i] == first[i + 1]) return {};
    const Float4 d = direction[i];
    return step(i, position(std::uint32_t(i)), Vec3f(d.x, d.y, d.z), dimension == 2, from[i].w);
  }

  NACRE_HD Vec3f position(std::uint32_t k) const { return {from[k].x, from[k].y, from[k].z}; }

 private:
  NACRE_HD float random(std::int64_t i, std::uint32_t axis) const {
    return 2 * uniform_random(shake, std::uint32_t(i), axis) - 1;
  }

  NACRE_HD Vec3f step(std::int64_t i, const Vec3f& p, const Vec3f& n, bool on_surface, float h) const {
    const Vec3f helper = std::fabs(n.x) < 0.6f ? Vec3f(1, 0, 0) : Vec3f(0, 1, 0);
    const Vec3f s = on_surface ? normalized(cross(n, helper)) : n, t = on_surface ? cross(n, s) : Vec3f();
    float gs = 0, gt = 0, hss = 0, hst = 0, htt = 0, least = h;
    for (std::uint32_t c = first[i]; c < first[i + 1]; ++c) {
      const Vec3f a = position(edge[c].a), side = position(edge[c].b) - a;
      const float u = length(side);
      if (!(u > 1e-6f)) continue;
      const Vec3f along = side / u, r = p - a - side * 0.5f;
      const float x = dot(r, along);
      const Vec3f up = r - along * x;
      const float y = length(up);
      if (!(y > 1e-3f * u)) continue;
      least = min(least, y);
      const InverseMeanRatio f(x, y, u);
      const float xs = dot(along, s), xt = dot(along, t), ys = dot(up, s) / y, yt = dot(up, t) / y;
      gs += f.fx * xs + f.fy * ys;
      gt += f.fx * xt + f.fy * yt;
      hss += f.fxx * xs * xs + 2 * f.fxy * xs * ys + f.fyy * ys * ys;
      hst += f.fxx * xs * xt + f.fxy * (xs * yt + xt * ys) + f.fyy * ys * yt;
      htt += f.fxx * xt * xt + 2 * f.fxy * xt * yt + f.fyy * yt * yt;
    }
    if (shake != 0) return (s * random(i, 0) + t * random(i, 1)) * (longest * least);
    Vec3f v;
    if (on_surface) {
      const float determinant = hss * htt - hst * hst;
      if (!(determinant > 1e-6f * hss * htt)) return {};
      v = (s * (hst * gt - htt * gs) + t * (hst * gs - hss * gt)) * (share / determinant);
    } else if (hss > 0) {
      v = s * (-share * gs / hss);
    }
    const float size = length(v), most = longest * least;
    return size > most ? v * (most / size) : v;
  }
};

/// A step that does not end on the interface: the first of two.
struct SlideInRing {
  RingStep step;
  Float4* to;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = step.position(std::uint32_t(i)) + step(i);
    to[i] = {p.x, p.y, p.z, step.from[i].w};
  }
};

/// A step from where the particles have slid to, and back onto their interface. Particles that would leave it go half
/// as far, or stay where they were before both steps.
template <class Projector>
struct SettleInRing {
  RingStep step;
  Projector projector;
  Float4* position;  ///< from before both steps
  Float4* direction;
  float* margin;  ///< the interface goes on at least so far around the particle, voxels; 0: not known

  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 at = position[i], d = direction[i];
    const std::uint32_t group = step.interface[i];
    const Vec3f p(at.x, at.y, at.z);
    Vec3f v = step.position(std::uint32_t(i)) + step(i) - p;
    EmbeddedPoint on;
    if (!(dot(v, v) > 1e-8f * at.w * at.w)) return;
    if (!arrives(i, p, v, at.w, on)) {
      v *= 0.5f;
      if (!arrives(i, p, v, at.w, on)) return;
    }
    const float sign = step.order[group] == 1 && dot(on.direction, Vec3f(d.x, d.y, d.z)) < 0 ? -1.0f : 1.0f;
    position[i] = {on.p.x, on.p.y, on.p.z, on.h};
    direction[i] = {sign * on.direction.x, sign * on.direction.y, sign * on.direction.z, d.w};
    margin[i] = on.margin;
  }

  NACRE_HD bool arrives(std::int64_t i, const Vec3f& p, const Vec3f& v, float h, EmbeddedPoint& on) const {
    if (!projector.project(step.interface[i], p + v, h, on, margin[i] - margin_slope * length(v))) return false;
    const Vec3f off = on.p - p - v;
    return on.margin >= 0 && dot(off, off) < 0.25f * h * h;
  }
};

/// Memory to move `particles` within rings of `edges` sides, in an Arena or an AllocationPlan.
struct SmoothingScratch {
  Array<std::uint32_t> first;
  Array<RingEdge> edge;
  Array<Float4> slid;
  Array<float> margin;

  template <class Memory>
  SmoothingScratch(Memory& memory, std::size_t particles, std::size_t edges)
      : first(memory.template temporary<std::uint32_t>(particles + 1)),
        edge(memory.template temporary<RingEdge>(edges)),
        slid(memory.template temporary<Float4>(particles)),
        margin(memory.template temporary<float>(particles)) {}
};

}  // namespace detail
}  // namespace nacre
