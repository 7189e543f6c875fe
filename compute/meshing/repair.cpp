// Nacre: labels of Delaunay cells changed where the surface between them would touch itself.
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/cell_rings.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/interface_facets.hpp"
#include "compute/meshing/repair_at.hpp"
#include "compute/meshing/vertex_fans.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_cells = 16;  // that one change may touch
constexpr double flat = 0.02;           // volume by longest edge^3; 0.118 in a regular cell
constexpr int most_steps = 3;           // of changes that help together only
constexpr int most_debt = 3;            // how much worse it may be in between
constexpr int most_tries = 1000;        // at one position

/// An edge (a < b), or the vertex a where a == b, and a cell that has it.
struct Defect {
  std::uint32_t a, b;
  std::int32_t cell;
  friend bool operator<(const Defect& s, const Defect& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; }
  friend bool operator==(const Defect& s, const Defect& t) { return s.a == t.a && s.b == t.b; }
};

/// Cells that might all get another label.
struct Change {
  std::vector<std::int32_t> cells;
  std::uint16_t label;
  double volume;
  bool may_vanish = false;  ///< their material goes on beyond this position, so that no body is lost with them
};

class Repair {
 public:
  Repair(std::span<const Vec3d> points, const DelaunayCells& cells, std::vector<std::uint16_t>& label,
         const std::atomic<bool>* stop, std::span<const std::uint8_t> there)
      : points_(points),
        cells_(cells),
        label_(label),
        stop_(stop),
        there_(there),
        rings_(cells),
        left_(std::size_t(0x10000)) {
    for (const std::uint16_t m : label) ++left_[m];
  }

  LabelRepair run() {
    fill_pockets();
    for (const Defect& defect : find_defects()) waiting_.push_back(defect);
    // Most give way to one change. What does not is tried again once all is quiet around it: without its crumbs, then
    // by several changes.
    std::vector<Defect> stuck = work_off(0);
    for (const int steps : {0, most_steps}) {
      crumbs_may_go_ = true;
      waiting_.assign(stuck.begin(), stuck.end());
      stuck = work_off(steps);
    }
    for (const Defect& defect : stuck) result_.defects.push_back({defect.a, defect.b});
    result_.left = std::int64_t(stuck.size());
    return result_;
  }

 private:
  /// Improves what waits; returns what still touches itself, ascending.
  std::vector<Defect> work_off(int steps) {
    std::vector<Defect> stuck;
    while (!waiting_.empty()) {
      check_stop(stop_);
      const Defect defect = waiting_.front();
      waiting_.pop_front();
      if (excess(defect) > 0 && !repair_at(defect, steps)) stuck.push_back(defect);
    }
    std::sort(stuck.begin(), stuck.end());
    stuck.erase(std::unique(stuck.begin(), stuck.end()), stuck.end());
    std::erase_if(stuck, [&](const Defect& defect) { return excess(defect) == 0; });
    return stuck;
  }

  std::uint16_t label_at(std::int32_t cell) const { return cell < 0 ? std::uint16_t(0) : label_[cell]; }

  double volume(std::int32_t cell) const {
    const auto& v = cells_.vertices[cell];
    const Vec3d a = points_[v[0]];
    return std::abs(dot(points_[v[1]] - a, cross(points_[v[2]] - a, points_[v[3]] - a))) / 6;
  }

