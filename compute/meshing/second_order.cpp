// Nacre: meshes of second order: a node on each edge, and on the interface where the edge belongs to one.
#include "compute/meshing/second_order.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

constexpr double farthest = 0.3;  ///< that a node goes from the middle of its edge, in lengths of the edge
constexpr int halvings = 5;       ///< of a node's displacement, to find how far it may go
constexpr int most_rounds = 40;

void sort_unique(std::vector<std::uint64_t>& keys) {
  tbb::parallel_sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Edges by number: those of the triangles first.
struct EdgeTable {
  std::vector<std::uint64_t> of_triangles, others;

  std::uint32_t number(std::uint32_t a, std::uint32_t b) const {
    const std::uint64_t key = edge_key(a, b);
    const auto first = std::lower_bound(of_triangles.begin(), of_triangles.end(), key);
    if (first != of_triangles.end() && *first == key) return std::uint32_t(first - of_triangles.begin());
    return std::uint32_t(of_triangles.size() +
                         std::size_t(std::lower_bound(others.begin(), others.end(), key) - others.begin()));
  }
};

EdgeTable edges_of(const SurfaceMesh& surface, const TetrahedralMesh* filled) {
  EdgeTable table;
  table.of_triangles.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) table.of_triangles.push_back(edge_key(t[k], t[(k + 1) % 3]));
  sort_unique(table.of_triangles);
  if (!filled) return table;
  table.others.reserve(6 * filled->cells.size());
  for (const auto& cell : filled->cells)
    for (const auto& [i, j] : cell_edges) table.others.push_back(edge_key(cell[i], cell[j]));
  sort_unique(table.others);
  std::vector<std::uint64_t> inner;
  std::set_difference(table.others.begin(), table.others.end(), table.of_triangles.begin(), table.of_triangles.end(),
                      std::back_inserter(inner));
  table.others = std::move(inner);
  return table;
}

/// Which materials meet at each edge of the triangles: two, three or four; where there are more, none.
std::vector<Junction> junctions_of(const SurfaceMesh& surface, const SecondOrder& second, std::size_t edges) {
  constexpr std::uint16_t free = 0xffff;
  std::vector<std::array<std::uint16_t, 4>> met(edges, {free, free, free, free});
  std::vector<std::uint8_t> crowded(edges);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const std::uint32_t e : second.triangles[t])
      for (const std::uint16_t m : surface.materials[t]) {
        auto& here = met[e];
        const auto at = std::find_if(here.begin(), here.end(), [&](std::uint16_t k) { return k == m || k == free; });
        if (at == here.end())
          crowded[e] = 1;
        else
          *at = m;
      }
  std::vector<Junction> junctions(edges);
  for (std::size_t e = 0; e < edges; ++e) {
    if (crowded[e]) continue;
    std::sort(met[e].begin(), met[e].end());
    junctions[e] = Junction(met[e][0], met[e][1], met[e][2], met[e][3]);
  }
  return junctions;
}

/// Moves nodes back towards the middles of their edges until no element is bent too far. `Element`: how many corners
/// and nodes it has.
template <std::size_t corners, std::size_t sides>
class PullBack {
 public:
  using Corners = std::array<std::uint32_t, corners>;
  using Nodes = std::array<std::uint32_t, sides>;

  /// `displacement`: per node of the triangles' edges, from the middle of the edge to where it is to be.
  PullBack(std::span<const Vec3d> points, std::span<const Vec3d> middles, std::span<const Vec3d> displacement,
           std::span<const Nodes> nodes, std::function<Corners(std::size_t)> corners_of)
      : points_(points),
        middles_(middles),
        displacement_(displacement),
        nodes_(nodes),
        corners_of_(std::move(corners_of)) {
    share_.assign(displacement.size(), 1);
    for (std::size_t k = 0; k < displacement.size(); ++k)
      if (displacement[k] == Vec3d()) share_[k] = 0;
  }

