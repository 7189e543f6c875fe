// Nacre: what belongs to a cell of the texture besides its value.
#include "compute/pipeline/describe_cells.hpp"

namespace nacre {

void DescribeCells::operator()(FlowValues& values, std::size_t s, const Vec3d& centre, const Vec3d& surface,
                               std::uint32_t t) const {
  const MeshView mesh{points.data(), corners.data(), normals.data()};
  const MeshView now{moved_points.data(), corners.data(), moved_normals.data()};
  const Vec3f w(barycentric(mesh.corners(t), surface));
  const Triangle c = corners[t];
  const Vec3f v = vectors[c.a] * w.x + vectors[c.b] * w.y + vectors[c.c] * w.z;
  const Vec3f normal = (moved ? now : mesh).normal(t, w);
  Vec3d foot = surface, middle = centre;
  if (moved) {  // the foot goes with the material, and the centre keeps its height over it
    const Corners there = now.corners(t);
    foot = there.a * double(w.x) + there.b * double(w.y) + there.c * double(w.z);
    middle = foot + Vec3d(normal) * dot(centre - surface, Vec3d(mesh.normal(t, w)));
  }
  const Vec3d back = second_sheet && second_sheet[t] ? shift : Vec3d();
  values.centre[s] = domain.to_world(middle) - back;
  values.closest_point[s] = domain.to_world(foot) - back;
  values.normal[s] = normal;
  values.velocity[s] = v - normal * dot(normal, v);
}

}  // namespace nacre
