// Nacre: how far the mesh of each material is from the boundary of its voxels.
#include "compute/pipeline/voxel_distance.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/pipeline/volume_frame.hpp"
#include "compute/raycast/triangle_tree.hpp"

namespace nacre {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A mean over an area and the largest value.
struct Spread {
  double sum = 0, area = 0, most = 0;

  void add(double distance, double weight) {
    sum += distance * weight;
    area += weight;
    most = std::max(most, distance);
  }
  void add(const Spread& other) {
    sum += other.sum;
    area += other.area;
    most = std::max(most, other.most);
  }
  double mean() const { return area > 0 ? sum / area : 0; }
};

/// The voxels of a volume in coordinates that are parallel to its axes, with the length of the world: voxel (i, j, k)
/// is the box around (i, j, k) * spacing.
class Voxels {
 public:
  explicit Voxels(const MeshVolume& volume) : volume_(volume), dims_(volume.dims), spacing_(volume.spacing) {
    for (int axis = 0; axis < 3; ++axis)
      for (int i = -1; i <= dims_[axis]; ++i) centres_[std::size_t(axis)].push_back(i * spacing_[axis]);
  }

  Vec3d local(const Vec3d& world) const {
    const Vec3d index = world_to_index(world, volume_.origin, spacing_, volume_.axes);
    return {index.x * spacing_.x, index.y * spacing_.y, index.z * spacing_.z};
  }

  std::uint16_t at(const Int3& v) const {
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < 0 || v[axis] >= dims_[axis]) return 0;
    return volume_.material[std::size_t(v.x) + std::size_t(dims_.x) * (v.y + std::size_t(dims_.y) * v.z)];
  }

  /// Calls visit(voxel, axis) for each voxel of layer `k` beyond which, along the axis, is another material, the layer
  /// before the first among them.
  template <class Visit>
  void each_face(int k, const Visit& visit) const {
    Row here, ahead, above;  // the row itself, the next along y, and the next along z
    read_row(-1, k, here);
    for (int j = -1; j < dims_.y; ++j, here.swap(ahead)) {
      read_row(j + 1, k, ahead);
      read_row(j, k + 1, above);
      if (are_alike(here) && here == ahead && here == above) continue;
      for (int i = -1; i < dims_.x; ++i) {
        const std::size_t at = std::size_t(i + 1);
        if (here[at] != here[at + 1]) visit(Int3(i, j, k), 0);
        if (here[at] != ahead[at]) visit(Int3(i, j, k), 1);
        if (here[at] != above[at]) visit(Int3(i, j, k), 2);
      }
    }
    const auto layer = std::size_t(dims_.x) * std::size_t(dims_.y), first = std::size_t(std::max(k, 0)) * layer;
    volume_.material.let_go(first, std::min(first + layer, volume_.material.size()));
  }

  Vec3d centre_of_face(const Int3& v, int axis) const {
    Vec3d c(v.x * spacing_.x, v.y * spacing_.y, v.z * spacing_.z);
    c[axis] += 0.5 * spacing_[axis];
    return c;
  }
  double area_of_face(int axis) const { return spacing_[(axis + 1) % 3] * spacing_[(axis + 2) % 3]; }
  double longest_edge() const { return std::max({spacing_.x, spacing_.y, spacing_.z}); }

  /// From `p` to the nearest face of a voxel of this material, which there must be. Where it is not among the eight
  /// voxels around `p`, they are searched shell by shell.
  double distance_to_faces(const Vec3d& p, std::uint16_t material) const {
    double best = infinite;  // squared
    if (search_block(p, material, best)) return std::sqrt(best);
    Int3 middle;
    for (int axis = 0; axis < 3; ++axis)
      middle[axis] = int(std::clamp(std::floor(p[axis] / spacing_[axis] + 0.5), 0.0, double(dims_[axis] - 1)));
    for (int r = 0;; ++r) {
      search_shell(p, material, middle, r, best);
      const double known = nearest_beyond(p, middle, r);
      if (known == infinite || (known > 0 && best <= known * known)) return std::sqrt(best);
    }
  }