  void run(const std::atomic<bool>* stop) {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
      if (curved(i)) elements_.push_back(i);
    std::vector<double> least(elements_.size());
    for (int round = 0;; ++round) {
      check_stop(stop);
      tbb::parallel_for(std::size_t(0), elements_.size(), [&](std::size_t k) { least[k] = jacobian(elements_[k]); });
      std::vector<std::uint32_t> bad;
      for (std::size_t k = 0; k < elements_.size(); ++k)
        if (least[k] < least_scaled_jacobian && curved(elements_[k])) bad.push_back(elements_[k]);
      if (bad.empty()) break;
      for (const std::uint32_t i : bad) unbend(i, round + 1 == most_rounds);
      if (round + 1 == most_rounds) round = most_rounds - 2;  // from here on elements become straight
    }
    for (const double j : least) least_ = std::min(least_, j);
  }

  const std::vector<double>& share() const { return share_; }
  double least() const { return least_; }
  std::int64_t curved() const {
    return std::count_if(elements_.begin(), elements_.end(), [&](std::uint32_t i) { return curved(i); });
  }

 private:
  bool bends(std::uint32_t node) const { return node < share_.size() && share_[node] > 0; }
  bool curved(std::uint32_t i) const {
    return std::any_of(nodes_[i].begin(), nodes_[i].end(), [&](std::uint32_t n) { return bends(n); });
  }
  Vec3d position(std::uint32_t node) const {
    return bends(node) ? middles_[node] + share_[node] * displacement_[node] : middles_[node];
  }
  double jacobian(std::uint32_t i) const {
    std::array<Vec3d, corners + sides> at;
    const Corners c = corners_of_(i);
    for (std::size_t k = 0; k < corners; ++k) at[k] = points_[c[k]];
    for (std::size_t k = 0; k < sides; ++k) at[corners + k] = position(nodes_[i][k]);
    return scaled_jacobian(at);
  }
  bool good(std::uint32_t i) const { return jacobian(i) >= least_scaled_jacobian; }

  /// Pulls back the one node that helps most, as little as is enough; where one is not enough, all alike.
  void unbend(std::uint32_t i, bool straight) {
    if (good(i)) return;  // by what was done to its neighbours
    std::uint32_t best = none;
    double most = -std::numeric_limits<double>::max();
    for (const std::uint32_t node : nodes_[i]) {
      if (!bends(node)) continue;
      const double before = share_[node];
      share_[node] = 0;
      if (const double j = jacobian(i); j > most) most = j, best = node;
      share_[node] = before;
    }
    if (most >= least_scaled_jacobian)
      shorten({best}, i, straight);
    else
      shorten(nodes_[i], i, straight);
  }

  template <class Some>
  void shorten(const Some& nodes, std::uint32_t i, bool straight) {
    std::vector<std::pair<std::uint32_t, double>> before;
    for (const std::uint32_t node : nodes)
      if (bends(node)) before.emplace_back(node, share_[node]);
    const auto scale = [&](double by) {
      for (const auto& [node, share] : before) share_[node] = share * by;
    };
    double low = 0, high = 1;
    for (int k = 0; k < halvings && !straight; ++k) {
      const double middle = 0.5 * (low + high);
      scale(middle);
      (good(i) ? low : high) = middle;
    }
    scale(low);
  }
  void shorten(std::initializer_list<std::uint32_t> nodes, std::uint32_t i, bool straight) {
    shorten(std::vector<std::uint32_t>(nodes), i, straight);
  }

  std::span<const Vec3d> points_, middles_, displacement_;
  std::span<const Nodes> nodes_;
  std::function<Corners(std::size_t)> corners_of_;
  std::vector<double> share_;            ///< per node of the triangles' edges: of its displacement
  std::vector<std::uint32_t> elements_;  ///< that had a curved edge at first
  double least_ = 1;
};

