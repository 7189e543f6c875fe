// Nacre: a quarter of the particles, twice as far apart, to begin with, and all of them from these: a new particle in
// the middle of each link between two neighbours. A hexagonal lattice stays one.
#pragma once

#include "compute/particles/projectors.hpp"
#include "compute/particles/tree_forces.hpp"

namespace nacre {

/// Interfaces with fewer particles keep all of them.
inline constexpr std::uint32_t fewest_on_thinned_surface = 2000, fewest_on_thinned_curve = 8;

namespace detail {

/// Which particles of an order stay, and how far apart they are to be: of those along the tree's order on a surface
/// every fourth, on a curve every second.
struct ThinParticles {
  TreeView tree;
  RelatedView related;
  int order;
  const std::uint32_t* interface;
  std::uint32_t* kept;
  float* spacing;  ///< per interface

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t group = interface[i];
    kept[i] = 1;
    if (related.order[group] != order) return;
    const TreeNode& root = tree.node[group];
    if (root.last - root.first < (order == 2 ? fewest_on_thinned_surface : fewest_on_thinned_curve)) return;
    const std::uint32_t place = std::uint32_t(i) - root.first;
    kept[i] = place % (order == 2 ? 4 : 2) == 0 ? 1 : 0;
    if (place == 0) spacing[group] = 2;
  }
};

struct ListKept {
  const std::uint32_t *kept, *start;
  std::uint32_t* number;
  NACRE_HD void operator()(std::int64_t i) const {
    if (kept[i] != 0) number[start[i]] = std::uint32_t(i);
  }
};

/// At rest, with sizes for the spacing that begins or, by `factor` 1/2, ends.
struct ScaleSizes {
  RelatedView related;
  int order;  ///< of those concerned; -1: all
  float factor;
  const float* spacing;
  const std::uint32_t* interface;
  Float4* position;
  Float4* velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t group = interface[i];
    velocity[i] = {0, 0, 0, 0};
    if (spacing[group] > 1 && (order < 0 || related.order[group] == order)) position[i].w *= factor;
  }
};

struct ResetSpacing {
  float* spacing;
  NACRE_HD void operator()(std::int64_t i) const { spacing[i] = 1; }
};

/// The middles of the links between a particle and its neighbours, on their interface. On a surface links are the edges
/// of a Delaunay triangulation, where the surface is flat enough: the largest angles under which the particles on its
/// two sides see a link add up to less than 180 degrees. On a curve no other particle is between. Links of a surface
/// lead to its rim's particles, too.
template <class Projector>
struct LinkMiddles {
  TreeView tree;
  RelatedView related;
  Projector projector;
  const std::uint32_t* interface;
  const float* spacing;

  static constexpr int most_near = 48, most_links = 24;
  static constexpr float longest = 2.2f;     ///< link, in h
  static constexpr float least_bend = 0.2f;  ///< cosine between the normals of linked particles

  /// Lists the links that are this particle's to halve, by what they lead to: others with higher numbers, or on the
  /// rim. Returns how many these are, at most `most_links`.
  NACRE_HD std::uint32_t list(std::int64_t i, std::uint32_t* to) const {
    const std::uint32_t group = interface[i];
    if (!(spacing[group] > 1)) return 0;
    std::uint32_t near[most_near], links = 0;
    const Vec3f p = at(std::uint32_t(i));
    const float h = tree.position[i].w;
    EmbeddedPoint here;  // its size is twice the field's, unless thinning was interrupted
    if (!projector.project(group, p, 0.5f * h, here) || h < 1.5f * here.h) return 0;
    const int count = find_near(i, group, near);
    for (int k = 0; k < count && links < most_links; ++k) {
      if (interface[near[k]] == group && near[k] < std::uint32_t(i)) continue;
      EmbeddedPoint on;
      if (is_link(i, at(near[k]) - p, k, near, count) && middle(i, near[k], on)) to[links++] = near[k];
    }
    return links;
  }