 private:
  /// Materials along x, with one of outside before and behind.
  using Row = std::vector<std::uint16_t>;

  void read_row(int j, int k, Row& row) const {
    row.assign(std::size_t(dims_.x) + 2, 0);
    if (j < 0 || k < 0 || j >= dims_.y || k >= dims_.z) return;
    const std::size_t first = (std::size_t(k) * std::size_t(dims_.y) + std::size_t(j)) * std::size_t(dims_.x);
    volume_.material.read(first, std::size_t(dims_.x), row.data() + 1);
  }
  static bool are_alike(const Row& row) { return std::equal(row.begin() + 1, row.end(), row.begin()); }

  /// Along an axis, of a voxel or one beside the volume. From a table: products that are added to something else in two
  /// places may be rounded in two ways.
  double centre(int axis, int index) const { return centres_[std::size_t(axis)][std::size_t(index + 1)]; }

  /// How near anything beyond the shell of this radius can be: infinite where there are no voxels.
  double nearest_beyond(const Vec3d& p, const Int3& middle, int r) const {
    double nearest = infinite;
    for (int axis = 0; axis < 3; ++axis) {
      const double s = spacing_[axis];
      if (middle[axis] - r > 0) nearest = std::min(nearest, p[axis] - (middle[axis] - r - 0.5) * s);
      if (middle[axis] + r + 1 < dims_[axis]) nearest = std::min(nearest, (middle[axis] + r + 0.5) * s - p[axis]);
    }
    return nearest;
  }

  /// Of the faces between the eight voxels whose centres are around `p`. Whether no other can be nearer.
  bool search_block(const Vec3d& p, std::uint16_t material, double& best) const {
    Int3 low;
    Vec3d to_wall[2], off[2];  // between the lower and the upper voxels, as each of both has it
    double known = infinite;   // how near anything beyond the block can be
    for (int axis = 0; axis < 3; ++axis) {
      const double s = spacing_[axis];
      low[axis] = int(std::clamp(std::floor(p[axis] / s), -1.0, double(dims_[axis] - 1)));
      to_wall[0][axis] = centre(axis, low[axis]) + 0.5 * s - p[axis];
      to_wall[1][axis] = centre(axis, low[axis] + 1) - 0.5 * s - p[axis];
      off[0][axis] = std::min(to_wall[0][axis], 0.0);
      off[1][axis] = std::max(to_wall[1][axis], 0.0);
      known = std::min(known, s - std::abs(to_wall[0][axis]));
    }
    if (known <= 0) return false;  // far from all voxels
    const unsigned own = own_in_block(low, material);
    for (unsigned v = 0; v < 8; ++v)
      for (int axis = 0; axis < 3; ++axis) {
        Vec3d to_face(off[v & 1].x, off[v >> 1 & 1].y, off[v >> 2].z);
        to_face[axis] = to_wall[v >> axis & 1][axis];
        const bool is_face = own >> v & ~(own >> (v ^ 1u << axis)) & 1;
        best = std::min(best, is_face ? dot(to_face, to_face) : infinite);
      }
    return best < known * known * (1 - 1e-9);
  }

  /// A bit for each of eight voxels from `low` on, x fastest: whether it is of this material.
  unsigned own_in_block(const Int3& low, std::uint16_t material) const {
    unsigned own = 0;
    for (unsigned v = 0; v < 8; ++v) own |= unsigned(at(low + Int3(v & 1, v >> 1 & 1, v >> 2)) == material) << v;
    return own;
  }

