// Nacre: closest points of real meshes with defects, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compute/device/executor_cpu.hpp"
#include "engine/io/reader.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "tests/compute/embedding/check_closest_points.hpp"
#include "tests/paths.hpp"

namespace nacre::test {
namespace {

namespace fs = std::filesystem;

/// The surface as the numerics get it, in cells: `resolution` along its longest side, its box `margin` off the grid's.
Mesh in_cells(const PreparedSurface& surface, int resolution, double margin, Int3& bricks) {
  Vec3d low{1e300, 1e300, 1e300}, high = -low;
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      low = min(low, surface.points[t[k]]);
      high = max(high, surface.points[t[k]]);
    }
  const Vec3d size = high - low;
  const double scale = resolution / std::max({size.x, size.y, size.z});
  for (int axis = 0; axis < 3; ++axis) bricks[axis] = int((size[axis] * scale + 2 * margin) / 4) + 1;
  Mesh mesh;
  mesh.triangles = surface.triangles;
  for (const Vec3d& p : surface.points) mesh.points.push_back((p - low) * scale + Vec3d(margin));
  return mesh;
}

/// Compares about `samples` stored cells. False where the file holds no surface.
bool check_file(const fs::path& path, int resolution, std::uint32_t samples) {
  PreparedSurface surface;
  try {
    surface = prepare(open_surface({path}).load(0));
  } catch (const Error&) {
    return false;
  }
  Int3 bricks;
  const Mesh mesh = in_cells(surface, resolution, 7.37, bricks);
  const auto device = make_cpu_device(0, true);
  Executor<Cpu> exec(*device);
  const MeshView view = upload(exec, mesh);
  const HostGrid grid(build_closest_point_grid(exec, view, std::uint32_t(mesh.triangles.size()), bricks, 4, band));
  const BruteForce brute(mesh.points, mesh.triangles);
  GridFaults faults;
  const auto cells = std::uint32_t(grid.offset.size());
  for (std::uint32_t at = 0; at < cells; at += std::max(1u, cells / samples))
    if (grid.offset[at].w <= band) check_stored(grid, brute, at, faults);
  Random random(61);  // and positions anywhere in the box: what is near the surface must be stored
  for (std::uint32_t k = 0; k < samples / 4; ++k) {
    const Vec3d at(grid.view.dims());
    const Int3 cell{int(at.x * random()), int(at.y * random()), int(at.z * random())};
    const std::uint32_t address = grid.view.address(cell);
    if (address != none && grid.offset[address].w <= band) continue;
    faults.missing += brute(Vec3d(cell) + Vec3d(0.5), band - 1e-5).triangle != none;
  }
  faults.expect_none(path.filename().string());
  return true;
}

TEST(DefectMeshes, ClosestPointsEqualBruteForce) {
  NACRE_NEEDS_SHARED_DATA("meshes");
  const fs::path folder = shared_data("meshes");
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.file_size() < 3'000'000) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::size_t checked = 0;
  for (const fs::path& file : files) checked += check_file(file, 64, 200);
  std::printf("%zu of %zu files hold a surface\n", checked, files.size());
  EXPECT_GT(checked, 40u);
}

}  // namespace
}  // namespace nacre::test