  /// The middle of the link to another particle; false where the interface is not there.
  NACRE_HD bool middle(std::int64_t i, std::uint32_t other, EmbeddedPoint& on) const {
    const Vec3f p = at(std::uint32_t(i)), along = at(other) - p, middle = p + along * 0.5f;
    if (!projector.project(interface[i], middle, 0.5f * tree.position[i].w, on) || on.margin < 0) return false;
    const Vec3f off = on.p - middle;
    return dot(off, off) <= 0.25f * dot(along, along);
  }

 private:
  /// Whether particle i is linked to number `other` of those near it, which is `along` away.
  NACRE_HD bool is_link(std::int64_t i, const Vec3f& along, int other, const std::uint32_t* near, int count) const {
    const Float4 d = tree.direction[i];
    const Vec3f p = at(std::uint32_t(i)), side = cross(Vec3f(d.x, d.y, d.z), along);
    const bool surface = related.order[interface[i]] == 2;
    float left = 1, right = 1;  // cosines of the largest angles
    for (int l = 0; l < count; ++l) {
      if (l == other) continue;
      const Vec3f a = p - at(near[l]), b = a + along;
      const float aa = dot(a, a), bb = dot(b, b);
      const float cosine = aa > 0 && bb > 0 ? dot(a, b) / std::sqrt(aa * bb) : -1;
      float& least = surface && dot(a, side) < 0 ? left : right;
      least = cosine < least ? cosine : least;
    }
    // With no one on one side, as on a curve: no one in the ball that has the two as poles.
    return left == 1 || right == 1 ? left + right >= 1 : left + right >= 0;
  }

  NACRE_HD Vec3f at(std::uint32_t k) const { return {tree.position[k].x, tree.position[k].y, tree.position[k].z}; }

  /// The others that a link could lead to, at most `most_near`, first those of its own interface.
  NACRE_HD int find_near(std::int64_t i, std::uint32_t group, std::uint32_t* near) const {
    const Float4 d = tree.direction[i];
    const Vec3f p = at(std::uint32_t(i)), n(d.x, d.y, d.z);
    const float reach = longest * tree.position[i].w;
    int count = 0;
    for (std::uint32_t k = related.start[group]; k < related.start[group + 1]; ++k) {
      const std::uint32_t root = related.related[k];
      const bool bends = root == group && related.order[group] == 2;
      tree.walk(
          root, p, p, 2 * reach,
          [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t q = first; q < last; ++q) {
              const Vec3f r = at(q) - p;
              if (q == i || count == most_near || !(dot(r, r) < reach * reach)) continue;
              const Float4 e = tree.direction[q];
              if (!bends || dot(n, Vec3f(e.x, e.y, e.z)) > least_bend) near[count++] = q;
            }
          },
          [](const TreeNode&) {});
    }
    return count;
  }
};

template <class Projector>
struct ListLinks {
  LinkMiddles<Projector> links;
  std::uint32_t* to;  ///< `most_links` for each particle
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    count[i] = links.list(i, to + LinkMiddles<Projector>::most_links * i);
  }
};

template <class Projector>
struct WriteMiddles {
  LinkMiddles<Projector> links;
  const std::uint32_t* link_to;
  const std::uint32_t* count;
  const std::uint32_t* start;
  std::int64_t first;  ///< number of the first new particle
  Float4* position;
  Float4* direction;
  std::uint32_t* interface;
  Float4* velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    std::int64_t to = first + start[i];
    const std::uint32_t group = interface[i];
    for (std::uint32_t k = 0; k < count[i]; ++k) {
      EmbeddedPoint on{};  // there is one: the link was listed
      links.middle(i, link_to[LinkMiddles<Projector>::most_links * i + k], on);
      position[to] = {on.p.x, on.p.y, on.p.z, on.h};
      velocity[to] = {0, 0, 0, 0};
      direction[to] = {on.direction.x, on.direction.y, on.direction.z, 0};
      interface[to++] = group;
    }
  }
};

}  // namespace detail

}  // namespace nacre
