// Nacre: test body for local contrast: the moments around each block, gathered by a team, against a plain computation.
#pragma once

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "compute/flow/filter.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"

namespace nacre::test {

struct NoteCellsOfTexture {
  RefinedGridView texture;
  Int3* positions;
  NACRE_HD void operator()(std::int64_t s) const { positions[s] = texture.cell(std::uint32_t(s)); }
};

struct NoteCellsOfBlocks {
  RefinedGridView texture;
  Int3* positions;
  NACRE_HD void operator()(std::int64_t b) const { positions[b] = texture.grid.cell(texture.block_cell[b]); }
};

/// Number, sum and sum of squares of values by closest-point cell; nothing where none is named.
class PlainMoments {
 public:
  double* at(const Int3& c) { return moments_[{c.x, c.y, c.z}].m; }

  /// Through (1 2 1)^3, for the cells named.
  PlainMoments blurred(const std::vector<Int3>& cells) {
    PlainMoments result;
    for (const Int3& c : cells)
      each([&](int x, int y, int z) {
        const double weight = double((x ? 1 : 2) * (y ? 1 : 2) * (z ? 1 : 2));
        for (int k = 0; k < 3; ++k) result.at(c)[k] += weight * at(c + Int3(x, y, z))[k];
      });
    return result;
  }

  /// Linear between the middles of cells.
  double linear(const Vec3d& p, int k) {
    const Int3 low{int(std::floor(p.x - 0.5)), int(std::floor(p.y - 0.5)), int(std::floor(p.z - 0.5))};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Int3 c = low + Int3(corner & 1, corner >> 1 & 1, corner >> 2);
      const Vec3d d = Vec3d(c) + Vec3d(0.5) - p;
      sum += (1 - std::fabs(d.x)) * (1 - std::fabs(d.y)) * (1 - std::fabs(d.z)) * at(c)[k];
    }
    return sum;
  }

 private:
  struct Three {
    double m[3] = {};
  };
  template <class Body>
  static void each(const Body& body) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) body(x, y, z);
  }
  std::map<std::tuple<int, int, int>, Three> moments_;
};

template <class Backend>
void LocalContrastIsThatOfTheCellsAround(Executor<Backend>& exec) {
  Arena& arena = exec.arena();
  for (const int refine : {1, 3, 4}) {
    SCOPED_TRACE(refine);
    const std::size_t mark = arena.mark();
    Arena::Scope scope(arena);
    const Mesh ball = sphere({15.3, 16.1, 15.7}, 6.2, 12);
    const MeshView mesh = upload(exec, ball);
    const ClosestPointGrid coarse =
        build_closest_point_grid(exec, mesh, std::uint32_t(ball.triangles.size()), Int3(8), 4, 4.47f);
    const RefinedGrid fine = build_refined_grid(exec, mesh, std::uint32_t(ball.triangles.size()), coarse, refine);
    const RefinedGridView texture = fine.view(coarse.view());
    const std::size_t n = fine.surface_cells, blocks = fine.block_cell.size();

    const Array<Int3> positions = arena.permanent<Int3>(n), of_blocks = arena.permanent<Int3>(blocks);
    exec.for_each(n, NoteCellsOfTexture{texture, positions.data()});
    exec.for_each(blocks, NoteCellsOfBlocks{texture, of_blocks.data()});
    const std::vector<Int3> position = positions.download();
    std::vector<float> values(n);
    for (std::size_t s = 0; s < n; ++s)  // darker and plainer to one side
      values[s] = uniform_random(5, std::uint32_t(s), 0) * (0.2f + 0.02f * float(position[s].x) / float(refine));
    const Array<float> value = arena.permanent_copy<float>(values), detail = arena.permanent<float>(n);
    const Array<Float4> raw = arena.permanent<Float4>(coarse.cells);
    Array<Float4> wide = arena.permanent<Float4>(coarse.cells);
    wide.fill_bytes(0);
    const TextureSpread* whole = measure_spread(exec, std::int64_t(n), value.data());
    exec.for_each(coarse.cells, LocalMoments{texture, value.data(), raw.data()});
    exec.for_each(blocks, BlurMoments{texture, raw.data(), wide.data()});
    constexpr float local = 0.8f;
    exec.for_each_team(blocks, Equalise{texture, value.data(), wide.data(), whole, local, detail.data()});
    const std::vector<float> found = detail.download();

    PlainMoments own;
    double sum = 0, squares = 0;
    for (std::size_t s = 0; s < n; ++s) {
      double* m = own.at({position[s].x / refine, position[s].y / refine, position[s].z / refine});
      m[0] += 1, m[1] += values[s], m[2] += double(values[s]) * values[s];
      sum += values[s], squares += double(values[s]) * values[s];
    }
    PlainMoments around = own.blurred(of_blocks.download());
    const double mean = sum / double(n), deviation = std::sqrt(squares / double(n) - mean * mean);
    double most = 0;
    for (std::size_t s = 0; s < n; ++s) {
      const Vec3d p = (Vec3d(position[s]) + Vec3d(0.5)) / double(refine);
      const double count = around.linear(p, 0), m = around.linear(p, 1) / count, q = around.linear(p, 2) / count;
      const double d = std::max(std::sqrt(std::max(0.0, q - m * m)), 0.25 * deviation);
      const double expected = (values[s] - (mean + local * (m - mean))) / (deviation + local * (d - deviation));
      most = std::max(most, std::fabs(found[s] - expected));
    }
    EXPECT_GT(n, 500u);
    EXPECT_LT(most, 2e-3);
    arena.rewind(mark);
  }
}

NACRE_DEVICE_TEST(Contrast, LocalContrastIsThatOfTheCellsAround)

}  // namespace nacre::test
