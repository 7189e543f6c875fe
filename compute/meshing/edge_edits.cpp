// Nacre: bad triangles removed by changing edges, where the particles stay as they are.
#include "compute/meshing/edge_edits.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "compute/math/sort_unique.hpp"
#include "compute/meshing/flat_tetrahedron.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/vertex_facets.hpp"

namespace nacre {
namespace {

/// How far a change may bend surfaces and curves.
struct Latitude {
  double turn;   ///< least cosine between a triangle's normals before and after
  double bend;   ///< most, of a curve where a point is contracted, in lengths of the side that is left; < 0: not at all
  double cross;  ///< of the mean edge: across so wide a strip a point of a curve is contracted, at most
  double flat;   ///< height by longest edge of a tetrahedron that goes to another material, at most
};
constexpr Latitude at_mediocre{0.8, -1, 0, 0}, at_worst{0.35, 0.25, 0.5, 0.25};
constexpr double least_gain = 1e-6;    // of fitness
constexpr std::size_t most_edits = 8;  // for each bad triangle, in the mean

using Triangles = std::vector<std::uint32_t>;

/// The corner of `t` that is neither `u` nor `v`.
std::uint32_t opposite(const Triangle& t, std::uint32_t u, std::uint32_t v) {
  for (int k = 0; k < 3; ++k)
    if (t[k] != u && t[k] != v) return t[k];
  return u;
}

class Editor {
 public:
  Editor(SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule)
      : mesh_(mesh), order_(order), rule_(rule), table_(mesh.triangles, mesh.points.size()) {}

  EdgeEdits run() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) note(t);
    std::size_t left = most_edits * bad_.size();
    for (bool again = true; again;) {  // what failed may succeed once something beside it has changed
      again = false;
      Triangles failed;
      for (; !bad_.empty() && left > 0; --left) {
        const std::uint32_t t = bad_.begin()->second;
        bad_.erase(bad_.begin());
        if (gone(t) || fitness(mesh_.triangles[t]) >= 1) continue;  // something beside it has changed
        const bool changed = edit(t);
        again |= changed;
        if (!changed) failed.push_back(t);
      }
      for (const std::uint32_t t : failed)
        if (!gone(t)) note(t);
      again &= left > 0;
    }
    compact();
    return std::move(edits_);
  }

 private:
  /// A change: triangles that go, and what stands in their place. `from` is the point that leaves, if one does.
  struct Change {
    Triangles old;
    std::vector<std::pair<MaterialFacet, std::uint32_t>> made;  ///< and the old one whose number each has
    std::uint32_t from = none;
    std::vector<std::uint32_t> crossed = {};  ///< points that were not on a curve, and are now
    double fitness = 0;                       ///< the least of those made
  };

  bool gone(std::uint32_t t) const { return mesh_.triangles[t].a == mesh_.triangles[t].b; }
  const Vec3d& point(std::uint32_t v) const { return mesh_.points[v]; }
  Vec3d normal(const Triangle& t) const { return cross(point(t.b) - point(t.a), point(t.c) - point(t.a)); }

  double fitness(const Triangle& t, const DefectRule& rule) const {
    const bool at_junction = order_[t.a] < 2 || order_[t.b] < 2 || order_[t.c] < 2;
    return triangle_fitness({point(t.a), point(t.b), point(t.c)}, at_junction, rule);
  }
  double fitness(const Triangle& t) const { return fitness(t, rule_); }

  /// Puts a bad triangle on the list.
  void note(std::uint32_t t) {
    const Triangle& corner = mesh_.triangles[t];
    if (ratio_is_above(highest_bad_, point(corner.a), point(corner.b), point(corner.c))) return;
    if (const double f = fitness(corner); f < 1) bad_.insert({f, t});
  }

  Triangles at(std::uint32_t v) const {
    if (const auto changed = changed_.find(v); changed != changed_.end()) return changed->second;
    Triangles result;
    for (const std::uint32_t corner : table_.corners(v)) result.push_back(corner / 3);
    return result;
  }