/// From the middle of each edge of a triangle to its interface.
std::vector<Vec3d> displacements_onto(const SurfaceMesh& surface, SecondOrder& second, std::size_t edges,
                                      const OntoJunctions& onto) {
  const std::vector<Junction> junctions = junctions_of(surface, second, edges);
  const std::span<const Vec3d> middles = std::span(second.nodes).first(edges);
  const std::vector<Vec3d> target = onto(middles, junctions);
  std::vector<Vec3d> displacement(edges);
  for (std::size_t k = 0; k < edges; ++k) {
    const auto [a, b] = second.edges[k];
    const Vec3d step = target[k] - middles[k];
    const int order = junctions[k] == Junction() ? 0 : junctions[k].order();
    if (order == 0 || !is_finite(step) || length(step) > farthest * length(surface.points[b] - surface.points[a])) {
      ++second.left_straight;
      continue;
    }
    displacement[k] = step;
    ++(order == 2 ? second.on_surfaces : second.on_curves);
  }
  return displacement;
}

template <class Elements>
void bend(SecondOrder& second, std::span<const Vec3d> displacement, Elements&& elements,
          const std::atomic<bool>* stop) {
  elements.run(stop);
  second.least_jacobian = elements.least();
  second.curved_elements = elements.curved();
  for (std::size_t k = 0; k < displacement.size(); ++k) {
    if (displacement[k] == Vec3d()) continue;
    const double share = elements.share()[k];
    second.pulled_back += share < 1;
    second.straightened += share == 0;
  }
  for (std::size_t k = 0; k < displacement.size(); ++k) second.nodes[k] += elements.share()[k] * displacement[k];
}

}  // namespace

double scaled_jacobian(const std::array<Vec3d, 10>& node) {
  // Bezier control points of the edges; then column k of the Jacobian is linear in the barycentric coordinates, with
  // the coefficients 2 (b_kj - b_0j).
  std::array<std::array<Vec3d, 4>, 4> b;
  for (std::size_t k = 0; k < 4; ++k) b[k][k] = node[k];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = cell_edges[e];
    b[i][j] = b[j][i] = 2.0 * node[4 + e] - 0.5 * (node[i] + node[j]);
  }
  std::array<std::array<Vec3d, 4>, 3> column;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 4; ++j) column[k][j] = b[k + 1][j] - b[0][j];
  // The determinant is a cubic; each coefficient is the mean over the orders of its three indices.
  double sum[4][4][4] = {};
  int count[4][4][4] = {};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3d normal = cross(column[0][i], column[1][j]);
      for (std::size_t k = 0; k < 4; ++k) {
        std::array<std::size_t, 3> at{i, j, k};
        std::sort(at.begin(), at.end());
        sum[at[0]][at[1]][at[2]] += dot(normal, column[2][k]);
        ++count[at[0]][at[1]][at[2]];
      }
    }
  const double straight = dot(node[1] - node[0], cross(node[2] - node[0], node[3] - node[0]));
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j)
      for (int k = j; k < 4; ++k) least = std::min(least, 8 * sum[i][j][k] / count[i][j][k]);
  return straight > 0 ? least / straight : -std::numeric_limits<double>::infinity();
}

double scaled_jacobian(const std::array<Vec3d, 6>& node) {
  std::array<std::array<Vec3d, 3>, 3> b;
  for (std::size_t k = 0; k < 3; ++k) b[k][k] = node[k];
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t i = e, j = (e + 1) % 3;
    b[i][j] = b[j][i] = 2.0 * node[3 + e] - 0.5 * (node[i] + node[j]);
  }
  const Vec3d flat = cross(node[1] - node[0], node[2] - node[0]);
  double sum[3][3] = {};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum[std::min(i, j)][std::max(i, j)] += dot(flat, cross(b[1][i] - b[0][i], b[2][j] - b[0][j]));
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) least = std::min(least, 4 * sum[i][j] / (i == j ? 1 : 2));
  const double square = dot(flat, flat);
  return square > 0 ? least / square : -std::numeric_limits<double>::infinity();
}

Vec3d point_of_triangle(const std::array<Vec3d, 6>& node, const std::array<double, 3>& at) {
  Vec3d point;
  for (std::size_t k = 0; k < 3; ++k)
    point += at[k] * (2 * at[k] - 1) * node[k] + 4 * at[k] * at[(k + 1) % 3] * node[3 + k];
  return point;
}

