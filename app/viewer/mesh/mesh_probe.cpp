// Nacre: what is under the cursor of a mesh: a triangle, or a position on the slice.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/viewer/mesh/mesh_scene.hpp"
#include "app/viewer/scene/clip.hpp"
#include "compute/meshing/quality.hpp"

namespace nacre {
namespace {

std::string position_line(const char* name, const Vec3d& p) {
  return fmt::format("{}: {:.5g} {:.5g} {:.5g}", name, p.x, p.y, p.z);
}

/// Where a ray passes the parallelogram of a slice.
std::optional<double> distance_to(const SlicePlane& plane, const Vec3d& from, const Vec3d& along) {
  const Vec3d normal = cross(plane.across, plane.up);
  const double distance = dot(plane.corner - from, normal) / dot(along, normal);
  if (!(distance > 0) || !std::isfinite(distance)) return {};
  const Vec3d p = from + along * distance - plane.corner;
  const double x = dot(p, plane.across) / dot(plane.across, plane.across);
  const double y = dot(p, plane.up) / dot(plane.up, plane.up);
  if (x < 0 || x > 1 || y < 0 || y > 1) return {};
  return distance;
}

/// The value in the file; where each material has a file, in the one that has the voxel.
void describe_voxel(ProbeResult& probed, const ViewedVolume& volume, std::size_t index) {
  if (volume.input.kind != MeshVolume::Kind::indicators)
    return probed.lines.push_back(fmt::format("volume: {:.6g}", volume.value(index)));
  const std::size_t material = volume.material[index], file = std::size_t(volume.input.labels[material]) - 1;
  if (material > 0 && file < volume.volumes->size())
    probed.lines.push_back(fmt::format("{}: {:.6g}", volume.input.names[material], volume.value(index, file)));
}

/// What the volume says of a position in it.
void describe_position(ProbeResult& probed, const ViewedVolume& volume) {
  probed.lines.push_back(position_line("position", probed.position));
  probed.lines.push_back(position_line("voxel", volume.to_voxels(probed.position)));
}

void describe_volume(ProbeResult& probed, const ViewedVolume& volume, bool material) {
  const std::optional<std::size_t> index = volume.index_at(probed.position);
  if (!index) return;
  describe_voxel(probed, volume, *index);
  if (material) probed.lines.push_back("material: " + material_name(volume.input, volume.material[*index]));
}

}  // namespace

std::optional<ProbeResult> probe_slice(const ViewedVolume& volume, const SlicePlane& plane, const Vec3d& from,
                                       const Vec3d& along) {
  const std::optional<double> distance = distance_to(plane, from, along);
  if (!distance) return {};
  ProbeResult probed;
  probed.position = from + along * *distance;
  describe_position(probed, volume);
  describe_volume(probed, volume, true);
  return probed;
}

/// The nearest triangle that is not hidden or cut away.
std::optional<TriangleHit> MeshScene::first_seen(const Vec3d& from, const Vec3d& along) const {
  if (!triangles_drawn()) return {};
  const ClipPlanes clip = clip_planes(settings_.view, corners_);
  constexpr int most_layers = 100;
  double near = 0;
  for (int layer = 0; layer < most_layers; ++layer) {
    const std::optional<TriangleHit> hit = rays_.first(from, along, near);
    if (!hit) return {};
    const auto& pair = results_.mesh->materials[hit->triangle];
    if (!clip.cut(hit->position) && std::max(material_styles_[pair[0]].opacity, material_styles_[pair[1]].opacity) > 0)
      return hit;
    near = std::nextafter(hit->distance, std::numeric_limits<double>::infinity());
  }
  return {};
}

void MeshScene::describe_hit(ProbeResult& probed, const TriangleHit& hit) const {
  const auto& pair = results_.mesh->materials[hit.triangle];
  const MeshInput& input = results_.volume->input;
  probed.lines.push_back(
      fmt::format("between: {} and {}", material_name(input, pair[0]), material_name(input, pair[1])));
  const Triangle& t = results_.mesh->triangles[hit.triangle];
  const std::vector<Vec3d>& p = results_.mesh->points;
  probed.lines.push_back(fmt::format("triangle: {}", hit.triangle));
  probed.lines.push_back(fmt::format("radius ratio: {:.3f}", radius_ratio(p[t.a], p[t.b], p[t.c])));
  if (!results_.measures) return;
  const std::vector<float>& size = results_.measures->size;
  probed.lines.push_back(fmt::format(
      "wanted size: {:.4g} voxels", hit.weights.x * size[t.a] + hit.weights.y * size[t.b] + hit.weights.z * size[t.c]));
}

std::optional<ProbeResult> MeshScene::probe(const Vec3d& from, const Vec3d& along) {
  if (!results_.volume) return {};
  const ViewedVolume& volume = *results_.volume;
  const std::optional<TriangleHit> hit = first_seen(from, along);
  std::optional<double> slice;
  if (const std::optional<SlicePlane> plane = shown_plane()) {
    slice = distance_to(*plane, from, along);
    if (slice && plane->is_oblique() && !volume.index_at(from + along * *slice)) slice.reset();
  }
  if (!hit && !slice) return {};
  const bool on_slice = slice && (!hit || *slice < hit->distance);
  ProbeResult probed;
  probed.position = on_slice ? from + along * *slice : hit->position;
  describe_position(probed, volume);
  if (!on_slice) describe_hit(probed, *hit);
  describe_volume(probed, volume, on_slice);
  return probed;
}

}  // namespace nacre
