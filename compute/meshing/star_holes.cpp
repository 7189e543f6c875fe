// Nacre: what stars leave open between the triangles that they agree on, and how it is filled.
#include "compute/meshing/star_holes.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "compute/meshing/incidence.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr std::size_t longest_loop = 80;  // the time to fill one grows with its cube
constexpr std::size_t plain_loop = 12;    // beyond, its shape need not be given by what is around it

constexpr double poor = 3;  // price of a triangle with a ratio of about 0.2: too poor for a larger hole off the rims
constexpr double aside_reach = 1.5;        // sizes: as far from a filling are the items that it leaves out
constexpr double cheapest = 0.999;         // no triangle costs less,
constexpr double slack = 1e-6;             // and rounding does not make a difference of so much
constexpr double fold = 1e3, taken = 1e9;  // prices of a triangle that faces aside, and of an edge that there is

/// An edge of a hole: a triangle that has it is wanted.
struct Side {
  std::uint32_t from, to;
  bool used = false;
};

bool is_used(const Star& star) { return star.agreed != 0; }

void add_sides(const StarItems& items, std::span<const Star> stars, std::uint32_t i, std::vector<Side>& sides) {
  const Star& star = stars[i];
  const std::uint32_t next = items.next[i];
  bool has_next = false;
  for (int k = 0; k < star.count; ++k) {
    const std::uint32_t r = star.ring[k];
    has_next = has_next || (r == next && star.is_agreed(k));
    if (star.is_agreed_right(k) && !star.is_agreed(k) && items.next[r] != i && r != next) sides.push_back({i, r});
  }
  if (next != none && !has_next && items.next[next] != i) sides.push_back({i, next});
}

/// Ascending by the items that they begin at.
std::vector<Side> list_sides(const StarItems& items, std::span<const Star> stars,
                             std::span<const std::uint32_t> incomplete) {
  constexpr std::size_t part = 4096;
  std::vector<std::vector<Side>> parts((incomplete.size() + part - 1) / part);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t k) {
    for (const std::uint32_t i : incomplete.subspan(k * part, std::min(part, incomplete.size() - k * part)))
      add_sides(items, stars, i, parts[k]);
  });
  std::vector<Side> sides;
  for (const std::vector<Side>& some : parts) sides.insert(sides.end(), some.begin(), some.end());
  return sides;
}

/// The angle by which one turns from a to b, clockwise seen against the normal; in (0, 2 pi].
double clockwise(const Vec3d& normal, const Vec3d& a, const Vec3d& b) {
  const double angle = std::atan2(dot(normal, cross(b, a)), dot(a, b) - dot(a, normal) * dot(b, normal));
  return angle > 0 ? angle : angle + 2 * M_PI;
}

/// The side to go on with from the end of `side`: the first one clockwise.
Side* follow(std::vector<Side>& sides, const Side& side, const StarItems& items) {
  const auto begin =
      std::lower_bound(sides.begin(), sides.end(), side.to, [](const Side& s, std::uint32_t v) { return s.from < v; });
  const auto goes_on = [&](auto s) { return s != sides.end() && s->from == side.to; };
  if (goes_on(begin) && !goes_on(begin + 1)) return begin->used ? nullptr : &*begin;
  Side* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  const Vec3d at = items.position[side.to], back = items.position[side.from] - at;
  for (auto s = begin; goes_on(s); ++s) {
    if (s->used) continue;
    const double turn = clockwise(items.normal[side.to], back, items.position[s->to] - at);
    if (turn < least) least = turn, best = &*s;
  }
  return best;
}

/// Items that no triangle has go to the hole that most of their neighbours are at or within: those at its rim first, so
/// that a wide hole gets all that is in its middle.
class Orphans {
 public:
  Orphans(const StarItems& items, std::span<const Star> stars, std::span<const std::uint32_t> incomplete)
      : stars_(stars) {
    for (const std::uint32_t k : select_where(incomplete.size(), [&](std::size_t k) {
           const std::uint32_t i = incomplete[k];
           return !is_used(stars[i]) && !stars[i].hidden && items.next[i] == none;
         }))
      waiting_.push_back({incomplete[k], none, {}});
  }

