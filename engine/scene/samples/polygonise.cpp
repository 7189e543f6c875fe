// Nacre: the zero set of a function in space as a closed triangle mesh.
#include "engine/scene/samples/polygonise.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/scene/samples/remesh.hpp"
#include "engine/scene/samples/weld.hpp"

namespace nacre {
namespace {

constexpr int block_cells = 8;                // cells of a block along an axis
constexpr int block_nodes = block_cells + 1;  // nodes of a block along an axis
constexpr double fineness = 0.7;        // cell size over edge length: what is finer than the mesh does not fray it
constexpr double steepest = 1.5;        // promised bound on the slope of an implicit function
constexpr double max_blocks = 1 << 24;  // more cannot be meant: just visiting them would take minutes

/// A lattice of cubes, each cut into six tetrahedra about its diagonal. Every edge of these leads from a node to one
/// that lies further by 0 or 1 along each axis, so that (node, 3-bit step) names it.
struct Lattice {
  Vec3d origin;
  double cell;
  Int3 blocks;

  std::uint64_t nodes(int axis) const { return std::uint64_t(blocks[axis]) * block_cells + 1; }
  Vec3d position(const Int3& node) const { return origin + Vec3d(node) * cell; }

  std::uint64_t edge_key(const Int3& node, int step) const {
    return ((std::uint64_t(node.x) * nodes(1) + node.y) * nodes(2) + node.z) * 8 + step;
  }
  std::pair<Int3, Int3> ends(std::uint64_t key) const {
    const int step = int(key % 8);
    const std::uint64_t node = key / 8;
    const Int3 a{std::int32_t(node / (nodes(1) * nodes(2))), std::int32_t(node / nodes(2) % nodes(1)),
                 std::int32_t(node % nodes(2))};
    return {a, a + Int3{step & 1, step >> 1 & 1, step >> 2}};
  }
};

/// The corners of the six tetrahedra as 3-bit steps from the cube's low corner, each with positive volume.
constexpr std::array<std::array<int, 4>, 6> tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// The zero set within one tetrahedron. `inside` has one bit per corner, `key(i, j)` names the edge between corners.
template <class Key>
void march(unsigned inside, Key key, std::vector<KeyedTriangle>& out) {
  std::array<int, 4> order{};  // inside corners first
  int count = 0;
  for (int i = 0; i < 4; ++i)
    if (inside >> i & 1) order[count++] = i;
  int last = count;
  for (int i = 0; i < 4; ++i)
    if (!(inside >> i & 1)) order[last++] = i;

  bool odd = false;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) odd ^= order[i] > order[j];
  if (odd) std::swap(order[count == 1 ? 2 : 0], order[count == 1 ? 3 : 1]);  // two of the same side: keeps the meaning

  const auto [a, b, c, d] = order;
  if (count == 1) out.push_back({key(a, b), key(a, c), key(a, d)});
  if (count == 3) out.push_back({key(d, a), key(d, b), key(d, c)});
  if (count == 2) {
    out.push_back({key(a, c), key(a, d), key(b, d)});
    out.push_back({key(a, c), key(b, d), key(b, c)});
  }
}

/// All triangles in one block, or nothing at once where the function cannot change sign in it.
void march_block(const ImplicitFunction& f, const Lattice& lattice, const Int3& block,
                 std::vector<KeyedTriangle>& out) {
  const Int3 low = block * block_cells;
  const Vec3d centre = lattice.position(low) + Vec3d(0.5 * block_cells * lattice.cell);
  const double half_diagonal = 0.5 * std::sqrt(3.0) * block_cells * lattice.cell;
  if (std::abs(f(centre)) > steepest * half_diagonal) return;

  std::array<bool, block_nodes * block_nodes * block_nodes> inside;
  const auto at = [](int x, int y, int z) { return (x * block_nodes + y) * block_nodes + z; };
  for (int x = 0; x < block_nodes; ++x)
    for (int y = 0; y < block_nodes; ++y)
      for (int z = 0; z < block_nodes; ++z) inside[at(x, y, z)] = f(lattice.position(low + Int3{x, y, z})) < 0;

  for (int x = 0; x < block_cells; ++x) {
    for (int y = 0; y < block_cells; ++y) {
      for (int z = 0; z < block_cells; ++z) {
        unsigned cube = 0;
        for (int c = 0; c < 8; ++c) cube |= unsigned(inside[at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))]) << c;
        if (cube == 0 || cube == 255) continue;
        for (const std::array<int, 4>& corners : tetrahedra) {
          const auto key = [&](int i, int j) {
            const int from = std::min(corners[i], corners[j]), to = std::max(corners[i], corners[j]);
            return lattice.edge_key(low + Int3{x + (from & 1), y + (from >> 1 & 1), z + (from >> 2)}, to & ~from);
          };
          unsigned tetrahedron = 0;
          for (int i = 0; i < 4; ++i) tetrahedron |= (cube >> corners[i] & 1) << i;
          if (tetrahedron != 0 && tetrahedron != 15) march(tetrahedron, key, out);
        }
      }
    }
  }
}

