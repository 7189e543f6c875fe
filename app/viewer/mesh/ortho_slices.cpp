// Nacre: three orthogonal slices of a volume on the graphics device, with the outlines of the mesh.
#include "app/viewer/mesh/ortho_slices.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "app/viewer/mesh/mesh_outline.hpp"
#include "app/viewer/scene/layout.hpp"
#include "engine/picture/colormap.hpp"

namespace nacre {

void OrthoSlices::make_image(int k, const OrthoSlice& slice) {
  Shown& shown = shown_[std::size_t(k)];
  const ViewedVolume& volume = *content_.volume;
  Made wanted{content_.volume, slice.layer, content_.materials, content_.range, content_.palette, {}};
  if (shown.image == wanted) return;
  shown.image = std::move(wanted);
  ++images_made_;
  const bool values = volume.input.kind == MeshVolume::Kind::scalar && !content_.materials;
  const Colormap& map = colormap("gray");
  shown.pass.set_image(
      values ? volume_slice(volume, slice.plane, content_.palette, map, content_.range[0], content_.range[1])
             : material_slice(volume, slice.plane, content_.palette),
      values);
  shown.pass.set_frame(slice.plane.corner, slice.plane.across, slice.plane.up);
}

void OrthoSlices::make_outline(int k, const OrthoSlice& slice) {
  Shown& shown = shown_[std::size_t(k)];
  Made wanted{content_.mesh, slice.layer, false, {}, {}, content_.drawn};
  if (shown.outline == wanted) return;
  shown.outline = std::move(wanted);
  ++outlines_made_;
  shown.outlines.clear();
  if (!content_.mesh) return;
  shown.origin = slice.plane.corner;
  const Vec3d normal = content_.volume->input.axes[std::size_t(slice.axis)];
  for (const auto& [material, segments] : mesh_outline(*content_.mesh, normal, shown.origin, content_.drawn))
    shown.outlines.push_back({material, Buffer::of<LineSegment>(segments)});
}

void OrthoSlices::draw_lines(const View& view, const Vec3d& origin, const std::vector<LineSegment>& lines,
                             const std::array<float, 3>& colour, bool through) const {
  lines_.draw(view, place_grid(origin, 1), Buffer::of<LineSegment>(lines),
              {{colour[0], colour[1], colour[2], 1}, through ? 1.0f : 1.5f, through});
}

/// Each line lies where one of the other slices cuts this one, and has its colour.
void OrthoSlices::draw_crosshair(int k, const OrthoSlice& slice, const View& view) const {
  const ViewedVolume& volume = *content_.volume;
  const Vec3d middle = volume.to_world(Vec3d(crosshair_voxel(volume.input, content_.crosshair)));
  const Vec3d corner = slice.plane.corner;
  for (int other = 0; other < 3; ++other) {
    if (other == k) continue;
    const int across = this->slice(other).axis;  // the line runs along the third axis
    const Vec3d way = across == slice.plane.across_axis ? slice.plane.up : slice.plane.across;
    const Vec3d from = middle - way * (dot(middle - corner, way) / dot(way, way)) - corner;
    draw_lines(view, corner, {{Vec3f(from), Vec3f(from + way)}}, caption(other).colour, true);
  }
}

void OrthoSlices::draw(int k, const View& view) {
  const OrthoSlice slice = this->slice(k);
  make_image(k, slice);
  make_outline(k, slice);
  const Shown& shown = shown_[std::size_t(k)];
  shown.pass.draw(view);
  draw_crosshair(k, slice, view);
  draw_outlines(shown, view);
}

/// Black on the colours of materials; on greys, in the colours of the materials between dark borders.
void OrthoSlices::draw_outlines(const Shown& shown, const View& view) const {
  const bool on_greys = content_.volume->input.kind == MeshVolume::Kind::scalar && !content_.materials;
  const Placement place = place_grid(shown.origin, 1);
  for (const Outline& outline : shown.outlines)
    lines_.draw(view, place, outline.segments, {{0, 0, 0, on_greys ? 0.6f : 1.0f}, on_greys ? 3.5f : 1.5f, true});
  if (!on_greys) return;
  for (const Outline& outline : shown.outlines) {
    const Color& colour = content_.palette[outline.material];
    lines_.draw(view, place, outline.segments, {{colour[0], colour[1], colour[2], 1}, 2, true});
  }
}

void OrthoSlices::draw_planes(const View& view) {
  for (int k = 0; k < 3; ++k) {
    const OrthoSlice slice = this->slice(k);
    make_image(k, slice);
    shown_[std::size_t(k)].pass.draw(view);
    const Vec3f a(slice.plane.across), b(slice.plane.up), none;
    draw_lines(view, slice.plane.corner, {{none, a}, {a, a + b}, {a + b, b}, {b, none}}, caption(k).colour, false);
  }
}

std::string OrthoSlices::crosshair_at(int k, const Vec3d& point) const {
  const ViewedVolume& volume = *content_.volume;
  const int axis = slice(k).axis;
  Vec3d shares = crosshair_shares(volume.input, volume.to_voxels(point));
  shares[axis] = content_.crosshair[axis];
  return crosshair_text(shares);
}

std::string OrthoSlices::crosshair_after(int k, int steps) const {
  const MeshInput& input = content_.volume->input;
  const OrthoSlice slice = this->slice(k);
  Vec3d shares = content_.crosshair;
  Vec3d voxel(crosshair_voxel(input, shares));
  voxel[slice.axis] += input.axes[std::size_t(slice.axis)][k] < 0 ? -steps : steps;
  shares[slice.axis] = crosshair_shares(input, voxel)[slice.axis];
  return crosshair_text(shares);
}

std::optional<ProbeResult> OrthoSlices::probe(int k, const Vec3d& from, const Vec3d& along) const {
  return probe_slice(*content_.volume, slice(k).plane, from, along);
}

}  // namespace nacre