  Triangles at_edge(std::uint32_t u, std::uint32_t v) const {
    Triangles all = at(u);
    std::erase_if(all, [&](std::uint32_t t) { return !has_corner(mesh_.triangles[t], v); });
    return all;
  }

  std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t t : at(v))
      for (int k = 0; k < 3; ++k)
        if (mesh_.triangles[t][k] != v) result.push_back(mesh_.triangles[t][k]);
    sort_unique(result);
    return result;
  }

  /// Whether an edge is within one interface.
  bool is_within(const Triangles& edge) const {
    return edge.size() == 2 && mesh_.materials[edge[0]] == mesh_.materials[edge[1]];
  }

  /// Does the best that can be done about a bad triangle, if something can.
  bool edit(std::uint32_t t) {
    std::optional<Change> best;
    const auto consider = [&](std::optional<Change> change) {
      if (change && (!best || change->fitness > best->fitness)) best = std::move(change);
    };
    const Triangle corner = mesh_.triangles[t];
    latitude_ = fitness(corner, worst_defects) < 1 ? at_worst : at_mediocre;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t u = corner[k], v = corner[(k + 1) % 3];
      consider(flip(u, v));
      consider(giving_away(u, v));
      consider(contraction(u, v));
      consider(contraction(v, u));
    }
    if (best) make(*best);
    return best.has_value();
  }

  /// The change, if the worst triangle becomes better.
  std::optional<Change> better(Change change) const {
    double before = best_fitness(rule_);
    for (const std::uint32_t t : change.old) before = std::min(before, fitness(mesh_.triangles[t]));
    change.fitness = best_fitness(rule_);
    for (const auto& [made, old] : change.made) change.fitness = std::min(change.fitness, fitness(made.corners));
    if (!(change.fitness > before + least_gain)) return {};
    return change;
  }

  /// ... and none turns.
  std::optional<Change> judged(Change proposed) const {
    std::optional<Change> change = better(std::move(proposed));
    if (!change) return {};
    for (const auto& [made, old] : change->made) {
      Vec3d around{};  // a bad triangle's own normal says little
      for (const std::uint32_t t : change->old)
        if (mesh_.materials[t] == mesh_.materials[old]) around += normal(mesh_.triangles[t]);
      const Triangle& was = mesh_.triangles[old];
      const Vec3d before_turn = change->from == none || fitness(was) < 1 ? around : normal(was),
                  after = normal(made.corners);
      if (!(dot(before_turn, after) > latitude_.turn * length(before_turn) * length(after))) return {};
    }
    return change;
  }

  std::optional<Change> flip(std::uint32_t u, std::uint32_t v) const {
    const Triangles edge = at_edge(u, v);
    if (!is_within(edge)) return {};
    Triangle first = mesh_.triangles[edge[0]];
    while (first.c == u || first.c == v) first = {first.b, first.c, first.a};
    const std::uint32_t c = first.c, d = opposite(mesh_.triangles[edge[1]], u, v);
    if (c == d || !at_edge(c, d).empty()) return {};
    const auto& materials = mesh_.materials[edge[0]];
    return judged({edge, {{{{first.a, d, c}, materials}, edge[0]}, {{{d, first.b, c}, materials}, edge[1]}}});
  }

  /// Gives the flat tetrahedron between the two triangles of an edge, and others, to the material on their other side.
  /// So a fold of a surface goes that no flip can open, since the mesh has the new edge.
  std::optional<Change> giving_away(std::uint32_t u, std::uint32_t v) const {
    Triangles faces = at_edge(u, v);
    if (!(latitude_.flat > 0) || !is_within(faces)) return {};
    const std::uint32_t c = opposite(mesh_.triangles[faces[0]], u, v), d = opposite(mesh_.triangles[faces[1]], u, v);
    if (c == d || !is_flat({u, v, c, d})) return {};
    for (const std::uint32_t t : at_edge(c, d))
      if (has_corner(mesh_.triangles[t], u) || has_corner(mesh_.triangles[t], v)) faces.push_back(t);
    std::vector<MaterialFacet> facets;
    for (const std::uint32_t t : faces) facets.push_back({mesh_.triangles[t], mesh_.materials[t]});
    const auto left = give_away(u, v, c, d, facets);
    if (!left) return {};
    Change change{std::move(faces), {}};
    for (std::size_t k = 0; k < left->size(); ++k) change.made.push_back({(*left)[k], change.old[k]});
    if (!stays_sound(change, {u, v, c, d})) return {};
    return better(std::move(change));
  }

  bool is_flat(const std::array<std::uint32_t, 4>& corners) const {
    double longest = 0, largest = 0;  // edge, twice the area of a face
    for (int i = 0; i < 4; ++i) {
      const Vec3d a = point(corners[i]), b = point(corners[(i + 1) % 4]), e = point(corners[(i + 2) % 4]);
      longest = std::max({longest, length(b - a), length(e - a)});
      largest = std::max(largest, length(cross(b - a, e - a)));
    }
    const Vec3d a = point(corners[0]);
    const double volume = std::abs(dot(point(corners[1]) - a, cross(point(corners[2]) - a, point(corners[3]) - a)));
    return volume < latitude_.flat * longest * largest;
  }

  /// Whether no surface touches itself at these points after the change that did not before, and all materials are
  /// still there. Lists the points that come to lie on curves.
  bool stays_sound(Change& change, const std::array<std::uint32_t, 4>& corners) const {
    std::vector<std::uint16_t> materials, left;
    for (const std::uint32_t v : corners) {
      const VertexFacets before = facets_at(v, at(v)), after = facets_after(v, change);
      if (after.empty() && order_[v] == 0) return false;  // such points stay
      if (touches_more(before, after) || is_pinched(after) || !edges_pass_once(after)) return false;
      for (const VertexFanCounter::Facet& f : before)
        materials.insert(materials.end(), {f.materials[0], f.materials[1]});
      for (const VertexFanCounter::Facet& f : after) left.insert(left.end(), {f.materials[0], f.materials[1]});
      const bool several =
          std::any_of(after.begin(), after.end(), [&](const auto& f) { return f.materials != after[0].materials; });
      if (order_[v] == 2 && several) change.crossed.push_back(v);
    }
    sort_unique(materials), sort_unique(left);
    return materials == left;
  }

  static void add_facet(VertexFacets& facets, std::uint32_t v, const Triangle& t, const MaterialPair& materials) {
    for (int k = 0; k < 3; ++k)
      if (t[k] == v) facets.push_back({t[(k + 1) % 3], t[(k + 2) % 3], materials});
  }

  VertexFacets facets_at(std::uint32_t v, const Triangles& some) const {
    VertexFacets facets;
    for (const std::uint32_t t : some) add_facet(facets, v, mesh_.triangles[t], mesh_.materials[t]);
    return facets;
  }

  VertexFacets facets_after(std::uint32_t v, const Change& change) const {
    Triangles stay = at(v);
    std::erase_if(
        stay, [&](std::uint32_t t) { return std::find(change.old.begin(), change.old.end(), t) != change.old.end(); });
    VertexFacets facets = facets_at(v, stay);
    for (const auto& [made, old] : change.made) add_facet(facets, v, made.corners, made.materials);
    return facets;
  }

  /// Moves point `u` onto its neighbour `v`.
  std::optional<Change> contraction(std::uint32_t u, std::uint32_t v) const {
    if (order_[u] == 0) return {};
    const Triangles edge = at_edge(u, v);
    if (!may_leave(u, v, edge)) return {};
    const std::vector<std::uint32_t> of_u = neighbours(u), of_v = neighbours(v);
    std::vector<std::uint32_t> common;
    std::set_intersection(of_u.begin(), of_u.end(), of_v.begin(), of_v.end(), std::back_inserter(common));
    if (common.size() != edge.size()) return {};
    Change change{at(u), {}, u};
    if (order_[u] == 1 && is_within(edge)) change.crossed.push_back(v);
    for (const std::uint32_t t : change.old) {
      Triangle made = mesh_.triangles[t];
      if (has_corner(made, v)) continue;
      (made.a == u ? made.a : made.b == u ? made.b : made.c) = v;
      for (int k = 0; k < 3; ++k)  // the edge beyond u must not be beyond v, too
        if (made[k] != v && made[(k + 1) % 3] != v)
          for (const std::uint32_t other : at_edge(made[k], made[(k + 1) % 3]))
            if (has_corner(mesh_.triangles[other], v)) return {};
      change.made.push_back({{made, mesh_.materials[t]}, t});
    }
    if (change.made.empty()) return {};
    if (order_[u] < 2) {  // where a curve goes, surfaces may be left that touch
      std::vector<std::uint32_t> there = of_u;
      std::erase(there, v), there.push_back(v);
      if (std::any_of(there.begin(), there.end(), [&](std::uint32_t w) { return is_pinched(facets_after(w, change)); }))
        return {};
    }
    return judged(std::move(change));
  }

  /// Whether `u` may become `v`: it lies within a surface, whose triangles there are one fan, or between two points on
  /// a curve, of which `v` is one, or across a narrow strip of surface from `v`.
  bool may_leave(std::uint32_t u, std::uint32_t v, const Triangles& edge) const {
    std::vector<std::uint32_t> along;  // its curve
    for (const std::uint32_t w : neighbours(u)) {
      const Triangles shared = at_edge(u, w);
      if (!is_within(shared)) {
        if (shared.size() < 3) return false;
        along.push_back(w);
      }
    }
    if (along.empty()) return is_one_fan(u);
    if (along.size() != 2 || !sheets_are_fans(u, along[0], along[1])) return false;
    if (is_within(edge)) return may_cross(u, v, edge);
    const std::uint32_t w = along[0] == v ? along[1] : along[0];
    if (along[0] != v && along[1] != v) return false;
    const Vec3d side = point(w) - point(v), away = point(u) - point(v);
    const double along_side = std::clamp(dot(away, side) / dot(side, side), 0.0, 1.0);
    return length(away - side * along_side) < latitude_.bend * length(side);
  }

  /// Whether `u`, on a curve, is so near to `v` across a surface that the curve may go through `v`: two curves that
  /// leave less than a particle's room then meet there. No other material may have both points, or it would be pinched.
  bool may_cross(std::uint32_t u, std::uint32_t v, const Triangles& edge) const {
    const std::vector<std::uint16_t> of_u = materials_at(u), of_v = materials_at(v);
    std::vector<std::uint16_t> common;
    std::set_intersection(of_u.begin(), of_u.end(), of_v.begin(), of_v.end(), std::back_inserter(common));
    const auto [low, high] = mesh_.materials[edge[0]];
    if (of_u.size() != 3 || common != std::vector<std::uint16_t>{low, high}) return false;
    const std::vector<std::uint32_t> around = neighbours(u);
    double sum = 0;
    for (const std::uint32_t w : around) sum += length(point(w) - point(u));
    return length(point(u) - point(v)) < latitude_.cross * sum / double(around.size());
  }

  /// Ascending.
  std::vector<std::uint16_t> materials_at(std::uint32_t v) const {
    std::vector<std::uint16_t> result;
    for (const std::uint32_t t : at(v))
      for (const std::uint16_t m : mesh_.materials[t]) result.push_back(m);
    sort_unique(result);
    return result;
  }

  bool is_one_fan(std::uint32_t u) const {
    const Triangles all = at(u);
    std::uint32_t from = opposite(mesh_.triangles[all[0]], u, u), before = none;
    const std::uint32_t first = from;
    for (std::size_t steps = 0; steps < all.size(); ++steps) {
      const Triangles shared = at_edge(u, from);
      if (shared.size() != 2) return false;
      const std::uint32_t next = shared[0] == before ? shared[1] : shared[0];
      before = next;
      from = opposite(mesh_.triangles[next], u, from);
      if (from == first) return steps + 1 == all.size();
    }
    return false;
  }

  /// Each sheet at the curve point `u` goes in one fan from one of its neighbours on the curve to the other.
  bool sheets_are_fans(std::uint32_t u, std::uint32_t w, std::uint32_t v) const {
    std::size_t seen = 0;
    for (const std::uint32_t begin : at_edge(u, w)) {
      std::uint32_t t = begin, from = w;
      for (;;) {
        ++seen;
        from = opposite(mesh_.triangles[t], u, from);
        if (from == v) break;
        const Triangles shared = at_edge(u, from);
        if (!is_within(shared) || seen > at(u).size()) return false;
        t = shared[0] == t ? shared[1] : shared[0];
      }
    }
    return seen == at(u).size();
  }

  void make(const Change& change) {
    ++(change.from == none ? edits_.flips : edits_.contractions);
    std::vector<std::uint32_t> touched;
    for (const std::uint32_t t : change.old)
      for (int k = 0; k < 3; ++k) touched.push_back(mesh_.triangles[t][k]);
    sort_unique(touched);
    for (const std::uint32_t v : touched) {
      Triangles& list = changed_.try_emplace(v, at(v)).first->second;
      std::erase_if(list, [&](std::uint32_t t) {
        return std::find(change.old.begin(), change.old.end(), t) != change.old.end();
      });
    }
    for (const std::uint32_t t : change.old) mesh_.triangles[t] = {0, 0, 0};
    for (const auto& [made, t] : change.made) {
      mesh_.triangles[t] = made.corners, mesh_.materials[t] = made.materials;
      for (int k = 0; k < 3; ++k) changed_[made.corners[k]].push_back(t);
    }
    for (const auto& [made, t] : change.made) note(t);
    crossed_.insert(crossed_.end(), change.crossed.begin(), change.crossed.end());
  }

  /// Leaves out triangles that are gone, and points that no triangle has any more.
  void compact() {
    const std::size_t points = mesh_.points.size();
    std::vector<std::uint8_t> left(points, 1);
    for (const auto& [v, list] : changed_) left[v] = !list.empty();
    std::vector<std::uint32_t> number(points);
    for (std::uint32_t v = 0; v < points; ++v) {
      number[v] = std::uint32_t(edits_.kept.size());
      if (!left[v]) continue;
      mesh_.points[edits_.kept.size()] = mesh_.points[v];
      edits_.kept.push_back(v);
    }
    mesh_.points.resize(edits_.kept.size());
    for (const std::uint32_t v : crossed_)
      if (left[v]) edits_.crossed.push_back(number[v]);
    sort_unique(edits_.crossed);
    std::size_t to = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (gone(t)) continue;
      const Triangle& corner = mesh_.triangles[t];
      mesh_.materials[to] = mesh_.materials[t];
      mesh_.triangles[to++] = {number[corner.a], number[corner.b], number[corner.c]};
    }
    mesh_.triangles.resize(to), mesh_.materials.resize(to);
  }

  SurfaceMesh& mesh_;
  std::span<const std::uint8_t> order_;
  const DefectRule rule_;
  const double highest_bad_ = highest_bad_ratio(rule_);
  const VertexTable table_;                               ///< of the triangles as they were
  std::unordered_map<std::uint32_t, Triangles> changed_;  ///< those at the points that have others now
  std::set<std::pair<double, std::uint32_t>> bad_;        ///< by fitness
  Latitude latitude_ = at_worst;                          ///< of the edit that is considered
  std::vector<std::uint32_t> crossed_;                    ///< points that curves were led through
  EdgeEdits edits_;
};

}  // namespace

EdgeEdits edit_edges(SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule) {
  return Editor(mesh, order, rule).run();
}

}  // namespace nacre
