// Nacre: stars are cut: the Voronoi cell of an item in its tangent plane, and whose bisecting planes bound it.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/math/bits.hpp"
#include "compute/math/point_hash.hpp"
#include "compute/meshing/item_boxes.hpp"
#include "compute/meshing/star.hpp"

namespace nacre {

namespace detail {

/// Items around a position, the nearest first, so many at a time.
class NearestItems {
 public:
  static constexpr int most = 24;

  NACRE_HD int count() const { return count_; }
  NACRE_HD double distance2(int k) const { return distance2_[k]; }
  NACRE_HD std::uint32_t item(int k) const { return item_[k]; }
  /// Whether there may be others behind these.
  NACRE_HD bool full() const { return count_ == most; }
  /// Squared distance beyond which none is taken any more.
  NACRE_HD const double& limit2() const { return limit2_; }

  NACRE_HD void begin(double radius) { count_ = 0, after2_ = -1, after_ = 0, limit2_ = radius2_ = radius * radius; }
  /// Those behind the last ones.
  NACRE_HD void go_on() {
    after2_ = distance2_[count_ - 1], after_ = item_[count_ - 1];
    count_ = 0, limit2_ = radius2_;
  }

  NACRE_HD void offer(double d, std::uint32_t i) {
    if (!is_before(after2_, after_, d, i)) return;
    if (full() && !is_before(d, i, distance2_[most - 1], item_[most - 1])) return;
    int k = full() ? most - 1 : count_++;
    for (; k > 0 && is_before(d, i, distance2_[k - 1], item_[k - 1]); --k)
      distance2_[k] = distance2_[k - 1], item_[k] = item_[k - 1];
    distance2_[k] = d, item_[k] = i;
    if (full() && distance2_[most - 1] < limit2_) limit2_ = distance2_[most - 1];
  }

 private:
  NACRE_HD static bool is_before(double d, std::uint32_t i, double e, std::uint32_t k) {
    return d != e ? d < e : i < k;
  }

  double distance2_[most];
  std::uint32_t item_[most];
  int count_ = 0;
  double radius2_ = 0, limit2_ = 0, after2_ = -1;  // none before (after2_, after_), nor this one itself
  std::uint32_t after_ = 0;
};

/// The weights of items: small ones, by the position alone, so that where four lie on a circle one choice is made.
struct WeighItems {
  static constexpr double tie = 1e-7;  // at most, squares of the size
  StarItemsView items;
  double* weight;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t x = hash_point(0, items.position[i]);
    x = (x ^ x >> 31) * 0xbf58476d1ce4e5b9ull;
    const double random = double((x ^ x >> 29) >> 11) * 0x1p-53;  // in [0, 1)
    weight[i] = tie * random * items.size[i] * items.size[i];
  }
};

/// Cuts the Voronoi cell of an item out of its tangent plane.
class StarCutter {
 public:
  static constexpr double first_reach = 1.7;  // sizes within which neighbours are looked for at first

  /// `weight` has that of each item; `around` are those of the surface around all items that are cut, or null.
  NACRE_HD StarCutter(const StarItemsView& items, const double* weight, const ItemBoxesView& boxes,
                      const ItemsAround* around)
      : items_(items), weight_of_(weight), boxes_(boxes), around_(around) {}

