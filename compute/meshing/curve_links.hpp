// Nacre: which particles of a junction curve follow each other.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "compute/meshing/item_boxes.hpp"
#include "compute/meshing/star_particles.hpp"

namespace nacre {

/// A particle on a curve, or a point where one begins or ends, with the particles beside it. A curve runs so that its
/// materials, ascending, come around it counter-clockwise, seen against its direction.
struct CurveNode {
  std::uint64_t curve;  ///< Junction::packed of its three materials
  std::uint32_t particle;
  bool has_next, has_previous;   ///< by the fields
  std::uint32_t next, previous;  ///< nodes, `none` where none was found

  NACRE_HD bool lacks_next() const { return has_next && next == none; }
  NACRE_HD bool lacks_previous() const { return has_previous && previous == none; }
  NACRE_HD bool is_broken() const { return lacks_next() || lacks_previous(); }
  /// Part of a ring of one or two, which bounds nothing.
  NACRE_HD bool is_idle() const { return next != none && next == previous; }
};

/// The nodes of all curves, ascending by curve and particle. A particle has one, a point where curves meet four.
struct CurveNodesView {
  const CurveNode* node = nullptr;
  const std::uint32_t* listed = nullptr;  ///< the nodes of all particles, one particle after the other
  const std::uint32_t* first = nullptr;   ///< per particle: its first entry in that list

  NACRE_HD static int count_of(const Junction& junction) {
    return junction.order() == 2 ? 0 : junction.order() == 1 ? 1 : 4;
  }
  NACRE_HD const CurveNode& of(std::int64_t particle, int k) const { return node[listed[first[particle] + k]]; }
};

namespace detail {

/// How far the next particle may be, in sizes, and how far aside (cosine with the tangents).
struct LinkReach {
  double sizes, cosine;
};
inline constexpr LinkReach link_reaches[] = {{2.5, 0.5}, {4, 0}, {4, -0.9}};
inline constexpr double widest_gap = 6;  // sizes

struct CountNodes {
  const Junction* junction;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t p) const { count[p] = std::uint32_t(CurveNodesView::count_of(junction[p])); }
};

/// The nodes of all particles in the order of these.
struct MakeNodes {
  StarParticlesView particles;
  const std::uint32_t* first;
  CurveNode* node;
  Vec3d* tangent;
  std::uint64_t* key;
  std::uint32_t* number;
  NACRE_HD void operator()(std::int64_t p) const {
    const Junction j = particles.junction[p];
    const int count = CurveNodesView::count_of(j);
    for (int n = 0; n < count; ++n) {
      const int leave = count == 1 ? 3 : n;  // of the junction's materials, the one that the curve does not have
      const int a = leave == 0 ? 1 : 0, b = leave <= 1 ? 2 : 1, c = leave <= 2 ? 3 : 2;
      const Vec3d along = normalized(cross(particles.difference(p, a, b), particles.difference(p, b, c)));
      const std::uint32_t at = first[p] + std::uint32_t(n);
      CurveNode& made = node[at];
      made = {Junction(j.material(a), j.material(b), j.material(c)).packed, std::uint32_t(p), true, true, none, none};
      if (count == 4) {
        made.has_next = dot(particles.difference(p, leave, a), along) < 0;
        made.has_previous = !made.has_next;
      }
      tangent[at] = along;
      key[at] = made.curve, number[at] = at;
    }
  }
};

struct PutNodes {
  StarParticlesView particles;
  const std::uint64_t* key;
  const std::uint32_t* number;
  const CurveNode* made;
  const Vec3d* made_tangent;
  CurveNode* node;
  Vec3d* tangent;
  Vec3d* position;
  std::uint32_t* listed;
  std::uint32_t* curve;  // 1 where another one begins
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t from = number[i];
    node[i] = made[from], tangent[i] = made_tangent[from], position[i] = particles.point(made[from].particle);
    listed[from] = std::uint32_t(i);
    curve[i] = i > 0 && key[i] != key[i - 1] ? 1 : 0;
  }
};

/// Numbers curves, and says where each begins.
struct NumberCurves {
  const std::uint64_t* key;
  std::int64_t n;
  std::uint32_t* curve;  // per node: its curve; before, how many begin ahead of it, the first one excepted
  std::uint32_t* first;  // per curve and one more
  NACRE_HD void operator()(std::int64_t i) const {
    const bool begins = i == 0 || key[i] != key[i - 1];
    if (begins && i > 0) ++curve[i];
    if (begins) first[curve[i]] = std::uint32_t(i);
    if (i + 1 == n) first[curve[i] + 1] = std::uint32_t(n);
  }
};

