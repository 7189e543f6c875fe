// Nacre: surface nets, a quick mesh of the interfaces between labelled voxels.
#include "compute/meshing/surface_nets.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr float farthest = 0.49f;  ///< of a vertex from the middle of its cell, in voxels: two never lie in one place

/// The voxels that count. Cell (i, j, k) lies between voxels (i-1, j-1, k-1) and (i, j, k).
class Lattice {
 public:
  Lattice(const MaterialVoxels& voxels, int stride) : voxels_(voxels), stride_(stride) {
    for (int a = 0; a < 3; ++a) dims[a] = (voxels.dims[a] + stride - 1) / stride;
  }

  Int3 dims{};

  std::uint16_t at(int x, int y, int z) const {
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < dims.x && y < dims.y && z < dims.z;
    return inside ? voxels_.material[first_of(y, z) + std::size_t(x) * stride_] : std::uint16_t(0);
  }

  /// The materials of a row of voxels, with one more of the outside at either end.
  void copy_row(int y, int z, std::vector<std::uint16_t>& row) const {
    row.assign(std::size_t(dims.x) + 2, 0);
    if (y < 0 || z < 0 || y >= dims.y || z >= dims.z) return;
    const std::uint16_t* from = voxels_.material.data() + first_of(y, z);
    for (int x = 0; x < dims.x; ++x) row[std::size_t(x) + 1] = from[std::size_t(x) * stride_];
  }

 private:
  std::size_t first_of(int y, int z) const {
    return (std::size_t(z) * stride_ * voxels_.dims.y + std::size_t(y) * stride_) * voxels_.dims.x;
  }

  const MaterialVoxels& voxels_;
  std::size_t stride_;
};

/// The cells that an interface passes through, row by row.
struct Cells {
  Int3 dims{};                       ///< of all cells: one more than voxels along each axis
  std::vector<std::uint32_t> first;  ///< per row (j + k * dims.y), and the end
  std::vector<std::uint32_t> x;      ///< per cell, ascending in its row

  std::size_t row(int j, int k) const { return std::size_t(j) + std::size_t(k) * std::size_t(dims.y); }
  std::uint32_t find(std::uint32_t i, int j, int k) const {
    if (j < 0 || k < 0 || j >= dims.y || k >= dims.z) return none;
    const std::size_t r = row(j, k);
    const auto begin = x.begin() + first[r], end = x.begin() + first[r + 1];
    const auto found = std::lower_bound(begin, end, i);
    return found != end && *found == i ? std::uint32_t(found - x.begin()) : none;
  }
};

/// Calls work(k) for every layer of cells.
template <class Work>
void for_layers(int layers, const std::atomic<bool>* stop, const Work& work) {
  tbb::parallel_for(0, layers, [&](int k) {
    if (is_set(stop)) return;
    work(k);
  });
  check_stop(stop);
}

Cells find_cells(const Lattice& lattice, const std::atomic<bool>* stop) {
  Cells cells;
  cells.dims = Int3(lattice.dims.x + 1, lattice.dims.y + 1, lattice.dims.z + 1);
  const std::size_t rows = std::size_t(cells.dims.y) * std::size_t(cells.dims.z);
  std::vector<std::vector<std::uint32_t>> layer_x(std::size_t(cells.dims.z));
  cells.first.assign(rows + 1, 0);
  for_layers(cells.dims.z, stop, [&](int k) {
    std::array<std::vector<std::uint16_t>, 4> row;  // of voxels: (j-1, k-1), (j-1, k), (j, k-1), (j, k)
    std::vector<std::uint8_t> alike(std::size_t(cells.dims.x) + 1);
    std::vector<std::uint32_t>& found = layer_x[std::size_t(k)];
    lattice.copy_row(-1, k - 1, row[2]);
    lattice.copy_row(-1, k, row[3]);
    for (int j = 0; j < cells.dims.y; ++j) {
      std::swap(row[0], row[2]);
      std::swap(row[1], row[3]);
      lattice.copy_row(j, k - 1, row[2]);
      lattice.copy_row(j, k, row[3]);
      const std::uint16_t *a = row[0].data(), *b = row[1].data(), *c = row[2].data(), *d = row[3].data();
      for (std::size_t x = 0; x < alike.size(); ++x) alike[x] = (a[x] == b[x]) & (a[x] == c[x]) & (a[x] == d[x]);
      const std::size_t before = found.size();
      for (std::uint32_t i = 0; i < std::uint32_t(cells.dims.x); ++i)
        if (!(alike[i] & alike[i + 1] & std::uint8_t(a[i] == a[i + 1]))) found.push_back(i);
      cells.first[cells.row(j, k) + 1] = std::uint32_t(found.size() - before);
    }
  });
  std::size_t total = 0;
  for (const auto& found : layer_x) total += found.size();
  if (total >= none) throw Error("surface nets of more than 4 billion cells", "", "take a larger stride");
  for (std::size_t r = 0; r < rows; ++r) cells.first[r + 1] += cells.first[r];
  cells.x.resize(total);
  for_layers(cells.dims.z, stop, [&](int k) {
    const auto& found = layer_x[std::size_t(k)];
    std::copy(found.begin(), found.end(), cells.x.begin() + cells.first[cells.row(0, k)]);
  });
  return cells;
}