  void search_shell(const Vec3d& p, std::uint16_t material, const Int3& middle, int r, double& best) const {
    const Int3 low = max(middle - Int3(r, r, r), Int3(0, 0, 0));
    const Int3 high = min(middle + Int3(r, r, r), dims_ - Int3(1, 1, 1));
    for (int k = low.z; k <= high.z; ++k)
      for (int j = low.y; j <= high.y; ++j) {
        const bool whole = std::abs(k - middle.z) == r || std::abs(j - middle.y) == r;
        const int step = whole ? 1 : std::max(1, 2 * r);
        for (int i = whole ? low.x : middle.x - r; i <= high.x; i += step)
          if (i >= 0 && at({i, j, k}) == material) search_voxel(p, material, {i, j, k}, best);
      }
  }

  void search_voxel(const Vec3d& p, std::uint16_t material, const Int3& v, double& best) const {
    const Vec3d middle(centre(0, v.x), centre(1, v.y), centre(2, v.z)), half = spacing_ * 0.5;
    const Vec3d within = min(max(p, middle - half), middle + half), off = within - p;
    if (dot(off, off) >= best) return;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        Int3 beside = v;
        beside[axis] += side;
        if (at(beside) == material) continue;
        Vec3d to_face = off;
        to_face[axis] = middle[axis] + side * half[axis] - p[axis];
        best = std::min(best, dot(to_face, to_face));
      }
  }

  const MeshVolume& volume_;
  Int3 dims_;
  Vec3d spacing_;
  std::array<std::vector<double>, 3> centres_;  // along each axis, and one more at each end
};

/// What bounds one material, of the mesh.
struct Boundary {
  std::vector<std::uint32_t> triangles, points;
};

std::vector<Boundary> boundaries_of(const SurfaceMesh& mesh, std::size_t materials) {
  std::vector<Boundary> all(materials);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint16_t m : mesh.materials[t])
      if (m > 0) all[m].triangles.push_back(std::uint32_t(t));
  std::vector<std::uint16_t> last(mesh.points.size(), 0);  // material that has counted a point
  for (std::size_t m = 1; m < materials; ++m)
    for (const std::uint32_t t : all[m].triangles)
      for (int k = 0; k < 3; ++k)
        if (const std::uint32_t v = mesh.triangles[t][k]; std::exchange(last[v], std::uint16_t(m)) != m)
          all[m].points.push_back(v);
  return all;
}

/// Points in the coordinates of Voxels.
std::shared_ptr<const TriangleSoup> soup_of(const SurfaceMesh& mesh, const Voxels& voxels) {
  auto soup = std::make_shared<TriangleSoup>(TriangleSoup{std::vector<Vec3d>(mesh.points.size()), mesh.triangles});
  tbb::parallel_for(std::size_t(0), mesh.points.size(),
                    [&](std::size_t i) { soup->points[i] = voxels.local(mesh.points[i]); });
  return soup;
}

/// Triangles that were nearest to faces of one layer. Faces come row by row: the last ones of a column and of that
/// before it are beside the next one.
class LastNearest {
 public:
  explicit LastNearest(int columns) : last_(std::size_t(columns)) {}

  /// One of the material, none where there is nothing near.
  std::optional<std::uint32_t> near(int column, std::uint16_t material) const {
    for (int i = column; i >= std::max(column - 1, 0); --i)
      for (const Found& found : last_[std::size_t(i)])
        if (found.material == material) return found.triangle;
    return std::nullopt;
  }
  void keep(int column, std::size_t side, std::uint16_t material, std::uint32_t triangle) {
    last_[std::size_t(column)][side] = {material, triangle};
  }

 private:
  struct Found {
    std::uint16_t material = 0;
    std::uint32_t triangle = 0;
  };
  std::vector<std::array<Found, 2>> last_;
};

