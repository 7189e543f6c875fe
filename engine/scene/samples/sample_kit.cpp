// Nacre: what a built-in sample consists of, and small pieces that several samples share.
#include "engine/scene/samples/sample_kit.hpp"

#include "engine/scene/samples/weld.hpp"

namespace nacre {

Vec3d sum_of(const std::vector<Eddy>& eddies, const Vec3d& point, const Vec3d& normal) {
  Vec3d sum;
  for (const Eddy& eddy : eddies) sum += eddy(point, normal);
  return sum;
}

LatticeBox lattice_box(int nx, int ny, int nz) {
  const Int3 cells{nx, ny, nz};
  const auto key = [&](const Int3& p) {
    return (std::uint64_t(p.x) * (cells.y + 1) + p.y) * std::uint64_t(cells.z + 1) + p.z;
  };
  std::vector<KeyedTriangle> corners;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < cells[u]; ++i) {
      for (int j = 0; j < cells[v]; ++j) {
        for (const bool high : {false, true}) {
          const auto corner = [&](int du, int dv) {
            Int3 p;
            p[axis] = high ? cells[axis] : 0;
            p[u] = i + du;
            p[v] = j + dv;
            return key(p);
          };
          const std::uint64_t a = corner(0, 0), b = high ? corner(1, 0) : corner(0, 1), c = corner(1, 1),
                              d = high ? corner(0, 1) : corner(1, 0);
          const bool from_a = (2 * i + 1 < cells[u]) == (2 * j + 1 < cells[v]);
          corners.push_back({a, b, from_a ? c : d});
          corners.push_back({from_a ? a : b, c, d});
        }
      }
    }
  }
  Welded welded = weld(corners);
  LatticeBox box{{}, std::move(welded.triangles)};
  box.points.reserve(welded.keys.size());
  for (const std::uint64_t k : welded.keys)
    box.points.push_back({std::int32_t(k / (std::uint64_t(cells.z + 1) * (cells.y + 1))),
                          std::int32_t(k / (cells.z + 1) % (cells.y + 1)), std::int32_t(k % (cells.z + 1))});
  return box;
}

}  // namespace nacre
