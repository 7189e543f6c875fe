// Nacre: what the programs that time the closest-point band share: meshes by name, in cells, and medians of seconds.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "compute/embedding/brick_octree.hpp"
#include "engine/io/reader.hpp"
#include "engine/scene/samples/samples.hpp"

namespace nacre {

struct Seconds {
  double wall = 0, processor = 0;
};

template <class Work>
Seconds measure(const Work& work) {
  auto processor = [] {
    rusage u{};
    getrusage(RUSAGE_SELF, &u);
    return double(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * double(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
  };
  const double before = processor();
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), processor() - before};
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Cuts every triangle into four at the middles of its edges.
inline Surface split(const Surface& s) {
  Surface out;
  for (const Triangle& t : s.triangles) {
    const auto n = std::uint32_t(out.points.size());
    const Vec3d a = s.points[t.a], b = s.points[t.b], c = s.points[t.c];
    out.points.insert(out.points.end(), {a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5});
    for (const Triangle& k : {Triangle{0, 3, 5}, Triangle{3, 1, 4}, Triangle{5, 4, 2}, Triangle{3, 4, 5}})
      out.triangles.push_back({n + k.a, n + k.b, n + k.c});
  }
  return out;
}

/// FILE|SAMPLE[:SPLITS]: a file that the program reads or a built-in flow sample, each triangle cut into four SPLITS
/// times.
inline Surface load_surface(const std::string& word) {
  const std::size_t colon = word.rfind(':');
  const std::string name = word.substr(0, colon);
  Surface s = std::filesystem::exists(name) ? open_surface({name}).load(0) : make_sample(name).load(0);
  for (int k = colon == std::string::npos ? 0 : std::stoi(word.substr(colon + 1)); k > 0; --k) s = split(s);
  return s;
}

/// Moves the surface into cells of a domain with room for the band; returns how many levels of the octree that takes.
inline int fit(Surface& s, int resolution, double radius) {
  Vec3d low(1e300), high(-1e300);
  for (const Vec3d& p : s.points) low = min(low, p), high = max(high, p);
  const Vec3d size = high - low;
  const double cell = std::max({size.x, size.y, size.z}) / resolution, margin = std::ceil(radius) + 2.37;
  for (Vec3d& p : s.points) p = (p - low) / cell + Vec3d(margin);
  int levels = 0;
  while ((BrickOctreeView::width << levels) < resolution + 2 * margin) ++levels;
  return levels;
}

}  // namespace nacre