/// The zero of `f` between `a` and `b`, where it differs in sign, by the Illinois variant of false position.
Vec3d zero_between(const ImplicitFunction& f, Vec3d a, Vec3d b) {
  double fa = f(a), fb = f(b);
  const double enough = 1e-10 * length(b - a);
  for (int i = 0; i < 60 && fa != fb; ++i) {
    const Vec3d p = a + (b - a) * (fa / (fa - fb));
    const double fp = f(p);
    if (std::abs(fp) < enough) return p;
    if ((fp < 0) == (fb < 0)) {
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
    }
    b = p;
    fb = fp;
  }
  return b;
}

/// Throws where the zero set crosses an edge on the boundary of the lattice: there it would be left open.
void check_within(const Lattice& lattice, const std::vector<std::uint64_t>& edges) {
  for (const std::uint64_t key : edges) {
    const auto [a, b] = lattice.ends(key);
    for (int axis = 0; axis < 3; ++axis)
      if (a[axis] == b[axis] && (a[axis] == 0 || std::uint64_t(a[axis]) + 1 == lattice.nodes(axis)))
        throw Error("an implicit surface cannot be closed", "it leaves the box that it is sought in",
                    "choose a larger box");
  }
}

Lattice make_lattice(const Vec3d& lower, const Vec3d& upper, double cell) {
  Lattice lattice{lower, cell, {}};
  double total = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double blocks = std::ceil((upper[axis] - lower[axis]) / (cell * block_cells));
    total *= blocks;
    if (!(blocks >= 1) || !(total <= max_blocks))
      throw Error(fmt::format("a box cannot be divided into cells of {:g}", cell), "", "choose a larger cell size");
    lattice.blocks[axis] = int(blocks);
  }
  return lattice;
}

}  // namespace

Vec3d implicit_normal(const ImplicitFunction& f, const Vec3d& p, double scale) {
  const double h = 1e-5 * scale;
  return normalized(Vec3d{f(p + Vec3d{h, 0, 0}) - f(p - Vec3d{h, 0, 0}), f(p + Vec3d{0, h, 0}) - f(p - Vec3d{0, h, 0}),
                          f(p + Vec3d{0, 0, h}) - f(p - Vec3d{0, 0, h})});
}

PolygonMesh polygonise(const ImplicitFunction& f, const Vec3d& lower, const Vec3d& upper, double edge) {
  const Lattice lattice = make_lattice(lower, upper, fineness * edge);
  const Int3 blocks = lattice.blocks;

  // One list per row of blocks, joined in order: the result is the same on any number of threads.
  std::vector<std::vector<KeyedTriangle>> rows(std::size_t(blocks.x) * blocks.y);
  tbb::parallel_for(std::size_t(0), rows.size(), [&](std::size_t row) {
    for (int z = 0; z < blocks.z; ++z)
      march_block(f, lattice, {int(row / blocks.y), int(row % blocks.y), z}, rows[row]);
  });
  std::vector<KeyedTriangle> corners;
  for (std::vector<KeyedTriangle>& row : rows) {
    corners.insert(corners.end(), row.begin(), row.end());
    row = {};
  }
  if (corners.empty()) throw Error("an implicit surface is empty", "its function has one sign in the whole box");

  Welded welded = weld(corners);
  check_within(lattice, welded.keys);
  PolygonMesh mesh;
  mesh.triangles = std::move(welded.triangles);
  mesh.points.resize(welded.keys.size());
  mesh.normals.resize(welded.keys.size());
  tbb::parallel_for(std::size_t(0), welded.keys.size(), [&](std::size_t i) {
    const auto [a, b] = lattice.ends(welded.keys[i]);
    mesh.points[i] = zero_between(f, lattice.position(a), lattice.position(b));
    mesh.normals[i] = implicit_normal(f, mesh.points[i], edge);
  });
  remesh(f, edge, mesh);
  return mesh;
}

}  // namespace nacre