  void distribute(StarHoles& found) {
    if (waiting_.empty()) return;
    std::vector<AtHole> fresh;
    for (std::uint32_t h = 0; h < found.holes.size(); ++h)
      for (const std::uint32_t v : found.holes[h].loop) fresh.push_back({v, h});
    std::vector<std::uint8_t> is_fresh(stars_.size(), 0);
    while (!fresh.empty()) {
      std::sort(fresh.begin(), fresh.end());
      for (const AtHole& f : fresh) is_fresh[f.item] = 1;
      const std::vector<std::uint32_t> joining = select_where(
          waiting_.size(), [&](std::size_t k) { return vote(waiting_[k], fresh, is_fresh); }, 256);
      for (const AtHole& f : fresh) is_fresh[f.item] = 0;
      fresh.clear();
      for (const std::uint32_t k : joining) {
        fresh.push_back({waiting_[k].item, waiting_[k].hole});
        found.holes[waiting_[k].hole].within.push_back(waiting_[k].item);
      }
    }
    for (const Waiting& w : waiting_)
      if (w.hole == none) found.alone.push_back(w.item);
  }

 private:
  /// An item that is at a hole or within it.
  struct AtHole {
    std::uint32_t item, hole;
    friend auto operator<=>(const AtHole&, const AtHole&) = default;
  };
  struct Waiting {
    std::uint32_t item, hole;
    std::vector<std::pair<std::uint32_t, int>> votes;  // hole, how many neighbours
  };

  /// Counts neighbours that have come to a hole since the last time. True where the item goes to one now: of several
  /// with as many votes to the first.
  bool vote(Waiting& w, std::span<const AtHole> fresh, std::span<const std::uint8_t> is_fresh) const {
    if (w.hole != none) return false;
    const Star& star = stars_[w.item];
    bool any = false;
    for (int k = 0; k < star.count; ++k) {
      const std::uint32_t r = star.ring[k];
      if (!is_fresh[r]) continue;
      any = true;
      for (auto f = std::lower_bound(fresh.begin(), fresh.end(), AtHole{r, 0}); f != fresh.end() && f->item == r; ++f)
        ++votes_for(w, f->hole);
    }
    if (!any) return false;
    const auto better = [](const auto& s, const auto& t) {
      return s.second != t.second ? s.second < t.second : s.first > t.first;
    };
    const auto best = std::max_element(w.votes.begin(), w.votes.end(), better);
    if (best->second < 2) return false;
    w.hole = best->first;
    return true;
  }

  static int& votes_for(Waiting& w, std::uint32_t hole) {
    const auto at = std::find_if(w.votes.begin(), w.votes.end(), [&](const auto& v) { return v.first == hole; });
    return at != w.votes.end() ? at->second : w.votes.emplace_back(hole, 0).second;
  }

  std::span<const Star> stars_;
  std::vector<Waiting> waiting_;  // ascending
};

/// Fills one hole: the cheapest triangulation of its loop, then its inner items, then flips.
class Filling {
 public:
  Filling(const StarItems& items, std::span<const Star> stars, const StarHole& hole)
      : items_(items), stars_(stars), hole_(hole), n_(hole.loop.size()) {}

  std::vector<Triangle> run() {
    if (n_ < 3 || n_ > longest_loop || !triangulate_loop()) return {};
    used_ = hole_.loop;
    std::vector<std::uint32_t> aside;
    for (const std::uint32_t v : hole_.within)
      if (!insert(v)) aside.push_back(v);
    if (std::any_of(aside.begin(), aside.end(), [&](std::uint32_t v) { return is_far(v); })) return {};
    if (!hole_.within.empty()) improve();
    if (n_ == 3 && triangles_.size() == 1 && stars_has_backwards()) return {};
    if (n_ > plain_loop && any_above(fold * 0.1)) return {};
    if ((n_ > plain_loop || !hole_.within.empty()) && !at_rim() && any_above(poor)) return {};
    return triangles_;
  }

 private:
  Vec3d position(std::uint32_t i) const { return items_.position[i]; }