/// How many different ones there are among some materials, counted up to 3.
int kinds(const std::uint16_t* material, int count) {
  int found = 1;
  std::uint16_t second = 0;
  for (int n = 1; n < count; ++n) {
    if (material[n] == material[0]) continue;
    if (found == 1)
      second = material[n], found = 2;
    else if (material[n] != second)
      return 3;
  }
  return found;
}

/// The neighbours that a vertex is pulled to: those whose common face an interface crosses; at a junction, those whose
/// common face three materials meet at, if there are two of them.
std::array<std::uint32_t, 6> links_of(const Lattice& lattice, const Cells& cells, std::uint32_t i, int j, int k) {
  std::array<std::uint16_t, 8> corner;
  for (int n = 0; n < 8; ++n)
    corner[std::size_t(n)] = lattice.at(int(i) - 1 + (n & 1), j - 1 + (n >> 1 & 1), k - 1 + (n >> 2));
  std::array<std::uint32_t, 6> links;
  std::array<int, 6> meet{};
  const bool junction = kinds(corner.data(), 8) == 3;
  int at_junction = 0;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, far = side % 2;
    std::array<std::uint16_t, 4> face;
    for (int n = 0, m = 0; n < 8; ++n)
      if ((n >> axis & 1) == far) face[std::size_t(m++)] = corner[std::size_t(n)];
    meet[std::size_t(side)] = kinds(face.data(), 4);
    at_junction += meet[std::size_t(side)] == 3;
  }
  const int least = junction && at_junction >= 2 ? 3 : 2;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, by = side % 2 ? 1 : -1;
    links[std::size_t(side)] =
        meet[std::size_t(side)] >= least
            ? cells.find(i + std::uint32_t(axis == 0 ? by : 0), j + (axis == 1 ? by : 0), k + (axis == 2 ? by : 0))
            : none;
  }
  return links;
}

/// Calls work(cell, i, j, k) for every cell.
template <class Work>
void for_cells(const Cells& cells, const std::atomic<bool>* stop, const Work& work) {
  for_layers(cells.dims.z, stop, [&](int k) {
    for (int j = 0; j < cells.dims.y; ++j)
      for (std::uint32_t c = cells.first[cells.row(j, k)]; c < cells.first[cells.row(j, k) + 1]; ++c)
        work(c, cells.x[c], j, k);
  });
}

/// Vertices in steps of the lattice, from voxel (0, 0, 0)'s centre.
std::vector<Vec3f> place_vertices(const Lattice& lattice, const Cells& cells, const SurfaceNetsOptions& options) {
  std::vector<Vec3f> position(cells.x.size());
  for_cells(cells, options.stop, [&](std::uint32_t c, std::uint32_t i, int j, int k) {
    position[c] = Vec3f(float(i) - 0.5f, float(j) - 0.5f, float(k) - 0.5f);
  });
  if (options.smoothing <= 0) return position;
  std::vector<std::array<std::uint32_t, 6>> links(position.size());
  for_cells(cells, options.stop,
            [&](std::uint32_t c, std::uint32_t i, int j, int k) { links[c] = links_of(lattice, cells, i, j, k); });
  std::vector<Vec3f> next(position.size());
  for (int sweep = 0; sweep < options.smoothing; ++sweep) {
    for_cells(cells, options.stop, [&](std::uint32_t c, std::uint32_t i, int j, int k) {
      Vec3f sum(0.0f);
      int count = 0;
      for (const std::uint32_t other : links[c])
        if (other != none) sum = sum + position[other], ++count;
      const Vec3f middle(float(i) - 0.5f, float(j) - 0.5f, float(k) - 0.5f);
      Vec3f to = count > 0 ? sum / float(count) : position[c];
      for (int a = 0; a < 3; ++a) to[a] = std::clamp(to[a], middle[a] - farthest, middle[a] + farthest);
      next[c] = to;
    });
    position.swap(next);
  }
  return position;
}

