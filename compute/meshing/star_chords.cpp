// Nacre: edges between two rims that more than one surface has.
#include "compute/meshing/star_chords.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace nacre {
namespace {

constexpr double least_facing = 0.3;  // cosine between a triangle and the normals at its corners

/// A side of a triangle between two rims, as particles.
struct Chord {
  std::uint32_t low, high, surface, triangle;  // the last one as a number among those between rims
  int side;
  bool same_ends(const Chord& other) const { return low == other.low && high == other.high; }
  friend bool operator<(const Chord& s, const Chord& t) {
    return std::tie(s.low, s.high, s.surface, s.triangle) < std::tie(t.low, t.high, t.surface, t.triangle);
  }
};

bool on_rim(const StarItems& items, std::uint32_t i) { return items.next[i] != none; }

std::vector<Chord> list_chords(const StarItems& items, std::span<const RimTriangle> between_rims) {
  std::vector<Chord> chords;
  for (std::uint32_t i = 0; i < between_rims.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const Triangle& t = between_rims[i].items;
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (!on_rim(items, a) || !on_rim(items, b) || items.next[a] == b || items.next[b] == a) continue;
      const auto [low, high] = std::minmax(items.particle[a], items.particle[b]);
      chords.push_back({low, high, items.surface[a], i, k});
    }
  std::sort(chords.begin(), chords.end());
  return chords;
}

/// Calls visit(first, last) for the chords with the same ends, where two surfaces have them.
template <class Visit>
void for_shared(std::span<const Chord> chords, const Visit& visit) {
  for (std::size_t i = 0, k = 0; i < chords.size(); i = k) {
    for (k = i; k < chords.size() && chords[k].same_ends(chords[i]); ++k) {
    }
    if (chords[i].surface != chords[k - 1].surface) visit(i, k);
  }
}

/// The other diagonal of two triangles, and what they become.
struct Exchange {
  std::array<std::uint32_t, 2> changed;  // triangles
  std::array<Triangle, 2> to;
  std::array<std::uint32_t, 2> edge;  // the new one, ascending
  double worth = 0;                   // of the worse triangle: area by squared sides; 0: none
};

double worth_of(const StarItems& items, const Triangle& t) {
  const Vec3d u = items.position[t.b] - items.position[t.a], v = items.position[t.c] - items.position[t.a],
              n = cross(u, v);
  const Vec3d up = normalized(items.normal[t.a] + items.normal[t.b] + items.normal[t.c]);
  const double twice_area = length(n);
  if (!(dot(n, up) > least_facing * twice_area)) return 0;
  return twice_area / (dot(u, u) + dot(v, v) + dot(v - u, v - u));
}

/// Of the two triangles at a chord of one surface.
Exchange exchange_of(const StarItems& items, std::span<const RimTriangle> between_rims, const Chord& s,
                     const Chord& t) {
  const Triangle &first = between_rims[s.triangle].items, &second = between_rims[t.triangle].items;
  const std::uint32_t a = first[s.side], b = first[(s.side + 1) % 3], c = first[(s.side + 2) % 3],
                      d = second[(t.side + 2) % 3];
  Exchange exchange{{s.triangle, t.triangle}, {{{a, d, c}, {d, b, c}}}, {std::min(c, d), std::max(c, d)}};
  if (second[t.side] != b || second[(t.side + 1) % 3] != a || c == d) return exchange;
  if (items.next[c] == d || items.next[d] == c) return exchange;
  exchange.worth = std::min(worth_of(items, exchange.to[0]), worth_of(items, exchange.to[1]));
  return exchange;
}

/// Those of the exchanges whose edges there are already are worth nothing.
void refuse_known_edges(std::span<const Star> stars, std::span<const Triangle> filled,
                        std::vector<std::vector<Exchange>>& wanted) {
  std::vector<std::array<std::uint32_t, 2>> edges, known;
  for (const auto& some : wanted)
    for (const Exchange& e : some) {
      edges.push_back(e.edge);
      if (stars[e.edge[0]].has_agreed_edge(e.edge[1])) known.push_back(e.edge);
    }
  std::sort(edges.begin(), edges.end());
  for (const Triangle& t : filled)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({t[k], t[(k + 1) % 3]});
      if (std::binary_search(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{low, high}))
        known.push_back({low, high});
    }
  std::sort(known.begin(), known.end());
  for (auto& some : wanted)
    for (Exchange& e : some)
      if (std::binary_search(known.begin(), known.end(), e.edge)) e.worth = 0;
}

}  // namespace

std::vector<std::uint32_t> at_shared_chords(const StarItems& items, std::span<const RimTriangle> between_rims) {
  const std::vector<Chord> chords = list_chords(items, between_rims);
  std::vector<std::uint32_t> shared;
  for_shared(chords, [&](std::size_t first, std::size_t) {
    shared.push_back(chords[first].low), shared.push_back(chords[first].high);
  });
  return shared;
}

std::vector<std::uint32_t> exchange_shared_chords(const StarItems& items, std::span<const Star> stars,
                                                  std::span<const Triangle> filled,
                                                  std::vector<RimTriangle>& between_rims) {
  const std::vector<Chord> chords = list_chords(items, between_rims);
  std::vector<std::vector<Exchange>> wanted;  // per shared edge, one for each surface
  for_shared(chords, [&](std::size_t first, std::size_t last) {
    wanted.emplace_back();
    for (std::size_t i = first; i + 1 < last; ++i)
      if (chords[i].surface == chords[i + 1].surface)
        wanted.back().push_back(exchange_of(items, between_rims, chords[i], chords[i + 1]));
  });
  refuse_known_edges(stars, filled, wanted);
  std::vector<std::uint32_t> changed;
  std::vector<std::array<std::uint32_t, 2>> made;
  for (const auto& some : wanted) {
    const auto best = std::max_element(some.begin(), some.end(),
                                       [](const Exchange& s, const Exchange& t) { return s.worth < t.worth; });
    if (best == some.end() || !(best->worth > 0)) continue;
    const auto is_changed = [&](std::uint32_t t) {
      return std::find(changed.begin(), changed.end(), t) != changed.end();
    };
    if (is_changed(best->changed[0]) || is_changed(best->changed[1])) continue;
    if (std::find(made.begin(), made.end(), best->edge) != made.end()) continue;
    for (std::size_t k = 0; k < 2; ++k)
      between_rims[best->changed[k]].items = best->to[k], changed.push_back(best->changed[k]);
    made.push_back(best->edge);
  }
  return changed;
}

}  // namespace nacre
