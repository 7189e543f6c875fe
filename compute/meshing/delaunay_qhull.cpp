// Nacre: the Delaunay triangulation of the particles in a build without CGAL: by Qhull, from nothing at each call.
#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/delaunay_order.hpp"

namespace nacre {
namespace {

constexpr double thin = 1e-9;   // six times the volume of a cell that counts as flat, of its longest edge^3
constexpr double flat = 1e-10;  // of the extent: thickness below which points lie in one plane

/// Qhull moves points by up to 1e-10 of their extent or so until nothing is degenerate ("QJ"): every cell is then a
/// tetrahedron, and cells fit together.
char command[] = "qhull d Qbb QJ Pp";

/// The first of the points at each position.
std::vector<std::uint32_t> distinct(std::span<const Vec3d> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::tuple(points[i].x, points[i].y, points[i].z); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t i, std::uint32_t j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
  order.erase(
      std::unique(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) { return key(i) == key(j); }),
      order.end());
  std::sort(order.begin(), order.end());
  return order;
}

void check_thickness(std::span<const Vec3d> points) {
  const auto farthest = [&](const auto& measure) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3d& p, const Vec3d& q) { return measure(p) < measure(q); });
  };
  const Vec3d a = points[0], b = farthest([&](const Vec3d&p) { return length(p - a); });
  const double extent = length(b - a);
  const Vec3d along = normalized(b - a), c = farthest([&](const Vec3d&p) { return length(cross(p - a, along)); });
  const Vec3d normal = normalized(cross(along, c - a));
  const Vec3d d = farthest([&](const Vec3d& p) { return std::abs(dot(p - a, normal)); });
  if (!(std::abs(dot(d - a, normal)) > flat * extent)) refuse_flat_points();
}

/// A run of Qhull, and its memory.
class Hull {
 public:
  explicit Hull(std::vector<coordT>& coordinates) : messages_(std::tmpfile(), &std::fclose) {
    qh_zero(&qh_, messages_.get());
    const int failed = qh_new_qhull(&qh_, 3, int(coordinates.size() / 3), coordinates.data(), False, command, nullptr,
                                    messages_.get());
    if (failed) throw Error("the particles cannot be triangulated", "Qhull says: " + last_message());
  }
  ~Hull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int left = 0, bytes = 0;
    qh_memfreeshort(&qh_, &left, &bytes);
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;

  /// The cells that the lower side of the lifted points' hull shows.
  DelaunayCells cells(const std::vector<std::uint32_t>& number) {
    DelaunayCells cells;
    std::vector<facetT*> facets;
    for (facetT* facet = qh_.facet_list; facet && facet->next; facet = facet->next) {
      facet->visitid = 0;
      if (facet->upperdelaunay) continue;
      facets.push_back(facet);
      facet->visitid = unsigned(facets.size());
    }
    for (facetT* facet : facets) {
      std::array<std::uint32_t, 4>& cell = cells.vertices.emplace_back();
      std::array<std::int32_t, 4>& beyond = cells.neighbours.emplace_back();
      for (int k = 0; k < 4; ++k) {
        const auto* vertex = static_cast<vertexT*>(facet->vertices->e[k].p);
        cell[std::size_t(k)] = number[std::size_t(qh_pointid(&qh_, vertex->point))];
        beyond[std::size_t(k)] = std::int32_t(static_cast<facetT*>(facet->neighbors->e[k].p)->visitid) - 1;
      }
      if (facet->toporient) std::swap(cell[0], cell[1]), std::swap(beyond[0], beyond[1]);
    }
    return cells;
  }

 private:
  std::string last_message() {
    std::rewind(messages_.get());
    char line[200] = "nothing";
    std::string first;
    while (first.empty() && std::fgets(line, sizeof line, messages_.get())) first = line;
    while (!first.empty() && first.back() == '\n') first.pop_back();
    return first;
  }

  qhT qh_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages_;
};

