// Nacre: which particles of a junction curve follow each other.
#include "compute/meshing/curve_links.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <tuple>

#include "compute/meshing/point_tree.hpp"

namespace nacre {
namespace {

/// How far the next particle may be, in sizes, and how far aside (cosine with the tangents).
struct Reach {
  double sizes, cosine;
};
constexpr Reach reaches[] = {{2.5, 0.5}, {4, 0}, {4, -0.9}};
constexpr double widest_gap = 6;  // sizes

struct Nodes {
  std::vector<CurveNode> node;
  std::vector<Vec3d> tangent;
};

/// Adds the nodes of one particle.
void add_nodes(const StarParticles& particles, std::uint32_t p, std::vector<std::pair<CurveNode, Vec3d>>& nodes) {
  const Junction j = particles.junction[p];
  for (int leave = j.materials() == 3 ? 3 : 0; leave < 4; ++leave) {
    int k[3], n = 0;  // the curve's materials, by their numbers in the junction
    for (int i = 0; i < 4 && n < 3; ++i)
      if (i != leave) k[n++] = i;
    const Vec3d along = normalized(cross(particles.difference(p, k[0], k[1]), particles.difference(p, k[1], k[2])));
    CurveNode node{Junction(j.material(k[0]), j.material(k[1]), j.material(k[2])).packed, p, true, true};
    if (j.materials() == 4) {
      node.has_next = dot(particles.difference(p, leave, k[0]), along) < 0;
      node.has_previous = !node.has_next;
    }
    nodes.push_back({node, along});
  }
}

Nodes make_nodes(const StarParticles& particles) {
  std::vector<std::pair<CurveNode, Vec3d>> all;
  for (std::uint32_t p = 0; p < particles.count(); ++p)
    if (particles.junction[p].order() < 2) add_nodes(particles, p, all);
  std::sort(all.begin(), all.end(), [](const auto& s, const auto& t) {
    return std::tie(s.first.curve, s.first.particle) < std::tie(t.first.curve, t.first.particle);
  });
  Nodes nodes;
  for (const auto& [node, tangent] : all) nodes.node.push_back(node), nodes.tangent.push_back(tangent);
  return nodes;
}

/// Two nodes that may follow each other.
struct Link {
  double length;
  std::uint32_t from, to;
  friend bool operator<(const Link& s, const Link& t) {
    return std::tie(s.length, s.from, s.to) < std::tie(t.length, t.from, t.to);
  }
};

/// What begins and ends nowhere, near each other, is a ring that lacks its last link.
void close_chains(std::vector<CurveNode>& nodes, const StarParticles& particles) {
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].has_previous || nodes[i].previous != none) continue;
    std::uint32_t last = i;
    while (nodes[last].next != none) last = nodes[last].next;
    const Vec3d gap = particles.point(nodes[last].particle) - particles.point(nodes[i].particle);
    if (nodes[last].has_next && length(gap) <= widest_gap * particles.position[nodes[i].particle].w)
      nodes[last].next = i, nodes[i].previous = last;
  }
}

}  // namespace

std::vector<CurveNode> link_curves(const StarParticles& particles) {
  Nodes nodes = make_nodes(particles);
  std::vector<Vec3d> position;
  std::vector<std::uint32_t> first, group;
  for (std::size_t i = 0; i < nodes.node.size(); ++i) {
    if (i == 0 || nodes.node[i].curve != nodes.node[i - 1].curve) first.push_back(std::uint32_t(i));
    group.push_back(std::uint32_t(first.size() - 1));
    position.push_back(particles.point(nodes.node[i].particle));
  }
  first.push_back(std::uint32_t(nodes.node.size()));
  const PointTree tree(position, first);
  std::vector<Link> links;
  for (const Reach& reach : reaches) {
    tbb::enumerable_thread_specific<std::vector<Link>> of_thread;
    const auto list_links = [&](std::uint32_t i, std::vector<PointTree::Found>& found, std::vector<Link>& to_i) {
      const CurveNode& from = nodes.node[i];
      if (!from.has_next || from.next != none) return;
      found.clear();
      tree.within(group[i], position[i], reach.sizes * particles.position[from.particle].w, found);
      for (const auto& [distance2, k] : found) {
        const CurveNode& to = nodes.node[k];
        if (k == i || !to.has_previous || to.previous != none) continue;
        const Vec3d step = position[k] - position[i];
        const double length = std::sqrt(distance2);
        if (std::min(dot(step, nodes.tangent[i]), dot(step, nodes.tangent[k])) >= reach.cosine * length)
          to_i.push_back({length, i, k});
      }
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.node.size(), 256), [&](const auto& range) {
      std::vector<PointTree::Found> found;
      for (std::size_t i = range.begin(); i != range.end(); ++i) list_links(std::uint32_t(i), found, of_thread.local());
    });
    links.clear();
    for (const auto& some : of_thread) links.insert(links.end(), some.begin(), some.end());
    std::sort(links.begin(), links.end());
    for (const Link& link : links) {
      CurveNode &from = nodes.node[link.from], &to = nodes.node[link.to];
      if (from.next != none || to.previous != none) continue;
      from.next = link.to, to.previous = link.from;
    }
  }
  close_chains(nodes.node, particles);
  return std::move(nodes.node);
}

}  // namespace nacre