  /// Sum of squared edges by area (1 where equilateral), dear where it faces aside. Some number above `limit` where the
  /// price is above it.
  double price(std::uint32_t a, std::uint32_t b, std::uint32_t c,
               double limit = std::numeric_limits<double>::infinity()) const {
    if (a == b || b == c || c == a) return taken;
    const Vec3d u = position(b) - position(a), v = position(c) - position(a), w = position(c) - position(b),
                n = cross(u, v);
    const double twice_area = length(n), edges = dot(u, u) + dot(v, v) + dot(w, w);
    const double shape = edges / std::max(2 * std::sqrt(3.0) * twice_area, 1e-6 * edges);
    if (shape > limit) return shape;
    const Vec3d up = normalized(items_.normal[a] + items_.normal[b] + items_.normal[c]);
    const double facing = dot(n, up) / std::max(twice_area, 1e-300);
    return shape + (facing < 0.3 ? fold * (0.4 - facing) : 0);
  }

  bool is_there(std::uint32_t a, std::uint32_t b) const {
    if (stars_[a].position_of(b) >= 0) return stars_[a].has_agreed_edge(b);
    return items_.next[a] == b || items_.previous[a] == b;
  }

  double inner_edge(std::size_t i, std::size_t j) const {
    const bool side = j == i + 1 || (i == 0 && j + 1 == n_);
    if (side) return 0;
    const std::uint32_t a = hole_.loop[i], b = hole_.loop[j];
    if (a == b || is_there(a, b)) return taken;
    if (!again_[i] && !again_[j]) return 0;
    for (std::size_t k = 0; k < n_; ++k) {  // two sides of the same loop
      const std::uint32_t s = hole_.loop[k], t = hole_.loop[(k + 1) % n_];
      if ((s == a && t == b) || (s == b && t == a)) return taken;
    }
    return 0;
  }

  /// Which items the loop passes more than once.
  std::vector<bool> passed_again() const {
    std::vector<bool> again(n_);
    for (std::size_t k = 0; k < n_; ++k) again[k] = std::ranges::count(hole_.loop, hole_.loop[k]) > 1;
    return again;
  }