/// From the faces of all voxels to the triangles, per material. Where the nearest triangle of all bounds a material, it
/// is the nearest one of this, too; else those that do are searched nearby, and where there is none, after all others,
/// in a tree of their own.
class FromFaces {
 public:
  FromFaces(const SurfaceMesh& mesh, const Voxels& voxels, const std::vector<Boundary>& boundaries,
            std::shared_ptr<const TriangleSoup> soup)
      : mesh_(mesh), voxels_(voxels), boundaries_(boundaries), soup_(std::move(soup)) {
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    tree_ = TriangleTree::of_some(soup_, std::move(all));
  }

  std::vector<Spread> spread(const Int3& dims, const std::atomic<bool>* stop) const {
    std::vector<Layer> layers(std::size_t(dims.z) + 1);
    tbb::parallel_for(0, dims.z + 1, [&](int n) {
      if (stop && *stop) return;
      layers[std::size_t(n)] = layer(n - 1, dims.x);
    });
    check_stop(stop);
    add_far_ones(layers, stop);
    check_stop(stop);
    std::vector<Spread> sum(boundaries_.size());
    for (const Layer& layer : layers)
      for (const auto& [m, of] : layer.spread) sum[m].add(of);
    return sum;
  }

 private:
  static constexpr double nearby = 4;  ///< edges of a voxel, beyond the nearest triangle of all

  struct FarFace {
    Vec3d centre;
    std::uint16_t material;
    double area;
  };
  struct Layer {
    std::map<std::uint16_t, Spread> spread;
    std::vector<FarFace> far;  // from the triangles of their material
  };

  bool bounds(std::uint32_t triangle, std::uint16_t m) const {
    return mesh_.materials[triangle][0] == m || mesh_.materials[triangle][1] == m;
  }

  Layer layer(int k, int columns) const {
    Layer result;
    LastNearest last(columns + 1);
    voxels_.each_face(k, [&](const Int3& v, int axis) {
      Int3 next = v;
      ++next[axis];
      const Vec3d centre = voxels_.centre_of_face(v, axis);
      const double area = voxels_.area_of_face(axis);
      const std::array<std::uint16_t, 2> sides{voxels_.at(v), voxels_.at(next)};
      const std::array guess{last.near(v.x + 1, sides[0]), last.near(v.x + 1, sides[1])};
      const std::optional<TriangleHit> nearest = tree_.closest(centre, guess[0] ? guess[0] : guess[1]);
      for (std::size_t side = 0; side < 2; ++side) {
        const std::uint16_t m = sides[side];
        if (m == 0 || !nearest) continue;
        std::optional<TriangleHit> hit = nearest;
        if (!bounds(nearest->triangle, m))
          hit = tree_.closest_of(
              centre, nearest->distance + nearby * voxels_.longest_edge(),
              [&](std::uint32_t t) { return bounds(t, m); }, guess[side]);
        if (!hit) {
          if (!boundaries_[m].triangles.empty()) result.far.push_back({centre, m, area});
          continue;
        }
        last.keep(v.x + 1, side, m, hit->triangle);
        result.spread[m].add(hit->distance, area);
      }
    });
    return result;
  }

  void add_far_ones(std::vector<Layer>& layers, const std::atomic<bool>* stop) const {
    std::map<std::uint16_t, TriangleTree> own;
    for (const Layer& layer : layers)
      for (const FarFace& f : layer.far) own.try_emplace(f.material);
    for (auto& [m, tree] : own) tree = TriangleTree::of_some(soup_, boundaries_[m].triangles);
    tbb::parallel_for(std::size_t(0), layers.size(), [&](std::size_t n) {
      if (stop && *stop) return;
      for (const FarFace& f : layers[n].far)
        layers[n].spread[f.material].add(own.at(f.material).closest(f.centre)->distance, f.area);
    });
  }

  const SurfaceMesh& mesh_;
  const Voxels& voxels_;
  const std::vector<Boundary>& boundaries_;
  std::shared_ptr<const TriangleSoup> soup_;
  TriangleTree tree_;  ///< of all triangles
};

