// Nacre: flow maps on a surface, and the finite-time Lyapunov exponents that follow from them.
#include "compute/transport/flow_map.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compute/device/error.hpp"
#include "compute/transport/pathlines.hpp"

namespace nacre {
namespace {

/// A list of numbers for each vertex.
struct Lists {
  std::vector<std::uint32_t> start, item;
  std::span<const std::uint32_t> of(std::size_t v) const {
    return {item.data() + start[v], item.data() + start[v + 1]};
  }
};

/// The corners of each vertex, ascending.
Lists fans_of(const TangentField& surface) {
  Lists fans;
  fans.start.assign(surface.vertices() + 1, 0);
  const auto corners = std::uint32_t(3 * surface.triangles());
  for (std::uint32_t c = 0; c < corners; ++c) ++fans.start[surface.vertex(c) + 1];
  for (std::size_t v = 0; v < surface.vertices(); ++v) fans.start[v + 1] += fans.start[v];
  std::vector<std::uint32_t> next(fans.start.begin(), fans.start.end() - 1);
  fans.item.resize(corners);
  for (std::uint32_t c = 0; c < corners; ++c) fans.item[next[surface.vertex(c)]++] = c;
  return fans;
}

Lists neighbours_of(const TangentField& surface, const Lists& fans) {
  Lists rings;
  rings.start.push_back(0);
  std::vector<std::uint32_t> ring;
  for (std::size_t v = 0; v < surface.vertices(); ++v) {
    ring.clear();
    for (const std::uint32_t c : fans.of(v))
      for (const std::uint32_t other : {TangentField::next(c), TangentField::previous(c)})
        ring.push_back(surface.vertex(other));
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    rings.item.insert(rings.item.end(), ring.begin(), ring.end());
    rings.start.push_back(std::uint32_t(rings.item.size()));
  }
  return rings;
}

/// Two unit vectors across a unit normal.
struct Plane {
  Vec3d x, y;
  explicit Plane(const Vec3d& normal) {
    x = normalized(cross(std::fabs(normal.x) < 0.7 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), normal));
    y = cross(normal, x);
  }
  /// As long as in space.
  Vec2d operator()(const Vec3d& d) const {
    const Vec2d flat{dot(d, x), dot(d, y)};
    return normalized(flat) * length(d);
  }
};

/// The shape at one time, and what is where on it.
struct Moment {
  double time = 0;
  std::vector<Vec3d> position, normal;  ///< of particles
};

class FlowMaps {
 public:
  FlowMaps(const FlowOnSurface& flow, const std::atomic<bool>* stop)
      : flow_(flow),
        stop_(stop),
        surface_(flow.points, flow.triangles, std::vector<Vec3f>(flow.points.size())),
        fans_(fans_of(surface_)),
        rings_(neighbours_of(surface_, fans_)),
        pathlines_(surface_) {}

  FlowMap run() {
    const std::size_t n = surface_.vertices();
    FlowMap map;
    for (std::uint32_t c = 0; c < 3 * surface_.triangles(); ++c) map.vertex.push_back(surface_.vertex(c));
    map.ftle.assign(n, std::numeric_limits<double>::quiet_NaN());
    map.time.assign(n, 0);
    std::vector<std::uint8_t> known(n);
    std::vector<Vec3f> before(flow_.points.size()), after = before;
    flow_.vectors(flow_.times.front(), before);
    for (std::size_t k = 0; k + 1 < flow_.times.size(); ++k) {
      const double from = flow_.times[k], to = flow_.times[k + 1];
      flow_.vectors(to, after);
      pathlines_.enter(to - from, before, after);
      if (k == 0) begin(from);
      carry();
      const Moment now = moment(to);
      const bool last = k + 2 == flow_.times.size();
      each_vertex([&](std::size_t v) {
        if (known[v]) return;
        const bool cut = any_left(v);
        if (!cut && !last) return;
        known[v] = 1;
        const Moment& end = cut ? latest_ : now;
        map.time[v] = std::fabs(end.time - flow_.times.front());
        if (map.time[v] > 0) map.ftle[v] = exponent(v, end) / map.time[v];
      });
      latest_ = now;
      std::swap(before, after);
    }
    map.end = latest_.position;
    for (const SurfaceParticle& each : particles_) map.left += each.left;
    return map;
  }