std::array<Vec3d, 6> nodes_of_triangle(const SurfaceMesh& surface, const SecondOrder& second, std::size_t t) {
  const Triangle& c = surface.triangles[t];
  const auto& n = second.triangles[t];
  return {surface.points[c.a], surface.points[c.b], surface.points[c.c],
          second.nodes[n[0]],  second.nodes[n[1]],  second.nodes[n[2]]};
}

std::vector<double> enclosed_volumes(const SurfaceMesh& surface, const SecondOrder& second, int materials) {
  // A third of the flux of x; x (x_u times x_v) is of degree 4, for which the six points are exact (Dunavant 1985).
  constexpr double near = 0.445948490915965, far = 0.091576213509771;
  constexpr double near_weight = 0.223381589678011 / 2, far_weight = 0.109951743655322 / 2;
  std::vector<double> volumes(static_cast<std::size_t>(materials));
  const Vec3d origin = surface.points.empty() ? Vec3d() : surface.points[0];
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<Vec3d, 6> node = nodes_of_triangle(surface, second, t);
    for (Vec3d& p : node) p -= origin;
    double flux = 0;
    for (int q = 0; q < 6; ++q) {
      const double one = q < 3 ? near : far;
      std::array<double, 3> at{one, one, one};
      at[std::size_t(q % 3)] = 1 - 2 * one;
      Vec3d along[3];  // derivatives by each coordinate
      for (std::size_t k = 0; k < 3; ++k) {
        along[k] +=
            (4 * at[k] - 1) * node[k] + 4 * at[(k + 1) % 3] * node[3 + k] + 4 * at[(k + 2) % 3] * node[3 + (k + 2) % 3];
      }
      flux += (q < 3 ? near_weight : far_weight) *
              dot(point_of_triangle(node, at), cross(along[1] - along[0], along[2] - along[0]));
    }
    volumes[surface.materials[t][1]] += flux / 3;
    volumes[surface.materials[t][0]] -= flux / 3;
  }
  volumes[0] = 0;
  return volumes;
}

SecondOrder second_order(const SurfaceMesh& surface, const TetrahedralMesh* filled, const OntoJunctions& onto,
                         const std::atomic<bool>* stop) {
  const std::vector<Vec3d>& points = filled ? filled->points : surface.points;
  const EdgeTable table = edges_of(surface, filled);
  check_stop(stop);
  SecondOrder second;
  const std::size_t on_triangles = table.of_triangles.size();
  for (const std::vector<std::uint64_t>* keys : {&table.of_triangles, &table.others})
    for (const std::uint64_t key : *keys) {
      const auto a = std::uint32_t(key >> 32), b = std::uint32_t(key);
      second.edges.push_back({a, b});
      second.nodes.push_back(0.5 * (points[a] + points[b]));
    }
  second.triangles.resize(surface.triangles.size());
  tbb::parallel_for(std::size_t(0), surface.triangles.size(), [&](std::size_t i) {
    const Triangle& t = surface.triangles[i];
    for (int k = 0; k < 3; ++k) second.triangles[i][std::size_t(k)] = table.number(t[k], t[(k + 1) % 3]);
  });
  if (filled) second.cells.resize(filled->cells.size());
  tbb::parallel_for(std::size_t(0), second.cells.size(), [&](std::size_t i) {
    const auto& c = filled->cells[i];
    for (std::size_t e = 0; e < 6; ++e) second.cells[i][e] = table.number(c[cell_edges[e][0]], c[cell_edges[e][1]]);
  });
  const std::vector<Vec3d> displacement = displacements_onto(surface, second, on_triangles, onto);
  if (filled)
    bend(second, displacement,
         PullBack<4, 6>(points, second.nodes, displacement, second.cells,
                        [&](std::size_t i) { return filled->cells[i]; }),
         stop);
  else
    bend(second, displacement,
         PullBack<3, 3>(points, second.nodes, displacement, second.triangles,
                        [&](std::size_t i) {
                          const Triangle& t = surface.triangles[i];
                          return std::array<std::uint32_t, 3>{t.a, t.b, t.c};
                        }),
         stop);
  return second;
}

}  // namespace nacre