/// What links are looked for among.
struct LinkSearch {
  StarParticlesView particles;
  const CurveNode* node;
  const Vec3d* tangent;
  StarItemsView at;  // nodes as items, curves as surfaces
  ItemBoxesView boxes;

  /// Calls visit(length, to) for the nodes that may follow node `i`.
  template <class Visit>
  NACRE_HD void for_links(std::uint32_t i, const LinkReach& reach, const Visit& visit) const {
    const double radius = reach.sizes * particles.size(node[i].particle), radius2 = radius * radius;
    const std::uint32_t c = at.surface[i];
    boxes.within(at.first[c], at.first[c + 1], Vec3f(at.position[i]), radius2, [&](double distance2, std::uint32_t k) {
      if (k == i || !node[k].lacks_previous()) return;
      const Vec3d step = at.position[k] - at.position[i];
      const double length = std::sqrt(distance2), from = dot(step, tangent[i]), to = dot(step, tangent[k]);
      if ((from < to ? from : to) >= reach.cosine * length) visit(length, k);
    });
  }
};

/// As an integer that is ordered as lengths are.
NACRE_HD_INLINE std::uint64_t ordered(double length) {
  union {
    double number;
    std::uint64_t bits;
  } same = {length};
  return same.bits;
}

/// The shortest link from each node, and the length of the shortest one to each.
struct OfferLinks {
  LinkSearch search;
  LinkReach reach;
  std::uint32_t* best;      // per node: what it is to be linked to
  std::uint64_t* shortest;  // per node
  NACRE_HD void operator()(std::int64_t n) const {
    const auto i = std::uint32_t(n);
    best[i] = none;
    if (!search.node[i].lacks_next()) return;
    double least = 0;
    search.for_links(i, reach, [&](double length, std::uint32_t k) {
      atomic_min(shortest + k, ordered(length));
      if (best[i] == none || length < least || (length == least && k < best[i])) best[i] = k, least = length;
    });
  }
};

/// Of the nodes that are as near to a node as any, the one with the lowest number.
struct NameLinks {
  LinkSearch search;
  LinkReach reach;
  const std::uint32_t* best;
  const std::uint64_t* shortest;
  std::uint32_t* from;  // per node
  NACRE_HD void operator()(std::int64_t n) const {
    const auto i = std::uint32_t(n);
    if (best[i] == none) return;
    search.for_links(i, reach, [&](double length, std::uint32_t k) {
      if (shortest[k] == ordered(length)) atomic_min(from + k, i);
    });
  }
};

/// Links two nodes where no other link of either comes before.
struct TakeLinks {
  const std::uint32_t* best;
  const std::uint32_t* from;
  CurveNode* node;
  NACRE_HD void operator()(std::int64_t n) const {
    const std::uint32_t k = best[n];
    if (k == none || from[k] != std::uint32_t(n)) return;
    node[n].next = k, node[k].previous = std::uint32_t(n);
  }
};

struct IsTaken {
  const std::uint32_t* best;
  const std::uint32_t* from;
  NACRE_HD std::int64_t operator()(std::int64_t n) const {
    return best[n] != none && from[best[n]] == std::uint32_t(n);
  }
};

struct LacksPrevious {
  const CurveNode* node;
  NACRE_HD std::int64_t operator()(std::int64_t n) const { return node[n].lacks_previous(); }
};

struct NextOrSelf {
  const CurveNode* node;
  std::uint32_t* last;
  NACRE_HD void operator()(std::int64_t n) const { last[n] = node[n].next == none ? std::uint32_t(n) : node[n].next; }
};

struct TwiceAsFar {
  const std::uint32_t* last;
  std::uint32_t* farther;
  NACRE_HD void operator()(std::int64_t n) const { farther[n] = last[last[n]]; }
};

/// What begins and ends nowhere, near each other, is a ring that lacks its last link.
struct CloseChain {
  StarParticlesView particles;
  const std::uint32_t* last;  // of the chain that each node is in
  CurveNode* node;
  NACRE_HD void operator()(std::int64_t n) const {
    if (!node[n].lacks_previous()) return;
    const std::uint32_t p = node[n].particle, end = last[n];
    const Vec3d gap = particles.point(node[end].particle) - particles.point(p);
    if (!node[end].lacks_next() || length(gap) > widest_gap * particles.size(p)) return;
    node[end].next = std::uint32_t(n), node[n].previous = end;
  }
};