  bool triangulate_loop() {
    again_ = passed_again();
    std::vector<double> cost(n_ * n_, 0);
    std::vector<std::uint32_t> apex(n_ * n_, 0);
    for (std::size_t span = 2; span < n_; ++span)
      for (std::size_t i = 0; i + span < n_; ++i) {
        const std::size_t j = i + span;
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k) {
          const double parts = cost[i * n_ + k] + cost[k * n_ + j];
          if (parts + cheapest > best) continue;
          const double c = parts + price(hole_.loop[i], hole_.loop[k], hole_.loop[j], best - parts + slack);
          if (c < best) best = c, apex[i * n_ + j] = std::uint32_t(k);
        }
        cost[i * n_ + j] = best + inner_edge(i, j);
      }
    if (!(cost[n_ - 1] < taken)) return false;
    emit(0, n_ - 1, apex);
    return true;
  }

  bool at_rim() const {
    return std::any_of(hole_.loop.begin(), hole_.loop.end(), [&](std::uint32_t v) { return items_.next[v] != none; });
  }

  bool any_above(double limit) const {
    return std::any_of(triangles_.begin(), triangles_.end(),
                       [&](const Triangle& t) { return price(t.a, t.b, t.c) >= limit; });
  }

  bool stars_has_backwards() const {
    const Star& star = stars_[hole_.loop[0]];
    for (int k = 0; k < star.count; ++k)
      if (star.ring[k] == hole_.loop[2] && star.is_agreed(k) && star.ring[star.after(k)] == hole_.loop[1]) return true;
    return false;
  }

  void emit(std::size_t i, std::size_t j, const std::vector<std::uint32_t>& apex) {
    if (j < i + 2) return;
    const std::size_t k = apex[i * n_ + j];
    triangles_.push_back({hole_.loop[i], hole_.loop[k], hole_.loop[j]});
    emit(i, k, apex);
    emit(k, j, apex);
  }

  /// Whether what stays out is part of a surface that the triangles do not follow, as of a fin that they would cut off.
  bool is_far(std::uint32_t v) const {
    const double reach = aside_reach * items_.size[v];
    return std::none_of(used_.begin(), used_.end(),
                        [&](std::uint32_t w) { return length(position(w) - position(v)) <= reach; });
  }

  /// Divides the triangle that an item is in or next to; false where it lies aside, and stays out.
  bool insert(std::uint32_t v) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto [a, b, c] = std::array{triangles_[t].a, triangles_[t].b, triangles_[t].c};
      const double worst = std::max({price(a, b, v, least), price(b, c, v, least), price(c, a, v, least)});
      if (worst < least) least = worst, best = t;
    }
    if (least >= fold) return false;
    used_.push_back(v);
    const Triangle t = triangles_[best];
    triangles_[best] = {t.a, t.b, v};
    triangles_.push_back({t.b, t.c, v});
    triangles_.push_back({t.c, t.a, v});
    return true;
  }

  /// Exchanges diagonals while that is cheaper.
  void improve() {
    std::vector<std::uint64_t> corners;  // of each triangle
    std::ranges::transform(triangles_, std::back_inserter(corners), corner_bits);
    for (int round = 0; round < 50; ++round) {
      bool changed = false;
      for (std::size_t s = 0; s < triangles_.size(); ++s)
        for (std::size_t t = s + 1; t < triangles_.size(); ++t) {
          if (!may_share_an_edge(corners[s], corners[t]) || !flip(triangles_[s], triangles_[t])) continue;
          corners[s] = corner_bits(triangles_[s]), corners[t] = corner_bits(triangles_[t]);
          changed = true;
        }
      if (!changed) return;
    }
  }

  /// Most pairs of triangles are told apart by this alone. Corners of one triangle may have the same bit.
  static bool may_share_an_edge(std::uint64_t corners, std::uint64_t others) {
    return std::popcount(corners & others) + (3 - std::popcount(corners)) >= 2;
  }

  /// A bit for each corner.
  static std::uint64_t corner_bits(const Triangle& t) {
    return std::uint64_t(1) << t.a % 64 | std::uint64_t(1) << t.b % 64 | std::uint64_t(1) << t.c % 64;
  }

  bool flip(Triangle& s, Triangle& t) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const std::uint32_t a = s[i], b = s[(i + 1) % 3], c = s[(i + 2) % 3], d = t[(j + 2) % 3];
        if (t[j] != b || t[(j + 1) % 3] != a) continue;
        if (c == d || is_there(c, d) || in_patch(c, d)) return false;
        if (!(price(a, d, c) + price(d, b, c) < price(a, b, c) + price(b, a, d) - 1e-9)) return false;
        s = {a, d, c};
        t = {d, b, c};
        return true;
      }
    return false;
  }

  bool in_patch(std::uint32_t a, std::uint32_t b) const {
    return std::any_of(triangles_.begin(), triangles_.end(),
                       [&](const Triangle& t) { return has_corner(t, a) && has_corner(t, b); });
  }

  const StarItems& items_;
  std::span<const Star> stars_;
  const StarHole& hole_;
  std::size_t n_;
  std::vector<bool> again_;  // whether the loop passes this item of it more than once
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> used_;  // items of these
};

}  // namespace

StarHoles find_holes(const StarItems& items, std::span<const Star> stars, std::span<const std::uint32_t> incomplete) {
  std::vector<Side> sides = list_sides(items, stars, incomplete);
  StarHoles found;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (sides[s].used) continue;
    StarHole hole;
    const std::uint32_t start = sides[s].from;
    Side* side = &sides[s];
    while (side) {
      side->used = true;
      hole.loop.push_back(side->from);
      if (side->to == start) break;
      side = follow(sides, *side, items);
    }
    if (!side)
      found.open.insert(found.open.end(), hole.loop.begin(), hole.loop.end());
    else
      found.holes.push_back(std::move(hole));
  }
  Orphans(items, stars, incomplete).distribute(found);
  return found;
}

std::vector<Triangle> fill_hole(const StarItems& items, std::span<const Star> stars, const StarHole& hole) {
  return Filling(items, stars, hole).run();
}

}  // namespace nacre