  bool is_flat(std::int32_t cell) const {
    double longest = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) {
        const Vec3d edge = points_[cells_.vertices[cell][i]] - points_[cells_.vertices[cell][j]];
        longest = std::max(longest, dot(edge, edge));
      }
    return volume(cell) < flat * longest * std::sqrt(longest);
  }

  bool is_alone(std::int32_t cell) const {
    return std::none_of(cells_.neighbours[cell].begin(), cells_.neighbours[cell].end(),
                        [&](std::int32_t n) { return n >= 0 && label_[n] == label_[cell]; });
  }

  // ---- how badly the surface touches itself at a position

  /// Wedges or vertex fans of each material beyond its first, summed.
  int excess(const Defect& defect) { return defect.a == defect.b ? vertex_excess(defect) : edge_excess(defect); }

  int edge_excess(const Defect& edge) {
    const auto& ring = rings_.around_edge(edge.a, edge.b, edge.cell);
    std::array<std::uint16_t, 64> seen;  // labels of wedges so far; more than that do not fit around an edge
    std::size_t wedges = 0;
    int extra = 0;
    for (std::size_t i = 0; i < ring.size() && wedges < seen.size(); ++i) {
      const std::uint16_t here = label_at(ring[i]);
      if (here == label_at(ring[i == 0 ? ring.size() - 1 : i - 1])) continue;
      extra += std::find(seen.begin(), seen.begin() + wedges, here) != seen.begin() + wedges;
      seen[wedges++] = here;
    }
    return extra;
  }

  int vertex_excess(const Defect& vertex) {
    facets_.clear();
    for (const std::int32_t cell : rings_.around_vertex(vertex.a, vertex.cell)) {
      const auto& v = cells_.vertices[cell];
      for (int k = 0; k < 4; ++k) {
        const std::int32_t beyond = cells_.neighbours[cell][k];
        if (v[k] == vertex.a || (beyond >= 0 && beyond < cell)) continue;
        const std::uint16_t s = label_[cell], t = label_at(beyond);
        if (s == t) continue;
        std::array<std::uint32_t, 2> others{};
        for (int i = 0, n = 0; i < 4; ++i)
          if (i != k && v[i] != vertex.a) others[n++] = v[i];
        facets_.push_back({others[0], others[1], {s, t}});
      }
    }
    int extra = 0;
    for (const MaterialCount& c : counter_.vertex_fans(facets_)) extra += c.count - 1;
    return extra;
  }

  /// The edges and vertices of some cells, each once, ascending.
  std::vector<Defect> defects_of(const std::vector<std::int32_t>& cells) const {
    std::vector<Defect> defects;
    for (const std::int32_t cell : cells)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j <= i; ++j) {
          const auto [a, b] = std::minmax(cells_.vertices[cell][i], cells_.vertices[cell][j]);
          defects.push_back({a, b, cell});
        }
    std::sort(defects.begin(), defects.end());
    defects.erase(std::unique(defects.begin(), defects.end()), defects.end());
    return defects;
  }

  int excess(const std::vector<Defect>& defects) {
    int sum = 0;
    for (const Defect& defect : defects) sum += excess(defect);
    return sum;
  }

  // ---- changes

  /// Puts the new label on the cells one after the other; takes all back and says no where a component would be lost.
  bool apply(const Change& change, std::uint16_t old) {
    for (std::size_t i = 0; i < change.cells.size(); ++i) {
      const std::int32_t cell = change.cells[i];
      if (left_[old] == 1 || (is_alone(cell) && !is_flat(cell) && !change.may_vanish)) {
        take_back(change, i, old);
        return false;
      }
      label_[cell] = change.label;
      --left_[old];
      ++left_[change.label];
    }
    return true;
  }

  void take_back(const Change& change, std::size_t applied, std::uint16_t old) {
    for (std::size_t i = 0; i < applied; ++i) label_[change.cells[i]] = old;
    left_[old] += std::int64_t(applied);
    left_[change.label] -= std::int64_t(applied);
  }

  /// Makes the change if that lowers the excess around it by `gain` at least, maybe with up to `steps` more where it
  /// does harm. A change concerns its own cells alone, so that what each one gains adds up.
  bool try_change(const Change& change, int gain, int steps) {
    const std::uint16_t old = label_[change.cells[0]];
    const std::vector<Defect> defects = defects_of(change.cells);
    const int before = excess(defects);
    if (!apply(change, old)) return false;
    const int missing = gain - (before - excess(defects));
    if (missing <= 0 || (steps > 0 && missing <= most_debt && make_up(defects, missing, steps))) {
      result_.changed += std::int64_t(change.cells.size());
      waiting_.insert(waiting_.end(), defects.begin(), defects.end());
      return true;
    }
    take_back(change, change.cells.size(), old);
    return false;
  }

  bool make_up(const std::vector<Defect>& defects, int gain, int steps) {
    for (const Defect& defect : defects) {
      if (excess(defect) == 0) continue;
      for (const Change& change : changes_at(defect)) {
        if (--tries_ <= 0) return false;
        if (try_change(change, gain, steps - 1)) return true;
      }
    }
    return false;
  }

  /// The smallest change at a position that helps.
  bool repair_at(const Defect& defect, int steps) {
    tries_ = most_tries;
    const std::vector<Change> changes = changes_at(defect);
    return std::any_of(changes.begin(), changes.end(), [&](const Change& c) { return try_change(c, 1, steps); });
  }

  /// The smallest first.
  std::vector<Change> changes_at(const Defect& defect) {
    std::vector<Change> changes = defect.a == defect.b ? changes_at_vertex(defect) : changes_at_edge(defect);
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& s, const Change& t) { return s.volume < t.volume; });
    return changes;
  }

  /// A part of a material at a position, and the labels beside it.
  struct Part {
    std::vector<std::int32_t> cells;
    std::vector<std::uint16_t> beside;
  };

  /// Each part could get the label of one beside it. So could all of a crumb that touches the rest of its material here
  /// alone.
  std::vector<Change> changes_of(const std::vector<Part>& parts) const {
    std::vector<Change> changes;
    for (const Part& part : parts) {
      if (std::any_of(part.cells.begin(), part.cells.end(), [](std::int32_t cell) { return cell < 0; }))
        continue;  // it goes on beyond the hull
      const auto alike = [&](const Part& p) { return label_at(p.cells[0]) == label_at(part.cells[0]); };
      const bool several = crumbs_may_go_ && std::count_if(parts.begin(), parts.end(), alike) > 1;
      add_changes(changes, part, several);
      if (!several || part.cells.size() > most_cells) continue;
      const Part crumb = component_of(part.cells);
      if (crumb.cells.size() > part.cells.size()) add_changes(changes, crumb, true);
    }
    return changes;
  }

  /// What hangs together with the cells, as far as that is no more than one change may touch.
  Part component_of(const std::vector<std::int32_t>& cells) const {
    Part whole{cells, {}};
    for (std::size_t next = 0; next < whole.cells.size() && whole.cells.size() <= most_cells; ++next)
      for (const std::int32_t beyond : cells_.neighbours[whole.cells[next]]) {
        if (label_at(beyond) != label_[cells[0]])
          whole.beside.push_back(label_at(beyond));
        else if (beyond >= 0 && std::find(whole.cells.begin(), whole.cells.end(), beyond) == whole.cells.end())
          whole.cells.push_back(beyond);
      }
    return whole;
  }

  void add_changes(std::vector<Change>& changes, const Part& part, bool may_vanish) const {
    if (part.cells.size() > most_cells) return;
    double sum = 0;
    for (const std::int32_t cell : part.cells) {
      if (cell < 0 || !may_change(cell)) return;
      sum += volume(cell);
    }
    std::vector<std::uint16_t> labels = part.beside;
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    for (const std::uint16_t m : labels)
      if (m != label_[part.cells[0]]) changes.push_back({part.cells, m, sum, may_vanish});
  }

  /// Parts: the wedges around the edge.
  std::vector<Change> changes_at_edge(const Defect& edge) {
    std::vector<std::int32_t> ring = rings_.around_edge(edge.a, edge.b, edge.cell);
    std::size_t begin = 0;
    while (begin < ring.size() && label_at(ring[begin]) == label_at(ring.back())) ++begin;
    std::rotate(ring.begin(), ring.begin() + std::ptrdiff_t(begin % ring.size()), ring.end());
    std::vector<Part> wedges;
    for (std::size_t i = 0; i < ring.size();) {
      Part wedge;
      const std::uint16_t here = label_at(ring[i]);
      wedge.beside = {label_at(ring[(i + ring.size() - 1) % ring.size()])};
      while (i < ring.size() && label_at(ring[i]) == here) wedge.cells.push_back(ring[i++]);
      wedge.beside.push_back(label_at(ring[i % ring.size()]));
      wedges.push_back(std::move(wedge));
    }
    return changes_of(wedges);
  }

  /// Parts: cells at the vertex that hang together by facets at it.
  std::vector<Change> changes_at_vertex(const Defect& vertex) {
    const std::vector<std::int32_t> star = rings_.around_vertex(vertex.a, vertex.cell);
    std::vector<char> done(star.size());
    std::vector<Part> parts;
    for (std::size_t first = 0; first < star.size(); ++first) {
      if (done[first]) continue;
      done[first] = 1;
      Part part{{star[first]}, {}};
      for (std::size_t next = 0; next < part.cells.size(); ++next)
        for (int k = 0; k < 4; ++k) {
          if (cells_.vertices[part.cells[next]][k] == vertex.a) continue;
          const std::int32_t beyond = cells_.neighbours[part.cells[next]][k];
          if (label_at(beyond) != label_[star[first]]) {
            part.beside.push_back(label_at(beyond));
          } else if (beyond >= 0) {
            const auto i = std::find(star.begin(), star.end(), beyond) - star.begin();
            if (!std::exchange(done[std::size_t(i)], 1)) part.cells.push_back(beyond);
          }
        }
      parts.push_back(std::move(part));
    }
    return changes_of(parts);
  }

  // ---- where to begin

  /// Flat cells that are a component of their own are no body but a rounding error: their circumcentre, far from all
  /// four corners, fell into a material that is not there. They join the neighbour with the largest common facets.
  void fill_pockets() {
    tbb::enumerable_thread_specific<std::vector<std::int32_t>> found;
    tbb::parallel_for(std::int32_t(0), std::int32_t(cells_.vertices.size()), [&](std::int32_t i) {
      if (is_alone(i) && is_flat(i)) found.local().push_back(i);
    });
    std::vector<std::int32_t> pockets;
    for (const auto& some : found) pockets.insert(pockets.end(), some.begin(), some.end());
    std::sort(pockets.begin(), pockets.end());
    for (const std::int32_t pocket : pockets) {
      const std::uint16_t wanted = largest_neighbour(pocket);
      if (!is_alone(pocket) || wanted == label_[pocket] || !may_change(pocket)) continue;
      result_.pockets += try_change({{pocket}, wanted, 0}, 0, 0);
    }
    waiting_.clear();  // all of it is checked afterwards
  }

  std::uint16_t largest_neighbour(std::int32_t cell) const {
    std::array<std::pair<double, std::uint16_t>, 4> areas;  // per facet: area shared with its label so far
    for (int k = 0; k < 4; ++k) {
      const auto [a, b, c] = facet_corners[k];
      const auto& v = cells_.vertices[cell];
      const Vec3d p = points_[v[a]];
      areas[k] = {length(cross(points_[v[b]] - p, points_[v[c]] - p)), label_at(cells_.neighbours[cell][k])};
      for (int j = 0; j < k; ++j)
        if (areas[j].second == areas[k].second) areas[k].first += std::exchange(areas[j].first, 0);
    }
    return std::max_element(areas.begin(), areas.end(),
                            [](const auto& s, const auto& t) {
                              return s.first != t.first ? s.first < t.first : s.second > t.second;
                            })
        ->second;
  }

  bool is_there(std::size_t point) const { return there_.empty() || (point < there_.size() && there_[point]); }

  bool may_change(std::int32_t cell) const {
    return there_.empty() || std::ranges::all_of(cells_.vertices[cell], [&](auto v) { return v < there_.size(); });
  }

  /// Edges and vertices that touch themselves.
  std::vector<Defect> find_defects() {
    const InterfaceFacets facets = interface_facets(cells_, label_);
    std::vector<Defect> defects;
    const EdgeTable edges(facets.triangles, points_.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (edges.uses(e).size() < 4) continue;
      if (!is_there(edges.a(e)) && !is_there(edges.b(e))) continue;
      const Defect defect{edges.a(e), edges.b(e), facets.cell[edges.uses(e)[0] / 3]};
      if (edge_excess(defect) > 0) defects.push_back(defect);
    }
    const VertexTable vertices(facets.triangles, points_.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (!is_there(v)) continue;
      facets_.clear();
      for (const std::uint32_t corner : vertices.corners(v)) {
        const Triangle& t = facets.triangles[corner / 3];
        facets_.push_back({t[int((corner + 1) % 3)], t[int((corner + 2) % 3)], facets.materials[corner / 3]});
      }
      const auto& counts = counter_.vertex_fans(facets_);
      if (std::any_of(counts.begin(), counts.end(), [](const MaterialCount& c) { return c.count > 1; }))
        defects.push_back({std::uint32_t(v), std::uint32_t(v), facets.cell[vertices.corners(v)[0] / 3]});
    }
    return defects;
  }

  std::span<const Vec3d> points_;
  const DelaunayCells& cells_;
  std::vector<std::uint16_t>& label_;
  const std::atomic<bool>* stop_;
  std::span<const std::uint8_t> there_;  // points that are looked at; empty: all
  CellRings rings_;
  VertexFanCounter counter_;
  std::vector<VertexFanCounter::Facet> facets_;
  std::vector<std::int64_t> left_;  // cells per label
  std::deque<Defect> waiting_;
  int tries_ = 0;
  bool crumbs_may_go_ = false;
  LabelRepair result_;
};

}  // namespace

LabelRepair repair_labels(std::span<const Vec3d> points, const DelaunayCells& cells, std::vector<std::uint16_t>& label,
                          const std::atomic<bool>* stop) {
  return Repair(points, cells, label, stop, {}).run();
}

LabelRepair repair_labels_at(std::span<const std::uint8_t> there, std::span<const Vec3d> points,
                             const DelaunayCells& cells, std::vector<std::uint16_t>& label,
                             const std::atomic<bool>* stop) {
  return Repair(points, cells, label, stop, there).run();
}

}  // namespace nacre