double six_volumes(const std::array<std::uint32_t, 4>& v, std::span<const Vec3d> points) {
  return dot(points[v[1]] - points[v[0]], cross(points[v[2]] - points[v[0]], points[v[3]] - points[v[0]]));
}

/// All cells turned over where they are inside out as Qhull counts.
void turn_outwards(DelaunayCells& cells, std::span<const Vec3d> points) {
  double volume = 0;
  for (const auto& v : cells.vertices) volume += six_volumes(v, points);
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    if (volume < 0) {
      std::swap(cells.vertices[i][0], cells.vertices[i][1]);
      std::swap(cells.neighbours[i][0], cells.neighbours[i][1]);
    }
    order_corners(cells.vertices[i], cells.neighbours[i]);
  }
}

double longest_edge2(const std::array<std::uint32_t, 4>& v, std::span<const Vec3d> points) {
  double longest = 0;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < i; ++k) {
      const Vec3d edge = points[v[std::size_t(i)]] - points[v[std::size_t(k)]];
      longest = std::max(longest, dot(edge, edge));
    }
  return longest;
}

/// Takes away the flat cells of the hull: where points lie in a plane, moving them makes some.
DelaunayCells peel(const DelaunayCells& cells, std::span<const Vec3d> points) {
  const std::size_t count = cells.vertices.size();
  std::vector<std::uint8_t> gone(count, 0);
  std::vector<std::int32_t> outer;
  const auto is_flat = [&](std::int32_t i) {
    const auto& v = cells.vertices[std::size_t(i)];
    const double longest = longest_edge2(v, points);
    return six_volumes(v, points) <= thin * longest * std::sqrt(longest);
  };
  for (std::size_t i = 0; i < count; ++i)
    if (std::count(cells.neighbours[i].begin(), cells.neighbours[i].end(), -1) > 0) outer.push_back(std::int32_t(i));
  while (!outer.empty()) {
    const std::int32_t i = outer.back();
    outer.pop_back();
    if (gone[std::size_t(i)] || !is_flat(i)) continue;
    gone[std::size_t(i)] = 1;
    for (const std::int32_t n : cells.neighbours[std::size_t(i)])
      if (n >= 0) outer.push_back(n);
  }
  std::vector<std::int32_t> number(count, -1);
  DelaunayCells kept;
  for (std::size_t i = 0; i < count; ++i)
    if (!gone[i]) {
      number[i] = std::int32_t(kept.vertices.size());
      kept.vertices.push_back(cells.vertices[i]);
      kept.neighbours.push_back(cells.neighbours[i]);
    }
  for (auto& neighbours : kept.neighbours)
    for (std::int32_t& n : neighbours) n = n < 0 ? -1 : number[std::size_t(n)];
  return kept;
}

}  // namespace

/// Nothing is kept.
struct Delaunay::Held {};

Delaunay::Delaunay(int threads) : threads_(threads) {}
Delaunay::~Delaunay() = default;

DelaunayCells Delaunay::cells(std::span<const Vec3d> points, const std::atomic<bool>* stop) {
  check_delaunay_points(points);
  check_thickness(points);
  const std::vector<std::uint32_t> number = distinct(points);
  if (number.size() == 4) {  // one cell: Qhull asks for five points
    DelaunayCells one;
    one.vertices = {{number[0], number[1], number[2], number[3]}};
    one.neighbours = {{-1, -1, -1, -1}};
    turn_outwards(one, points);
    return in_canonical_order(one, points, stop);
  }
  std::vector<coordT> coordinates;
  for (const std::uint32_t i : number)
    for (int k = 0; k < 3; ++k) coordinates.push_back(points[i][k]);
  check_stop(stop);
  DelaunayCells raw = Hull(coordinates).cells(number);
  turn_outwards(raw, points);
  return in_canonical_order(peel(raw, points), points, stop);
}

}  // namespace nacre
