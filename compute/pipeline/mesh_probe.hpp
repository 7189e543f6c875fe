// Nacre: the fields of a volume at points of the world.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "compute/pipeline/mesh_fields.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

namespace detail {

struct MaterialAt {
  MaterialBricksView field;
  const Vec3f* point;
  std::uint16_t* material;
  NACRE_HD void operator()(std::int64_t i) const { material[i] = std::uint16_t(material_at(field, point[i])); }
};

/// The same for pictures, sooner: a voxel whose 26 neighbours are of its material is taken to be whole.
struct PictureMaterialAt {
  MaterialBricksView field;
  const Vec3f* point;
  float* material;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = point[i];
    material[i] = 0;
    if (!field.inside(p, 2)) return;
    const Vec3f u = p * field.cells_per_unit;
    const Int3 v{int(u.x), int(u.y), int(u.z)};
    const std::uint16_t own = field.material(v);
    const bool whole = field.each_material(v - Int3(1), v + Int3(2), [&](std::uint16_t m) { return m == own; });
    material[i] = whole ? float(own) : float(nacre::material_at(field, p));
  }
};

struct SizeAt {
  MaterialBricksView field;
  SizingFieldView size;
  const Vec3f* point;
  float* h;
  NACRE_HD void operator()(std::int64_t i) const { h[i] = field.inside(point[i], 0) ? size(point[i]) : NAN; }
};

/// Unsigned distance from the interfaces: the interface point that is the nearest stands for a disc as wide as the
/// lattice, since distances from the points alone would show where they lie.
struct DistanceAt {
  MaterialBricksView field;
  DistanceFieldView distances;
  const Vec3f* point;
  float* distance;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = point[i];
    distance[i] = NAN;
    if (!field.inside(p, 0)) return;
    float away = 0;
    const std::uint32_t q = distances.closest(p, away);
    distance[i] = INFINITY;
    if (q == none || away > distances.reach) return;
    const Float4 n = distances.point[q].normal;
    const Vec3f s = distances.lattice().spacing;
    const float along = dot(p - distances.position(q), Vec3f(n.x, n.y, n.z));
    const float beside = std::sqrt(std::fmax(away * away - along * along, 0.0f)) - std::fmax(s.x, std::fmax(s.y, s.z));
    distance[i] = beside > 0 ? std::sqrt(along * along + beside * beside) : std::fabs(along);
  }
};

/// See JunctionGradients.
struct JunctionGradientsAt {
  MaterialBricksView field;
  const Vec3f* point;
  const Junction* junction;
  JunctionGradients* gradients;
  NACRE_HD void operator()(std::int64_t i) const {
    gradients[i] = {};
    if (!field.inside(point[i], 2.5f)) return;
    const CubicStencil stencil(field, point[i]);
    const Junction j = junction[i];
    for (int k = 1; k < j.materials(); ++k)
      gradients[i].from_first[k - 1] = stencil.difference(field, j.material(0), j.material(k)).gradient;
  }
};

/// Distance of a point from the interface of a facet's two materials, in voxels; negative where it cannot be found.
struct DistanceToInterface {
  MaterialBricksView field;
  const Vec3f* point;
  const Junction* junction;
  float* distance;
  NACRE_HD void operator()(std::int64_t i) const {
    JunctionPoint on;
    distance[i] = -1;
    if (!field.inside(point[i], 3) || !project(field, junction[i], point[i], 3, on)) return;
    distance[i] = length(on.p - point[i]);
  }
};

/// Where a point comes to lie on its junction, voxels; not finite where that is more than 6 voxels away or, with
/// `margin` the least, beyond its rim.
struct PointOntoJunction {
  MaterialBricksView field;
  float margin;  ///< voxels; see junction_margin
  const Vec3f* point;
  const Junction* junction;
  Vec3f* on;
  NACRE_HD void operator()(std::int64_t i) const {
    on[i] = Vec3f(NAN);
    JunctionPoint at;
    const Junction j = junction[i];
    if (!field.inside(point[i], 3) || !project(field, j, point[i], 6, at)) return;
    if (junction_margin(field, j, at.p, at.steepness) < margin) return;
    on[i] = at.p;
  }
};

/// Points of the world as the fields' kernels take them, temporary in the caller's scope; those far off are brought
/// nearer, and what is no number becomes such a point.
template <class Backend>
Array<Vec3f> upload_points(Executor<Backend>& exec, const VolumeFrame& frame, std::span<const Vec3d> points) {
  std::vector<Vec3f> host(points.size());
  const float far = 1e6f;
  std::transform(points.begin(), points.end(), host.begin(), [&](const Vec3d& w) {
    const Vec3f p(frame.to_voxels(w));
    return is_finite(p) ? max(min(p, Vec3f(far)), Vec3f(-far)) : Vec3f(-far);
  });
  Array<Vec3f> array = exec.arena().template temporary<Vec3f>(host.size());
  array.upload(host);
  return array;
}

}  // namespace detail