/// Of a layer of cells.
struct Facets {
  std::vector<Triangle> triangles;
  std::vector<std::array<std::uint16_t, 2>> materials;

  /// Between two voxels, corners counter-clockwise seen from the side of `near`; cut along the shorter diagonal.
  void add(std::array<std::uint32_t, 4> c, std::uint16_t near, std::uint16_t far, const std::vector<Vec3f>& position) {
    if (far < near) std::swap(c[1], c[3]);
    const std::array pair{std::min(near, far), std::max(near, far)};
    const auto span = [&](int a, int b) {
      const Vec3f d = position[c[std::size_t(a)]] - position[c[std::size_t(b)]];
      return dot(d, d);
    };
    if (span(1, 3) < span(0, 2)) c = {c[1], c[2], c[3], c[0]};
    triangles.push_back({c[0], c[1], c[2]});
    triangles.push_back({c[0], c[2], c[3]});
    materials.insert(materials.end(), 2, pair);
  }
};

/// The quads between voxel (i, j, k) and the one before it along each axis.
void add_facets(const Lattice& lattice, const Cells& cells, const std::vector<Vec3f>& position, bool mirrored,
                std::array<int, 3> at, Facets& facets) {
  const std::uint16_t here = lattice.at(at[0], at[1], at[2]);
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<int, 3> before = at;
    --before[a];
    const std::uint16_t there = lattice.at(before[0], before[1], before[2]);
    if (here == there) continue;
    std::array<std::uint32_t, 4> corner;
    constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t n = 0; n < 4; ++n) {
      std::array<int, 3> cell = at;
      cell[(a + 1) % 3] += around[n][0];
      cell[(a + 2) % 3] += around[n][1];
      corner[n] = cells.find(std::uint32_t(cell[0]), cell[1], cell[2]);
    }
    if (mirrored) std::swap(corner[1], corner[3]);
    facets.add(corner, here, there, position);
  }
}

void collect(std::vector<Facets>& layers, SurfaceMesh& mesh, const std::atomic<bool>* stop) {
  std::vector<std::size_t> first(layers.size() + 1, 0);
  for (std::size_t k = 0; k < layers.size(); ++k) first[k + 1] = first[k] + layers[k].triangles.size();
  mesh.triangles.resize(first.back());
  mesh.materials.resize(first.back());
  for_layers(int(layers.size()), stop, [&](int k) {
    const std::size_t n = std::size_t(k);
    std::copy(layers[n].triangles.begin(), layers[n].triangles.end(),
              mesh.triangles.begin() + std::ptrdiff_t(first[n]));
    std::copy(layers[n].materials.begin(), layers[n].materials.end(),
              mesh.materials.begin() + std::ptrdiff_t(first[n]));
    layers[n] = {};
  });
}

}  // namespace

SurfaceMesh surface_nets(const MaterialVoxels& voxels, const SurfaceNetsOptions& options) {
  const int stride = std::max(1, options.stride);
  const Lattice lattice(voxels, stride);
  const Cells cells = find_cells(lattice, options.stop);
  const std::vector<Vec3f> position = place_vertices(lattice, cells, options);
  const bool mirrored = dot(cross(voxels.steps[0], voxels.steps[1]), voxels.steps[2]) < 0;
  std::vector<Facets> layers(std::size_t(cells.dims.z));
  for_cells(cells, options.stop, [&](std::uint32_t, std::uint32_t i, int j, int k) {
    add_facets(lattice, cells, position, mirrored, {int(i), j, k}, layers[std::size_t(k)]);
  });
  SurfaceMesh mesh;
  collect(layers, mesh, options.stop);
  mesh.points.resize(position.size());
  tbb::parallel_for(std::size_t(0), position.size(), [&](std::size_t c) {
    const Vec3d p = Vec3d(position[c]) * double(stride);
    mesh.points[c] = voxels.origin + voxels.steps[0] * p.x + voxels.steps[1] * p.y + voxels.steps[2] * p.z;
  });
  return mesh;
}

int surface_nets_stride(const Int3& dims, std::size_t most) {
  int stride = 1;
  const auto left = [&] {
    std::size_t voxels = 1;
    for (int a = 0; a < 3; ++a) voxels *= std::size_t((dims[a] + stride - 1) / stride);
    return voxels;
  };
  while (left() > most) ++stride;
  return stride;
}

}  // namespace nacre
