// Nacre: a quick surface of the materials.
#include "app/viewer/mesh/mesh_preview.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/surface_nets.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_voxels = std::size_t(1) << 24;  ///< that are looked at: all of 256^3

/// Flat triangles without edges, which nobody asks of a preview: to find them takes longer than the preview.
SurfaceGeometry geometry_of(const SurfaceMesh& mesh) {
  SurfaceGeometry g;
  if (mesh.points.empty()) return g;
  Vec3d low = mesh.points[0], high = low;
  for (const Vec3d& p : mesh.points) low = min(low, p), high = max(high, p);
  const Vec3d extent = high - low;
  g.origin = low;
  g.size = std::max({extent.x, extent.y, extent.z, std::numeric_limits<double>::min()});
  g.vertices.reserve(mesh.points.size());
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v)
    g.vertices.push_back({Vec3f((mesh.points[v] - low) / g.size), Vec3f{}, v});
  g.triangles = mesh.triangles;
  return g;
}

}  // namespace

MeshPreview make_mesh_preview(const ViewedVolume& volume, const std::atomic<bool>* stop) {
  const MeshInput& input = volume.input;
  MeshPreview preview;
  preview.stride = surface_nets_stride(input.dims, most_voxels);
  MaterialVoxels voxels{input.dims, volume.material, input.origin, input.axes};
  for (int a = 0; a < 3; ++a) voxels.steps[std::size_t(a)] *= input.spacing[a];
  SurfaceMesh mesh = surface_nets(voxels, {.stride = preview.stride, .stop = stop});
  check_stop(stop);
  preview.geometry = geometry_of(mesh);
  preview.materials = std::move(mesh.materials);
  return preview;
}

}  // namespace nacre
