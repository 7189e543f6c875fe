// Nacre: how far a mesh is from the interfaces that it stands for.
#include "compute/pipeline/mesh_distance.hpp"

#include <algorithm>

namespace nacre {

DistanceSamples distance_samples(const SurfaceMesh& mesh) {
  constexpr std::size_t no_facet = ~std::size_t(0);
  DistanceSamples samples;
  const auto add = [&](const Vec3d& point, std::size_t facet) {
    samples.points.push_back(point);
    samples.interfaces.emplace_back(mesh.materials[facet][0], mesh.materials[facet][1]);
  };
  std::vector<std::size_t> facet(mesh.points.size(), no_facet);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) facet[mesh.triangles[t][k]] = t;
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (facet[v] != no_facet) add(mesh.points[v], facet[v]);
  samples.vertices = samples.points.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    add((mesh.points[c.a] + mesh.points[c.b] + mesh.points[c.c]) / 3.0, t);
  }
  return samples;
}

SurfaceDistance summarise_distances(const DistanceSamples& samples, std::span<const float> distance) {
  const auto measure = [](std::span<const float> of, double& mean, double& largest) {
    std::size_t n = 0;
    for (const float d : of) {
      if (d < 0) continue;
      mean += d;
      largest = std::max(largest, double(d));
      ++n;
    }
    mean /= double(std::max<std::size_t>(n, 1));
  };
  SurfaceDistance result;
  measure(distance.first(samples.vertices), result.vertex_mean, result.vertex_max);
  measure(distance.subspan(samples.vertices), result.facet_mean, result.facet_max);
  return result;
}

}  // namespace nacre
