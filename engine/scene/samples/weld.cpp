// Nacre: triangles whose corners are named by keys become triangles with point indices.
#include "engine/scene/samples/weld.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

namespace nacre {

Welded weld(const std::vector<KeyedTriangle>& corners) {
  Welded welded;
  welded.keys.reserve(corners.size() * 3);
  for (const KeyedTriangle& triangle : corners) welded.keys.insert(welded.keys.end(), triangle.begin(), triangle.end());
  tbb::parallel_sort(welded.keys.begin(), welded.keys.end());
  welded.keys.erase(std::unique(welded.keys.begin(), welded.keys.end()), welded.keys.end());
  welded.keys.shrink_to_fit();

  const auto index = [&](std::uint64_t key) {
    return std::uint32_t(std::lower_bound(welded.keys.begin(), welded.keys.end(), key) - welded.keys.begin());
  };
  welded.triangles.resize(corners.size());
  tbb::parallel_for(std::size_t(0), corners.size(), [&](std::size_t i) {
    welded.triangles[i] = {index(corners[i][0]), index(corners[i][1]), index(corners[i][2])};
  });
  return welded;
}

}  // namespace nacre
