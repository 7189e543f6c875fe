// Nacre: which triangles meet at each edge and at each vertex of a mesh.
#include "compute/meshing/incidence.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

void check_count(std::span<const Triangle> triangles) {
  if (triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3)
    throw Error("the mesh cannot be examined", "it has more than 1.4 billion triangles", "choose a larger `min_size`");
}

/// The ends of a use, smaller first.
std::pair<std::uint32_t, std::uint32_t> ends(const Triangle& t, int k) {
  return std::minmax<std::uint32_t>({t[k], t[(k + 1) % 3]});
}

struct Use {
  std::uint32_t b, use;
  friend bool operator<(const Use& s, const Use& t) { return s.b != t.b ? s.b < t.b : s.use < t.use; }
};

}  // namespace

std::vector<std::uint8_t> mark_corners(std::span<const Triangle> triangles, std::size_t points) {
  std::vector<std::uint8_t> marks(points, 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 1 << 12), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      for (int k = 0; k < 3; ++k) std::atomic_ref(marks[triangles[i][k]]).store(1, std::memory_order_relaxed);
  });
  return marks;
}

EdgeTable::EdgeTable(std::span<const Triangle> triangles, std::size_t points) {
  check_count(triangles);
  std::vector<std::size_t> begin(points + 1);
  const auto for_uses = [&](const auto& visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (const auto [a, b] = ends(triangles[t], k); a != b) visit(a, b, std::uint32_t(3 * t + std::size_t(k)));
  };
  for_uses([&](std::uint32_t a, std::uint32_t, std::uint32_t) { ++begin[a + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Use> all(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for_uses([&](std::uint32_t a, std::uint32_t b, std::uint32_t use) { all[next[a]++] = {b, use}; });
  tbb::parallel_for(std::size_t(0), points, [&](std::size_t p) {
    std::sort(all.begin() + std::ptrdiff_t(begin[p]), all.begin() + std::ptrdiff_t(begin[p + 1]));
  });
  uses_.resize(all.size());
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i) {
      if (i == begin[p] || all[i].b != all[i - 1].b) {
        a_.push_back(std::uint32_t(p));
        b_.push_back(all[i].b);
        first_.push_back(i);
      }
      uses_[i] = all[i].use;
    }
  first_.push_back(all.size());
}

VertexTable::VertexTable(std::span<const Triangle> triangles, std::size_t points) : first_(points + 1) {
  check_count(triangles);
  // Each thread looks at all triangles, for vertices of its own.
  const std::size_t parts =
      std::clamp<std::size_t>(triangles.size() >> 16, 1, std::size_t(tbb::this_task_arena::max_concurrency()));
  const auto for_corners = [&](const auto& visit) {
    tbb::parallel_for(std::size_t(0), parts, [&](std::size_t part) {
      const std::size_t begin = points * part / parts, end = points * (part + 1) / parts;
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
          if (const std::size_t v = triangles[t][k]; v >= begin && v < end)
            visit(v, std::uint32_t(3 * t + std::size_t(k)));
    });
  };
  for_corners([&](std::size_t v, std::uint32_t) { ++first_[v + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  corners_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_corners([&](std::size_t v, std::uint32_t corner) { corners_[next[v]++] = corner; });
}

}  // namespace nacre
