// Nacre: building the brick octree's band against OpenVDB's meshToVolume on the same triangles and band, for run.sh.
//
// peer_openvdb MESH|SAMPLE[:SPLITS] [RESOLUTION=512] [RADIUS=2.24] [THREADS=2] [RUNS=3]
//
// The runs alternate; medians of wall seconds are told. Both make every cell whose centre lies within RADIUS cells of
// the surface. Ours keeps its closest point and triangle, OpenVDB its distance and triangle (the index grid).
#include <oneapi/tbb/global_control.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <cstdio>

#include "compute/device/error.hpp"
#include "compute/device/executor_cpu.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "tests/bench/band_input.hpp"

namespace nacre {
namespace {

/// The surface as OpenVDB wants to see it: points in index coordinates, where cell centres are whole numbers.
struct MeshAdapter {
  const Surface& surface;

  std::size_t polygonCount() const { return surface.triangles.size(); }
  std::size_t pointCount() const { return surface.points.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t t, std::size_t k, openvdb::Vec3d& p) const {
    const Vec3d& q = surface.points[surface.triangles[t][int(k)]];
    p = openvdb::Vec3d(q.x - 0.5, q.y - 0.5, q.z - 0.5);
  }
};

/// Largest difference between our distance and OpenVDB's over every hundredth brick; cells that one of both lacks are
/// counted in `missing`.
double compare(const BrickOctree& tree, const openvdb::FloatGrid& grid, std::int64_t& missing) {
  const std::vector<CellPoint> point = tree.point.download();
  const BrickOctreeView view = tree.view();
  const auto value = grid.getConstAccessor();
  double worst = 0;
  for (std::uint32_t b = 0; b < view.brick_count; b += 100) {
    const Int3 corner = morton_cell(view.brick_code[b]) * Int3(BrickOctreeView::width);
    CellIndex cell = view.brick[b].band.first;
    for (int z = 0; z < 8; ++z)
      for (std::uint64_t rest = view.brick[b].band.word[z]; rest; rest &= rest - 1, ++cell) {
        const int k = __builtin_ctzll(rest);
        float distance = 0;
        if (value.probeValue(openvdb::Coord(corner.x + (k & 7), corner.y + (k >> 3), corner.z + z), distance))
          worst = std::max(worst, std::fabs(double(length(point[cell].offset(tree.quantum))) - double(distance)));
        else
          ++missing;
      }
  }
  return worst;
}

void run(int count, char** words) {
  if (count < 2) throw Error("no mesh", "", "name a file or a sample, such as train");
  const auto word = [&](int k, const char* otherwise) { return std::string(count > k ? words[k] : otherwise); };
  const int resolution = std::stoi(word(2, "512")), threads = std::stoi(word(4, "2")), runs = std::stoi(word(5, "3"));
  const double radius = std::stod(word(3, "2.24"));
  Surface surface = load_surface(words[1]);
  const int levels = fit(surface, resolution, radius);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  openvdb::initialize();

  const auto device = make_cpu_device(threads);
  Executor<Cpu> exec(*device);
  Arena& arena = exec.arena();
  const auto triangles = std::uint32_t(surface.triangles.size());
  const MeshView mesh{arena.permanent_copy<Vec3d>(surface.points).data(),
                      arena.permanent_copy<Triangle>(surface.triangles).data(), nullptr};
  const std::size_t mark = arena.mark();
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  BrickOctree tree;
  openvdb::FloatGrid::Ptr grid;
  std::vector<double> ours, theirs;
  for (int k = 0; k < runs; ++k) {
    arena.rewind(mark);
    ours.push_back(measure([&] { tree = build_brick_octree(exec, mesh, triangles, levels, radius); }).wall);
    grid.reset();
    openvdb::Int32Grid index(openvdb::util::INVALID_IDX);
    theirs.push_back(measure([&] {
                       grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
                           MeshAdapter{surface}, *transform, float(radius), float(radius),
                           openvdb::tools::UNSIGNED_DISTANCE_FIELD, &index);
                     }).wall);
  }
  std::int64_t missing = 0;
  const double worst = compare(tree, *grid, missing);
  std::printf("version OpenVDB %s\n", OPENVDB_LIBRARY_VERSION_STRING);
  std::printf("triangles %u\n", triangles);
  std::printf("our_cells %zu\ntheir_cells %llu\n", std::size_t(tree.cells),
              static_cast<unsigned long long>(grid->activeVoxelCount()));
  std::printf("our_seconds %.5f\ntheir_seconds %.5f\n", median(ours), median(theirs));
  std::printf("distances_differ %.2g\nmissing %lld\n", worst, static_cast<long long>(missing));
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  nacre::run(argc, argv);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "peer_openvdb: %s\n", e.what());
  return 2;
}
