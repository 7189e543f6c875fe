// Nacre: what the Delaunay triangulations of CGAL and of Qhull share: the points they take, and the order of cells.
#include "compute/meshing/delaunay_order.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/meshing/circumcentre.hpp"

namespace nacre {
namespace {

using Cell = std::array<std::uint32_t, 4>;

/// Order of the cells by their sorted vertices: counted into buckets by the smallest, then sorted there.
std::vector<std::int32_t> canonical_order(const std::vector<Cell>& vertices, std::size_t points) {
  std::vector<std::uint32_t> begin(points + 1);
  for (const Cell& cell : vertices) ++begin[cell[0] + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::int32_t> order(vertices.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < vertices.size(); ++i) order[next[vertices[i][0]]++] = std::int32_t(i);
  const auto before = [&](std::int32_t i, std::int32_t j) {
    const Cell &a = vertices[i], &b = vertices[j];
    if (a[1] != b[1]) return a[1] < b[1];
    const auto [a2, a3] = std::minmax(a[2], a[3]);
    const auto [b2, b3] = std::minmax(b[2], b[3]);
    return a2 != b2 ? a2 < b2 : a3 < b3;
  };
  tbb::parallel_for(std::size_t(0), points,
                    [&](std::size_t p) { std::sort(order.begin() + begin[p], order.begin() + begin[p + 1], before); });
  return order;
}

}  // namespace

void check_delaunay_points(std::span<const Vec3d> points) {
  const std::string what = "the particles cannot be triangulated";
  if (points.size() >= std::size_t(std::numeric_limits<std::int32_t>::max()) / 8)
    throw Error(what, "there are more than 268 million", "choose a larger `min_size`");
  if (points.size() < 4)
    throw Error(what, "there are fewer than four", "choose a smaller `max_size`, or more `particles`");
  for (const Vec3d& p : points)
    if (!is_finite(p)) throw Error(what, "one of them is not at a finite position");
}

void refuse_flat_points() {
  throw Error("the particles cannot be triangulated", "they all lie in one plane",
              "check that the volume holds a body with a thickness");
}

void order_corners(Cell& cell, std::array<std::int32_t, 4>& neighbours) {
  const auto exchange = [&](int i, int j) {
    std::swap(cell[i], cell[j]);
    std::swap(neighbours[i], neighbours[j]);
  };
  bool odd = false;
  for (int end = 3; end > 0; --end)
    for (int i = 0; i < end; ++i)
      if (cell[i] > cell[i + 1]) {
        exchange(i, i + 1);
        odd = !odd;
      }
  if (odd) exchange(2, 3);
}

DelaunayCells in_canonical_order(const DelaunayCells& raw, std::span<const Vec3d> points,
                                 const std::atomic<bool>* stop) {
  check_stop(stop);
  const std::size_t count = raw.vertices.size();
  const std::vector<std::int32_t> order = canonical_order(raw.vertices, points.size());
  check_stop(stop);
  std::vector<std::int32_t> rank(count);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) { rank[order[i]] = std::int32_t(i); });
  DelaunayCells cells;
  cells.vertices.resize(count);
  cells.neighbours.resize(count);
  cells.circumcentres.resize(count);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    const Cell& v = cells.vertices[i] = raw.vertices[order[i]];
    for (int k = 0; k < 4; ++k) {
      const std::int32_t neighbour = raw.neighbours[order[i]][k];
      cells.neighbours[i][k] = neighbour < 0 ? -1 : rank[neighbour];
    }
    cells.circumcentres[i] = circumcentre(points[v[0]], points[v[1]], points[v[2]], points[v[3]]);
  });
  return cells;
}

}  // namespace nacre
