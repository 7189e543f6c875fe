// Nacre: triangles read off from the particles themselves.
#include "compute/meshing/stars.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "compute/math/point_hash.hpp"

namespace nacre {
namespace {

constexpr double first_reach = 1.7;  // sizes within which neighbours are looked for at first,
constexpr double last_reach = 5;     // and at last
constexpr double same_side = -0.4;   // neighbours' normals differ by no more (cosine)
constexpr double bent = 0.5;         // cosine under which a neighbour is unfolded into the plane
constexpr double tie = 1e-7;         // weight of a particle at most, squares of its size
constexpr double coincident = 1e-5;  // sizes: nearer ones count as one

/// A number in [0, 1) that looks random, by the position alone.
double hash(const Vec3d& position) {
  std::uint64_t x = hash_point(0, position);
  x = (x ^ x >> 31) * 0xbf58476d1ce4e5b9ull;
  return double((x ^ x >> 29) >> 11) * 0x1p-53;
}

/// Cuts the Voronoi cell of an item out of its tangent plane.
class Cutter {
 public:
  Cutter(const StarItems& items, const ItemTree& tree) : items_(items), tree_(tree) {}

  Star cut(std::uint32_t item) {
    item_ = item;
    normal_ = items_.normal[item];
    const Vec3d aside = std::abs(normal_.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    u_ = normalized(cross(aside, normal_));
    v_ = cross(normal_, u_);
    next_ = items_.next[item], previous_ = items_.previous[item];
    const bool rim = next_ != none && previous_ != none;
    reach_ = 0;
    if (rim != (next_ != none || previous_ != none)) return {};
    if (rim) set_sector();
    const double size = items_.size[item];
    for (double reach = first_reach * size;;) {
      reach_ = reach;
      if (!cut_within(reach, rim)) return hidden_star();
      const double needed = 2 * std::sqrt(farthest2(rim));
      if (needed <= reach || reach >= last_reach * size) break;
      reach = std::min(std::max(1.001 * needed, 1.3 * reach), last_reach * size);
    }
    Star star = rim ? rim_star() : closed_star();
    star.reach = float(1.001 * reach_);
    return star;
  }

 private:
  struct Corner {
    double u, v;
    std::uint32_t after;  // the neighbour across the side that begins here; none: the frame
  };

  void set_sector() {
    const Vec3d here = items_.position[item_];
    const auto [nu, nv] = in_plane(items_.position[next_] - here);
    const auto [pu, pv] = in_plane(items_.position[previous_] - here);
    next_u_ = nu, next_v_ = nv, previous_u_ = pu, previous_v_ = pv;
    reflex_ = nu * pv - nv * pu < 0;
  }

  std::array<double, 2> in_plane(const Vec3d& r) const { return {dot(r, u_), dot(r, v_)}; }

  /// Strictly between the directions to the next and to the previous item.
  bool in_sector(double u, double v) const {
    const bool left_of_next = next_u_ * v - next_v_ * u > 0, right_of_previous = u * previous_v_ - v * previous_u_ > 0;
    return reflex_ ? left_of_next || right_of_previous : left_of_next && right_of_previous;
  }

  /// False where a particle with a lower number has the same position.
  bool cut_within(double reach, bool rim) {
    const Vec3d here = items_.position[item_];
    const double size = items_.size[item_], frame = 2 * size;
    found_.clear();
    tree_.within(items_.surface[item_], here, reach, found_);
    if (rim)
      for (const std::uint32_t q : {next_, previous_}) {
        const Vec3d r = items_.position[q] - here;
        if (const double d = dot(r, r); d > reach * reach) found_.push_back({d, q});
      }
    std::sort(found_.begin(), found_.end());
    cell_.assign({{-frame, -frame, none}, {frame, -frame, none}, {frame, frame, none}, {-frame, frame, none}});
    const double weight = weight_of(item_);
    double far2 = farthest2(rim);
    for (const auto& [distance2, q] : found_) {
      if (q == item_) continue;
      if (distance2 > 4.0001 * far2 && q != next_ && q != previous_) {
        if (!rim) break;
        continue;
      }
      if (distance2 <= coincident * coincident * size * size) {
        if (q < item_) return false;
        continue;
      }
      if (dot(normal_, items_.normal[q]) < same_side) continue;
      auto [u, v] = in_plane(items_.position[q] - here);
      if (const double across2 = u * u + v * v; dot(normal_, items_.normal[q]) < bent && across2 > 0) {
        const double unfold = std::sqrt(distance2 / across2);
        u *= unfold, v *= unfold;
      }
      if (rim && q != next_ && q != previous_ && !in_sector(u, v)) continue;
      if (clip(u, v, 0.5 * (distance2 + weight - weight_of(q)), q)) far2 = farthest2(rim);
    }
    return true;
  }

  double weight_of(std::uint32_t item) const {
    return tie * hash(items_.position[item]) * items_.size[item] * items_.size[item];
  }

  double farthest2(bool rim) const {
    double far2 = 0;
    for (const Corner& c : cell_)
      if (!rim || in_sector(c.u, c.v)) far2 = std::max(far2, c.u * c.u + c.v * c.v);
    return far2;
  }

  /// Keeps what has a x + b y <= limit.
  bool clip(double a, double b, double limit, std::uint32_t neighbour) {
    const std::size_t n = cell_.size();
    beyond_.resize(n);
    bool any = false, all = true;
    for (std::size_t i = 0; i < n; ++i) {
      beyond_[i] = a * cell_[i].u + b * cell_[i].v - limit;
      any = any || beyond_[i] > 0;
      all = all && beyond_[i] > 0;
    }
    if (!any) return false;
    cut_.clear();
    for (std::size_t i = 0; i < n && !all; ++i) {
      const std::size_t k = i + 1 == n ? 0 : i + 1;
      const Corner &from = cell_[i], &to = cell_[k];
      const bool in = beyond_[i] <= 0, then_in = beyond_[k] <= 0;
      if (in) cut_.push_back(from);
      if (in == then_in) continue;
      const double t = beyond_[i] / (beyond_[i] - beyond_[k]);
      cut_.push_back({from.u + t * (to.u - from.u), from.v + t * (to.v - from.v), in ? neighbour : from.after});
    }
    cell_.swap(cut_);
    return true;
  }

  Star hidden_star() const {
    Star star;
    star.hidden = true;
    star.reach = float(1.001 * reach_);
    return star;
  }

  Star closed_star() const {
    Star star;
    star.closed = true;
    for (const Corner& corner : cell_) {
      if (corner.after == none) {
        if (star.count > 0)
          star.gaps |= 1u << (star.count - 1);
        else
          star.gaps |= 1u << 31;  // before the first
        continue;
      }
      if (star.count == Star::most) return {};
      star.ring[star.count++] = corner.after;
    }
    if (star.count == 0) return {};
    if (star.gaps >> 31 & 1) star.gaps = (star.gaps & 0x7fffffffu) | 1u << (star.count - 1);
    return star;
  }

  Star rim_star() const {
    Star star;
    const auto add = [&](std::uint32_t q) {
      if (star.count < Star::most) star.ring[star.count] = q;
      ++star.count;
    };
    add(next_);
    // Sides are in the order of their neighbours' directions; the walk begins behind the direction to the next item.
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const Corner& c : cell_) {
      if (c.after == next_ || c.after == previous_) continue;
      if (c.after == none) continue;
      const auto [u, v] = in_plane(items_.position[c.after] - items_.position[item_]);
      double angle = std::atan2(next_u_ * v - next_v_ * u, next_u_ * u + next_v_ * v);
      if (angle < 0) angle += 2 * M_PI;
      order.push_back({angle, c.after});
    }
    std::sort(order.begin(), order.end());
    for (const auto& [angle, q] : order) add(q);
    add(previous_);
    if (star.count > Star::most) return {};
    return star;
  }

  const StarItems& items_;
  const ItemTree& tree_;
  std::uint32_t item_ = 0, next_ = none, previous_ = none;
  Vec3d normal_, u_, v_;
  double next_u_ = 0, next_v_ = 0, previous_u_ = 0, previous_v_ = 0;
  bool reflex_ = false;
  double reach_ = 0;
  std::vector<PointTree::Found> found_;
  std::vector<Corner> cell_, cut_;
  std::vector<double> beyond_;
};

}  // namespace

void cut_stars(const StarItems& items, const ItemTree& tree, std::span<const std::uint8_t> wanted,
               std::vector<Star>& stars) {
  tbb::enumerable_thread_specific<Cutter> cutters([&] { return Cutter(items, tree); });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, items.count(), 256), [&](const auto& range) {
    Cutter& cutter = cutters.local();
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      if (wanted[i]) stars[i] = cutter.cut(std::uint32_t(i));
  });
}

}  // namespace nacre