/// From those of a boundary's triangles and points that come [begin, end) to the faces of the voxels of its material.
Spread from_triangles(const Voxels& voxels, const TriangleSoup& soup, const Boundary& boundary, std::uint16_t material,
                      double voxel, std::size_t begin, std::size_t end) {
  constexpr int most_parts = 64;  // of an edge
  Spread spread;
  const std::vector<Vec3d>& points = soup.points;
  for (std::size_t n = begin; n < std::min(end, boundary.points.size()); ++n)
    spread.most = std::max(spread.most, voxels.distance_to_faces(points[boundary.points[n]], material));
  for (std::size_t n = begin; n < std::min(end, boundary.triangles.size()); ++n) {
    const Triangle& c = soup.triangles[boundary.triangles[n]];
    const Vec3d a = points[c.a], u = points[c.b] - a, w = points[c.c] - a;
    const double longest = std::max({length(u), length(w), length(u - w)});
    const int parts = std::clamp(int(std::ceil(longest / voxel - 1e-9)), 1, most_parts);
    const double area = 0.5 * length(cross(u, w)) / (parts * parts);
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < 2 * (parts - i) - 1; ++j) {  // parts^2 small triangles, every second one upside down
        const double third = j % 2 ? 2 / 3.0 : 1 / 3.0;
        const int pair = j / 2;
        const Vec3d middle = a + u * ((i + third) / parts) + w * ((pair + third) / parts);
        spread.add(voxels.distance_to_faces(middle, material), area);
      }
  }
  return spread;
}

}  // namespace

std::vector<VoxelDistance> voxel_distances(const SurfaceMesh& mesh, const MeshVolume& volume,
                                           const std::atomic<bool>* stop) {
  const std::size_t materials = std::size_t(volume.materials());
  std::vector<VoxelDistance> result(materials);
  const Voxels voxels(volume);
  const double voxel_volume = volume.spacing.x * volume.spacing.y * volume.spacing.z;
  const std::vector<std::int64_t> count = volume.material.counts(volume.materials());
  const std::vector<Boundary> boundaries = boundaries_of(mesh, materials);
  const std::shared_ptr<const TriangleSoup> soup = soup_of(mesh, voxels);
  check_stop(stop);
  const std::vector<Spread> faces = FromFaces(mesh, voxels, boundaries, soup).spread(volume.dims, stop);

  struct Part {
    std::uint16_t material;
    std::size_t begin;
  };
  constexpr std::size_t part_size = 4096;
  std::vector<Part> parts;
  for (std::size_t m = 1; m < materials; ++m) {
    result[m].voxel_volume = double(count[m]) * voxel_volume;
    result[m].measured = count[m] > 0 && !boundaries[m].triangles.empty();
    if (!result[m].measured) continue;
    for (std::size_t t = 0; t < std::max(boundaries[m].triangles.size(), boundaries[m].points.size()); t += part_size)
      parts.push_back({std::uint16_t(m), t});
  }
  std::vector<Spread> spread(parts.size());
  const double voxel = std::min({volume.spacing.x, volume.spacing.y, volume.spacing.z});
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    if (stop && *stop) return;
    const Part& part = parts[i];
    spread[i] = from_triangles(voxels, *soup, boundaries[part.material], part.material, voxel, part.begin,
                               part.begin + part_size);
    if (i % 8 == 0) volume.material.let_go(0, volume.material.size());  // of a mapped file: what was looked at piles up
  });
  check_stop(stop);
  std::vector<Spread> triangles(materials);
  for (std::size_t i = 0; i < parts.size(); ++i) triangles[parts[i].material].add(spread[i]);
  for (std::size_t m = 1; m < materials; ++m) {
    if (!result[m].measured) continue;
    result[m].mesh_mean = triangles[m].mean(), result[m].mesh_max = triangles[m].most;
    result[m].faces_mean = faces[m].mean(), result[m].faces_max = faces[m].most;
  }
  return result;
}

}  // namespace nacre