 private:
  template <class F>
  void each_vertex(const F& f) const {
    tbb::parallel_for(std::size_t(0), surface_.vertices(), f);
  }

  void begin(double time) {
    particles_.resize(surface_.vertices());
    each_vertex([&](std::size_t v) { particles_[v] = pathlines_.at_vertex(fans_.of(v)); });
    first_ = latest_ = moment(time);
  }

  void carry() {
    each_vertex([&](std::size_t v) {
      if (stop_ && *stop_) return;
      if (!particles_[v].left) pathlines_.carry(particles_[v]);
    });
    if (stop_ && *stop_) throw Interrupted();
  }

  bool any_left(std::size_t v) const {
    if (particles_[v].left) return true;
    for (const std::uint32_t other : rings_.of(v))
      if (particles_[other].left) return true;
    return false;
  }

  Moment moment(double time) const {
    Moment all{time, std::vector<Vec3d>(particles_.size()), std::vector<Vec3d>(particles_.size())};
    const std::vector<Vec3d> moved = flow_.shape ? flow_.shape(time) : std::vector<Vec3d>();
    const std::span<const Vec3d> points = flow_.shape ? std::span<const Vec3d>(moved) : flow_.points;
    std::vector<Vec3d> normal(surface_.vertices());
    each_vertex([&](std::size_t v) {
      Vec3d sum;
      for (const std::uint32_t c : fans_.of(v)) {
        const Triangle& t = surface_.triangle(c / 3);
        sum += cross(points[t.b] - points[t.a], points[t.c] - points[t.a]);
      }
      normal[v] = normalized(sum);
    });
    each_vertex([&](std::size_t v) {
      const SurfacePosition& at = particles_[v].at;
      const Vec3d w = pathlines_.walk().weights(at.triangle, at.x);
      const Triangle& t = surface_.triangle(at.triangle);
      const std::uint32_t c = 3 * at.triangle;
      all.position[v] = points[t.a] * w.x + points[t.b] * w.y + points[t.c] * w.z;
      all.normal[v] = normalized(normal[surface_.vertex(c)] * w.x + normal[surface_.vertex(c + 1)] * w.y +
                                 normal[surface_.vertex(c + 2)] * w.z);
    });
    return all;
  }

  /// ln of the largest singular value of F, from the first moment to `end`. Neighbours count by their distance, so that
  /// near ones are matched as well as far ones, relative to it.
  double exponent(std::size_t v, const Moment& end) const {
    const Plane here(first_.normal[v]), there(end.normal[v]);
    double xx = 0, xy = 0, yy = 0;
    Vec2d by_x, by_y;
    for (const std::uint32_t other : rings_.of(v)) {
      const Vec2d a = here(first_.position[other] - first_.position[v]);
      const Vec2d b = there(end.position[other] - end.position[v]);
      const double w = 1 / std::max(dot(a, a), 1e-300);
      xx += w * a.x * a.x, xy += w * a.x * a.y, yy += w * a.y * a.y;
      by_x = by_x + b * (w * a.x);
      by_y = by_y + b * (w * a.y);
    }
    const double whole = xx * yy - xy * xy;
    if (!(whole > 1e-12 * xx * yy)) return std::numeric_limits<double>::quiet_NaN();
    const Vec2d first = (by_x * yy - by_y * xy) * (1 / whole), second = (by_y * xx - by_x * xy) * (1 / whole);
    const double p = dot(first, first), q = dot(second, second), r = dot(first, second);
    return 0.5 * std::log(0.5 * (p + q) + std::hypot(0.5 * (p - q), r));
  }

  const FlowOnSurface& flow_;
  const std::atomic<bool>* stop_;
  TangentField surface_;
  Lists fans_, rings_;
  Pathlines pathlines_;
  std::vector<SurfaceParticle> particles_;
  Moment first_, latest_;
};

}  // namespace

FlowMap flow_map(const FlowOnSurface& flow, const std::atomic<bool>* stop) { return FlowMaps(flow, stop).run(); }

}  // namespace nacre