/// Links of one reach, the shortest first; of equal ones the first from the lowest number, then to it. That is one
/// link after the other, of all that are left; links that come before all others of both their nodes are the same in
/// any order, and are made together.
template <class Backend>
void link_within(Executor<Backend>& exec, const LinkSearch& search, const LinkReach& reach, CurveNode* node,
                 std::int64_t n) {
  Arena::Scope scope(exec.arena());
  const auto best = exec.arena().template temporary<std::uint32_t>(std::size_t(n));
  const auto shortest = exec.arena().template temporary<std::uint64_t>(std::size_t(n));
  const auto from = exec.arena().template temporary<std::uint32_t>(std::size_t(n));
  do {
    exec.fill(shortest, 0xff), exec.fill(from, 0xff);
    exec.for_each(n, OfferLinks{search, reach, best.data(), shortest.data()});
    exec.for_each(n, NameLinks{search, reach, best.data(), shortest.data(), from.data()});
    exec.for_each(n, TakeLinks{best.data(), from.data(), node});
  } while (exec.reduce(n, std::int64_t(0), IsTaken{best.data(), from.data()}, Add{}) > 0);
}

template <class Backend>
void close_chains(Executor<Backend>& exec, const StarParticlesView& particles, CurveNode* node, std::int64_t n) {
  if (exec.reduce(n, std::int64_t(0), LacksPrevious{node}, Add{}) == 0) return;
  Arena::Scope scope(exec.arena());
  auto last = exec.arena().template temporary<std::uint32_t>(std::size_t(n));
  auto farther = exec.arena().template temporary<std::uint32_t>(std::size_t(n));
  exec.for_each(n, NextOrSelf{node, last.data()});
  for (std::int64_t steps = 1; steps < n; steps *= 2) {
    exec.for_each(n, TwiceAsFar{last.data(), farther.data()});
    std::swap(last, farther);
  }
  exec.for_each(n, CloseChain{particles, last.data(), node});
}

}  // namespace detail

/// Nodes of curves, in temporary memory.
struct CurveNodes {
  Array<CurveNode> node;
  Array<std::uint32_t> listed, first;

  std::int64_t count() const { return std::int64_t(node.size()); }
  CurveNodesView view() const { return {node.data(), listed.data(), first.data()}; }
};

/// The nodes of all `n` particles, at least one, linked to their neighbours where both of two agree, the nearest first;
/// in temporary memory of the caller's scope.
template <class Backend>
CurveNodes link_curves(Executor<Backend>& exec, const StarParticlesView& particles, std::int64_t n) {
  Arena& arena = exec.arena();
  CurveNodes nodes;
  nodes.first = arena.template temporary<std::uint32_t>(std::size_t(n));
  exec.for_each(n, detail::CountNodes{particles.junction, nodes.first.data()});
  const std::uint32_t count = exec.exclusive_scan(nodes.first.data(), nodes.first.data(), n);
  nodes.node = arena.template temporary<CurveNode>(count);
  nodes.listed = arena.template temporary<std::uint32_t>(count);
  if (count == 0) return nodes;

  Arena::Scope scope(arena);
  const auto position = arena.template temporary<Vec3d>(count);
  const auto tangent = arena.template temporary<Vec3d>(count);
  const auto curve = arena.template temporary<std::uint32_t>(count);
  const auto first = arena.template temporary<std::uint32_t>(count + 1);
  {
    Arena::Scope making(arena);
    const auto made = arena.template temporary<CurveNode>(count);
    const auto made_tangent = arena.template temporary<Vec3d>(count);
    const auto key = arena.template temporary<std::uint64_t>(count);
    const auto number = arena.template temporary<std::uint32_t>(count);
    exec.for_each(n, detail::MakeNodes{particles, nodes.first.data(), made.data(), made_tangent.data(), key.data(),
                                       number.data()});
    exec.sort_pairs(key.data(), number.data(), count);
    exec.for_each(
        count, detail::PutNodes{particles, key.data(), number.data(), made.data(), made_tangent.data(),
                                nodes.node.data(), tangent.data(), position.data(), nodes.listed.data(), curve.data()});
    exec.scan(curve.data(), curve.data(), count);
    exec.for_each(count, detail::NumberCurves{key.data(), count, curve.data(), first.data()});
  }
  StarItemsView at;
  at.position = position.data(), at.surface = curve.data(), at.first = first.data();
  const detail::LinkSearch search{particles, nodes.node.data(), tangent.data(), at, item_boxes(exec, at, count)};
  for (const detail::LinkReach& reach : detail::link_reaches)
    detail::link_within(exec, search, reach, nodes.node.data(), count);
  detail::close_chains(exec, particles, nodes.node.data(), count);
  return nodes;
}

}  // namespace nacre
