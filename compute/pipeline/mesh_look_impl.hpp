// Nacre: the part of the mesh pipeline that lets others look: particles and boxes for a renderer, fields at points.
#pragma once

#include <algorithm>

#include "compute/particles/bins.hpp"
#include "compute/pipeline/mesh_kernels.hpp"
#include "compute/pipeline/mesh_pipeline_impl.hpp"

namespace nacre {

template <class Backend>
Array<Vec3f> MeshPipelineOf<Backend>::upload_points(std::span<const Vec3d> points) {
  std::vector<Vec3f> host(points.size());
  const float far = 1e6f;
  std::transform(points.begin(), points.end(), host.begin(), [&](const Vec3d& w) {
    const Vec3f p(frame_.to_voxels(w));
    return is_finite(p) ? max(min(p, Vec3f(far)), Vec3f(-far)) : Vec3f(-far);
  });
  Array<Vec3f> array = exec_.arena().template temporary<Vec3f>(host.size());
  array.upload(host);
  return array;
}

template <class Backend>
std::vector<std::uint16_t> MeshPipelineOf<Backend>::material_at(std::span<const Vec3d> points) {
  require_fields();
  Arena::Scope scope(exec_.arena());
  const Array<Vec3f> place = upload_points(points);
  Array<std::uint16_t> material = exec_.arena().template temporary<std::uint16_t>(points.size());
  exec_.for_each(std::int64_t(points.size()), detail::MaterialAt{bricks_.view(), place.data(), material.data()});
  return material.download();
}

template <class Backend>
std::vector<float> MeshPipelineOf<Backend>::field_at(MeshField field, std::span<const Vec3d> points) {
  require_fields();
  Arena::Scope scope(exec_.arena());
  const Array<Vec3f> place = upload_points(points);
  Array<float> value = exec_.arena().template temporary<float>(points.size());
  if (field == MeshField::material) {
    exec_.for_each(std::int64_t(points.size()), detail::PictureMaterialAt{bricks_.view(), place.data(), value.data()});
    return value.download();
  }
  if (field == MeshField::distance)
    exec_.for_each(std::int64_t(points.size()),
                   detail::DistanceAt{bricks_.view(), distance_.view(), place.data(), value.data()});
  else
    exec_.for_each(std::int64_t(points.size()),
                   detail::SizeAt{bricks_.view(), size_.view(), place.data(), value.data()});
  std::vector<float> result = value.download();
  for (float& x : result) x *= float(frame_.unit);
  return result;
}

template <class Backend>
VoxelFrame MeshPipelineOf<Backend>::voxel_frame() const {
  VoxelFrame frame{frame_.to_world(Vec3d(0, 0, 0)), frame_.axes};
  for (Vec3d& axis : frame.axes) axis *= frame_.unit;
  return frame;
}

template <class Backend>
ShownCounts MeshPipelineOf<Backend>::show_particles(const ShownParticles& memory) {
  if (!solver_) return {};
  auto stage = exec_.stage("show");
  const ParticleSet& set = solver_->particles();
  Arena::Scope scope(exec_.arena());
  Array<std::uint64_t> before = exec_.arena().template temporary<std::uint64_t>(std::size_t(set.count));
  exec_.for_each(set.count, detail::CountLowerOrders{order_.data(), set.interface.data(), before.data()});
  const std::uint64_t lower = exec_.exclusive_scan(before.data(), before.data(), set.count);
  ShownCounts counts;
  counts.points = std::int64_t(lower >> 32);
  counts.curves = std::int64_t(lower & 0xffffffff);
  counts.surfaces = set.count - counts.points - counts.curves;
  if (set.count <= memory.capacity)
    exec_.for_each(set.count,
                   detail::ShowParticle{order_.data(), set.interface.data(), set.place.data(), set.direction.data(),
                                        before.data(), counts.points, counts.curves, memory.place, memory.direction});
  return counts;
}

template <class Backend>
std::int64_t MeshPipelineOf<Backend>::show_boxes(ShownBox* memory, std::int64_t capacity) {
  if (!solver_ || solver_->particles().count == 0) return 0;
  auto stage = exec_.stage("show");
  const std::int64_t nodes = solver_->tree().bounded_nodes();
  Arena::Scope scope(exec_.arena());
  if (nodes == 0) {
    if (parameters.solver == "tree") return 0;
    const Bins bins = build_bins(exec_, solver_->particles(), SolverParameters().step);
    const std::int64_t occupied = bins.colour.back();
    if (occupied <= capacity) exec_.for_each(occupied, detail::BinBox{bins.grid, bins.occupied.data(), memory});
    return occupied;
  }
  Array<std::uint32_t> number = exec_.arena().template temporary<std::uint32_t>(std::size_t(nodes));
  const TreeNode* node = solver_->view(0).node;
  exec_.for_each(nodes, detail::CountFullNodes{node, number.data()});
  const std::int64_t full = exec_.exclusive_scan(number.data(), number.data(), nodes);
  if (full <= capacity) exec_.for_each(nodes, detail::NodeBox{node, number.data(), memory});
  return full;
}

template <class Backend>
MeshParticles MeshPipelineOf<Backend>::particles() const {
  MeshParticles result;
  if (!solver_) return result;
  const ParticleSet& set = solver_->particles();
  const std::size_t n = std::size_t(set.count);
  const std::vector<Float4> place = set.place.download(0, n), direction = set.direction.download(0, n);
  const std::vector<std::uint32_t> interface = set.interface.download(0, n);
  for (std::size_t i = 0; i < n; ++i) {
    const Junction j = junctions_[interface[i]];
    result.points.push_back(frame_.to_world(Vec3d(place[i].x, place[i].y, place[i].z)));
    result.size.push_back(place[i].w * float(frame_.unit));
    result.energy.push_back(direction[i].w);
    result.normal.push_back(frame_.direction_to_world({direction[i].x, direction[i].y, direction[i].z}));
    result.order.push_back(std::uint8_t(j.order()));
    result.materials.push_back(j.all());
  }
  return result;
}

template <class Backend>
SurfaceDistance MeshPipelineOf<Backend>::surface_distance(const SurfaceMesh& mesh) {
  auto stage = exec_.stage("quality");
  std::vector<Vec3d> points;
  std::vector<Junction> junctions;
  std::vector<std::uint32_t> facet(mesh.points.size(), none);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) facet[mesh.triangles[t][k]] = std::uint32_t(t);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (facet[v] == none) continue;
    points.push_back(mesh.points[v]);
    junctions.emplace_back(mesh.materials[facet[v]][0], mesh.materials[facet[v]][1]);
  }
  const std::size_t vertices = points.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    points.push_back((mesh.points[c.a] + mesh.points[c.b] + mesh.points[c.c]) / 3.0);
    junctions.emplace_back(mesh.materials[t][0], mesh.materials[t][1]);
  }
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  const Array<Vec3f> place = upload_points(points);
  Array<Junction> junction = arena.template temporary<Junction>(junctions.size());
  junction.upload(junctions);
  Array<float> distance = arena.template temporary<float>(points.size());
  exec_.for_each(std::int64_t(points.size()),
                 detail::DistanceToInterface{bricks_.view(), place.data(), junction.data(), distance.data()});
  const std::vector<float> d = distance.download();
  SurfaceDistance result;
  const auto measure = [&](std::size_t first, std::size_t last, double& mean, double& largest) {
    std::size_t n = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (d[i] < 0) continue;
      mean += d[i];
      largest = std::max(largest, double(d[i]));
      ++n;
    }
    mean /= double(std::max<std::size_t>(n, 1));
  };
  measure(0, vertices, result.vertex_mean, result.vertex_max);
  measure(vertices, points.size(), result.facet_mean, result.facet_max);
  return result;
}

}  // namespace nacre