/// The material at each point.
template <class Backend>
std::vector<std::uint16_t> material_at(Executor<Backend>& exec, const MeshFields<Backend>& fields,
                                       std::span<const Vec3d> points) {
  Arena::Scope scope(exec.arena());
  const Array<Vec3f> position = detail::upload_points(exec, fields.frame(), points);
  Array<std::uint16_t> material = exec.arena().template temporary<std::uint16_t>(points.size());
  exec.for_each(std::int64_t(points.size()),
                detail::MaterialAt{fields.bricks().view(), position.data(), material.data()});
  return material.download();
}

/// The gradients at points of junctions, voxels.
template <class Backend>
std::vector<JunctionGradients> junction_gradients(Executor<Backend>& exec, const MeshFields<Backend>& fields,
                                                  std::span<const Vec3f> points, std::span<const Junction> junctions) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  Array<Vec3f> position = arena.template temporary<Vec3f>(points.size());
  position.upload(points);
  Array<Junction> junction = arena.template temporary<Junction>(points.size());
  junction.upload(junctions);
  Array<JunctionGradients> gradients = arena.template temporary<JunctionGradients>(points.size());
  exec.for_each(std::int64_t(points.size()), detail::JunctionGradientsAt{fields.bricks().view(), position.data(),
                                                                         junction.data(), gradients.data()});
  return gradients.download();
}

/// A field at each point, as MeshField says.
template <class Backend>
std::vector<float> field_at(Executor<Backend>& exec, const MeshFields<Backend>& fields, MeshField field,
                            std::span<const Vec3d> points) {
  Arena::Scope scope(exec.arena());
  const Array<Vec3f> position = detail::upload_points(exec, fields.frame(), points);
  Array<float> value = exec.arena().template temporary<float>(points.size());
  const MaterialBricksView bricks = fields.bricks().view();
  const std::int64_t n = std::int64_t(points.size());
  if (field == MeshField::material) {
    exec.for_each(n, detail::PictureMaterialAt{bricks, position.data(), value.data()});
    return value.download();
  }
  if (field == MeshField::distance)
    exec.for_each(n, detail::DistanceAt{bricks, fields.distance().view(), position.data(), value.data()});
  else
    exec.for_each(n, detail::SizeAt{bricks, fields.size().view(), position.data(), value.data()});
  std::vector<float> result = value.download();
  for (float& x : result) x *= float(fields.frame().unit);
  return result;
}

/// How far each point is from the interface of its two materials, voxels; negative where that cannot be found.
template <class Backend>
std::vector<float> distance_to_interfaces(Executor<Backend>& exec, const MeshFields<Backend>& fields,
                                          std::span<const Vec3d> points, std::span<const Junction> interfaces) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const Array<Vec3f> position = detail::upload_points(exec, fields.frame(), points);
  Array<Junction> junction = arena.template temporary<Junction>(interfaces.size());
  junction.upload(interfaces);
  Array<float> distance = arena.template temporary<float>(points.size());
  exec.for_each(std::int64_t(points.size()),
                detail::DistanceToInterface{fields.bricks().view(), position.data(), junction.data(), distance.data()});
  return distance.download();
}

/// Where points of the world come to lie on junctions, world; not finite where there is none nearby or, `within` its
/// rim, where the junction ends before that. A junction without materials has no points.
template <class Backend>
std::vector<Vec3d> onto_junctions(Executor<Backend>& exec, const MeshFields<Backend>& fields,
                                  std::span<const Vec3d> points, std::span<const Junction> junctions, bool within) {
  std::vector<Vec3d> result(points.size(), Vec3d(NAN));
  std::vector<std::size_t> asked;
  std::vector<Vec3d> from;
  std::vector<Junction> onto;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (junctions[i].material(1) == 0xffff) continue;
    asked.push_back(i);
    from.push_back(points[i]);
    onto.push_back(junctions[i]);
  }
  if (asked.empty()) return result;
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const Array<Vec3f> position = detail::upload_points(exec, fields.frame(), from);
  Array<Junction> junction = arena.template temporary<Junction>(onto.size());
  junction.upload(onto);
  Array<Vec3f> on = arena.template temporary<Vec3f>(onto.size());
  exec.for_each(std::int64_t(onto.size()), detail::PointOntoJunction{fields.bricks().view(), within ? -0.02f : -3e38f,
                                                                     position.data(), junction.data(), on.data()});
  const std::vector<Vec3f> found = on.download();
  for (std::size_t k = 0; k < asked.size(); ++k)
    if (is_finite(found[k])) result[asked[k]] = fields.frame().to_world(Vec3d(found[k]));
  return result;
}

}  // namespace nacre