  NACRE_HD Star cut(std::uint32_t item) {
    item_ = item;
    here_ = items_.position[item];
    normal_ = items_.normal[item];
    size_ = items_.size[item];
    weight_ = weight_of_[item];
    const Vec3d aside = std::fabs(normal_.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    u_ = normalized(cross(aside, normal_));
    v_ = cross(normal_, u_);
    next_ = items_.next[item], previous_ = items_.previous[item];
    rim_ = next_ != none && previous_ != none;
    if (rim_ != (next_ != none || previous_ != none)) return {};
    if (rim_) set_sector();
    double reach = first_reach * size_;
    for (;;) {
      if (!cut_within(reach)) return hidden_star(reach);
      const double needed = 2 * std::sqrt(farthest2());
      if (needed <= reach || reach >= last_reach * size_) break;
      reach = min(max(1.001 * needed, 1.3 * reach), last_reach * size_);
    }
    Star star;
    if (!overflows_) star = rim_ ? rim_star() : closed_star();
    star.reach = float(1.001 * reach);
    return star;
  }

 private:
  static constexpr double last_reach = 5;     // sizes: neighbours are looked for no farther away
  static constexpr double same_side = -0.4;   // neighbours' normals differ by no more (cosine)
  static constexpr double bent = 0.5;         // cosine under which a neighbour is unfolded into the plane
  static constexpr double coincident = 1e-5;  // sizes: nearer ones count as one
  static constexpr int most_corners = 32;

  struct Plane {
    double u, v;
  };

  NACRE_HD static double min(double a, double b) { return b < a ? b : a; }
  NACRE_HD static double max(double a, double b) { return a < b ? b : a; }

  NACRE_HD void set_sector() {
    along_next_ = in_plane(next_), along_previous_ = in_plane(previous_);
    reflex_ = along_next_.u * along_previous_.v - along_next_.v * along_previous_.u < 0;
  }

  NACRE_HD Plane in_plane(std::uint32_t item) const {
    const Vec3d r = items_.position[item] - here_;
    return {dot(r, u_), dot(r, v_)};
  }

  /// Item q projected along the mean of the two normals, and turned as that mean is into this item's normal: each of
  /// the two sees the other at the same distance.
  NACRE_HD Plane unfolded(std::uint32_t q) const {
    const Vec3d r = items_.position[q] - here_, half = normalized(normal_ + items_.normal[q]), turn = half + normal_;
    const Vec3d across = r - dot(r, half) * half;
    const Vec3d turned = across - dot(turn, across) / (1 + dot(half, normal_)) * turn;
    return {dot(turned, u_), dot(turned, v_)};
  }

  /// Strictly between the directions to the next and to the previous item.
  NACRE_HD bool in_sector(double u, double v) const {
    const bool left_of_next = along_next_.u * v - along_next_.v * u > 0;
    const bool right_of_previous = u * along_previous_.v - v * along_previous_.u > 0;
    return reflex_ ? left_of_next || right_of_previous : left_of_next && right_of_previous;
  }

  NACRE_HD bool beside_on_rim(std::uint32_t q) const { return q == next_ || q == previous_; }

  /// False where a particle with a lower number has the same position.
  NACRE_HD bool cut_within(double reach) {
    const double frame = 2 * size_;
    put(0, {-frame, -frame}, none), put(1, {frame, -frame}, none);
    put(2, {frame, frame}, none), put(3, {-frame, frame}, none);
    corners_ = 4, overflows_ = false;
    far2_ = farthest2();
    const std::uint32_t surface = items_.surface[item_];
    const auto offer = [&](double d, std::uint32_t q) { near_.offer(d, q); };
    for (near_.begin(reach);; near_.go_on()) {
      if (around_ && reach <= around_->reach())
        around_->within(Vec3f(here_), near_.limit2(), offer);
      else
        boxes_.within(items_.first[surface], items_.first[surface + 1], Vec3f(here_), near_.limit2(), offer);
      if (rim_) offer_beside(next_, reach), offer_beside(previous_, reach);
      for (int k = 0; k < near_.count(); ++k) {
        const std::uint32_t q = near_.item(k);
        const double distance2 = near_.distance2(k);
        if (q == item_) continue;
        if (distance2 > 4.0001 * far2_ && !beside_on_rim(q)) {
          if (!rim_) return true;
          continue;
        }
        if (distance2 <= coincident * coincident * size_ * size_) {
          if (q < item_) return false;
          continue;
        }
        cut_off(distance2, q);
        if (overflows_) return true;
      }
      if (!near_.full()) return true;
    }
  }

  /// Items beside this one on its rim are taken however far they are.
  NACRE_HD void offer_beside(std::uint32_t q, double reach) {
    const Vec3d r = items_.position[q] - here_;
    if (const double d = dot(r, r); d > reach * reach) near_.offer(d, q);
  }

  /// Cuts off what is nearer to item q.
  NACRE_HD void cut_off(double distance2, std::uint32_t q) {
    const double facing = dot(normal_, items_.normal[q]);
    if (facing < same_side) return;
    const Plane to = facing < bent ? unfolded(q) : in_plane(q);
    if (rim_ && !beside_on_rim(q) && !in_sector(to.u, to.v)) return;
    if (clip(to.u, to.v, 0.5 * (distance2 + weight_ - weight_of_[q]), q)) far2_ = farthest2();
  }

  NACRE_HD double farthest2() const {
    double far2 = 0;
    for (int k = 0; k < corners_; ++k)
      if (!rim_ || in_sector(u_of_[k], v_of_[k])) far2 = max(far2, u_of_[k] * u_of_[k] + v_of_[k] * v_of_[k]);
    return far2;
  }

  /// Keeps what has a x + b y <= limit. Corners beyond it follow each other, since cells are convex: they give way to
  /// the two where the line cuts the cell.
  NACRE_HD bool clip(double a, double b, double limit, std::uint32_t neighbour) {
    const int n = corners_;
    unsigned beyond = 0;
    for (int i = 0; i < n; ++i) {
      excess_[i] = a * u_of_[i] + b * v_of_[i] - limit;
      beyond |= unsigned(excess_[i] > 0) << i;
    }
    if (beyond == 0) return false;
    const unsigned all = n < 32 ? (1u << n) - 1 : ~0u;
    if (beyond == all) {
      corners_ = 0;
      return true;
    }
    const int first = first_of_run(beyond, (beyond << 1 | beyond >> (n - 1)) & all);
    int end = first, count = 0;  // the corner behind the run, and how many there are in it
    for (; beyond >> end & 1; ++count) end = end + 1 == n ? 0 : end + 1;
    if (n - count + 2 > most_corners) {
      overflows_ = true;
      return false;
    }
    const int before = first == 0 ? n - 1 : first - 1, last = end == 0 ? n - 1 : end - 1;
    const Plane entry = between(before, first), exit = between(last, end);
    const std::uint32_t after_exit = after_[last];
    if (first > 0 && first + count <= n) {
      move(first + count, n - first - count, first + 2);
      put(first, entry, neighbour), put(first + 1, exit, after_exit);
    } else {
      move(end, n - count, 1);
      put(0, exit, after_exit), put(n - count + 1, entry, neighbour);
    }
    corners_ = n - count + 2;
    return true;
  }

  /// The first corner of the run that is beyond a line, from the bits of those beyond it, and those behind such. Where
  /// rounding makes several runs, the one that goes farthest.
  NACRE_HD int first_of_run(unsigned beyond, unsigned behind) const {
    const unsigned starts = beyond & ~behind;
    if ((starts & (starts - 1)) == 0) return lowest_bit(starts);
    int at = 0;
    for (int i = 1; i < corners_; ++i)
      if (excess_[i] > excess_[at]) at = i;
    while (!(starts >> at & 1)) at = at == 0 ? corners_ - 1 : at - 1;
    return at;
  }

  /// Where the side between two corners meets the line.
  NACRE_HD Plane between(int from, int to) const {
    const double t = excess_[from] / (excess_[from] - excess_[to]);
    return {u_of_[from] + t * (u_of_[to] - u_of_[from]), v_of_[from] + t * (v_of_[to] - v_of_[from])};
  }

  NACRE_HD void put(int k, const Plane& at, std::uint32_t after) {
    u_of_[k] = at.u, v_of_[k] = at.v, after_[k] = after;
  }

  NACRE_HD void move(int from, int count, int to) {
    if (to < from)
      for (int k = 0; k < count; ++k) put(to + k, {u_of_[from + k], v_of_[from + k]}, after_[from + k]);
    else if (to > from)
      for (int k = count; k-- > 0;) put(to + k, {u_of_[from + k], v_of_[from + k]}, after_[from + k]);
  }

  NACRE_HD static Star hidden_star(double reach) {
    Star star;
    star.hidden = true;
    star.reach = float(1.001 * reach);
    return star;
  }

  NACRE_HD Star closed_star() const {
    constexpr std::uint32_t before_first = 1u << 31;
    Star star;
    star.closed = true;
    for (int k = 0; k < corners_; ++k) {
      const std::uint32_t q = after_[k];
      if (q == none) {
        star.gaps |= star.count > 0 ? 1u << (star.count - 1) : before_first;
        continue;
      }
      if (star.count == Star::most) return {};
      star.ring[star.count++] = q;
    }
    if (star.count == 0) return {};
    if (star.gaps & before_first) star.gaps = (star.gaps & ~before_first) | 1u << (star.count - 1);
    return star;
  }

  NACRE_HD Star rim_star() const {
    Star star;
    star.ring[star.count++] = next_;
    // Sides are in the order of their neighbours' directions; the walk begins behind the direction to the next item.
    double angle[Star::most];
    for (int k = 0; k < corners_; ++k) {
      const std::uint32_t q = after_[k];
      if (q == none || beside_on_rim(q)) continue;
      if (star.count + 1 == Star::most) return {};
      const Plane to = in_plane(q);
      double turn =
          std::atan2(along_next_.u * to.v - along_next_.v * to.u, along_next_.u * to.u + along_next_.v * to.v);
      if (turn < 0) turn += 2 * M_PI;
      int at = star.count++;
      for (; at > 1 && (turn != angle[at - 1] ? turn < angle[at - 1] : q < star.ring[at - 1]); --at)
        angle[at] = angle[at - 1], star.ring[at] = star.ring[at - 1];
      angle[at] = turn, star.ring[at] = q;
    }
    star.ring[star.count++] = previous_;
    return star;
  }

  const StarItemsView& items_;
  const double* weight_of_;
  const ItemBoxesView& boxes_;
  const ItemsAround* around_;
  std::uint32_t item_ = 0, next_ = none, previous_ = none;
  bool rim_ = false, reflex_ = false, overflows_ = false;
  Vec3d here_, normal_, u_, v_;
  double size_ = 0, weight_ = 0, far2_ = 0;
  Plane along_next_{}, along_previous_{};
  NearestItems near_;
  // The cell's corners in order, and the neighbour across the side that begins at each; none: the frame.
  double u_of_[most_corners], v_of_[most_corners];
  std::uint32_t after_[most_corners];
  double excess_[most_corners];  // by how much a corner is beyond the line that cuts
  int corners_ = 0;
};

/// The stars of those of eight items, which lie together, that are marked; what is agreed is not known yet.
struct CutStars {
  StarItemsView items;
  const double* weight;
  ItemBoxesView boxes;
  std::int64_t n;  // items
  const std::uint32_t* stale;
  Star* star;
  NACRE_HD void operator()(std::int64_t k) const {
    std::uint32_t marked[8];
    int count = 0;
    for (std::int64_t j = 8 * k; j < 8 * k + 8 && j < n; ++j)
      if (const std::uint32_t i = boxes.item(j); stale[i]) marked[count++] = i;
    ItemsAround around;
    // What is around all is gathered once; where that is too much, once for each half, or quarter.
    for (int first = 0, some = 8; first < count;) {
      const int last = min(first + some, count);
      const bool gathered = last - first > 1 && gather(marked + first, last - first, around);
      if (!gathered && last - first > 1) {
        some /= 2;
        continue;
      }
      for (int j = first; j < last; ++j)
        star[marked[j]] = StarCutter(items, weight, boxes, gathered ? &around : nullptr).cut(marked[j]);
      first = last;
      some = first & -first;
    }
  }

 private:
  /// What is around all of them; false where they are not of one surface, or too far apart.
  NACRE_HD bool gather(const std::uint32_t* some, int count, ItemsAround& around) const {
    const std::uint32_t surface = items.surface[some[0]];
    Vec3f low(items.position[some[0]]), high = low;
    double size = items.size[some[0]];
    for (int j = 1; j < count; ++j) {
      if (items.surface[some[j]] != surface) return false;
      const Vec3f at(items.position[some[j]]);
      low = min(low, at), high = max(high, at);
      if (items.size[some[j]] > size) size = items.size[some[j]];
    }
    const Vec3f wide = high - low;
    if (max(wide.x, max(wide.y, wide.z)) > widest * float(size)) return false;
    return around.gather(boxes, items.first[surface], items.first[surface + 1], low, high,
                         StarCutter::first_reach * size);
  }

  static constexpr float widest = 6;  ///< sizes: what is farther apart has too many others around it
};

}  // namespace detail
}  // namespace nacre
