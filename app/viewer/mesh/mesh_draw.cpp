// Nacre: a mesh in the making as the viewer shows it: how it looks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/viewer/mesh/mesh_scene.hpp"
#include "app/viewer/scene/layout.hpp"
#include "app/viewer/scene/scene_view.hpp"
#include "compute/particles/energy.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/legend.hpp"
#include "engine/run/material_palette.hpp"
#include "engine/scene/settings/ranges.hpp"

namespace nacre {
namespace {

constexpr std::array<float, 4> worst_colour{0.93f, 0.05f, 0.45f, 1};

/// Of the colours, in ideal energies: where particles are split, and where they are deleted.
std::array<double, 2> energy_range(const MeshParameters& p) { return {p.add_below, std::min(p.delete_above, 3.0)}; }

/// What the slice shows, but for the values of the volume itself.
MeshField field_of(SliceField field) {
  return field == SliceField::distance ? MeshField::distance
         : field == SliceField::size   ? MeshField::size
                                       : MeshField::material;
}

/// Of the slice's legend.
const char* title_of(SliceField field) {
  switch (field) {
    case SliceField::volume: return "volume";
    case SliceField::material: return "material";
    case SliceField::distance: return "distance";
    case SliceField::size: return "size";
  }
  return "";
}

}  // namespace

/// Every material is solid unless the view says otherwise; the outside has no say.
void MeshScene::update_material_styles() {
  if (!results_.volume) return;
  const std::vector<std::int64_t>& labels = results_.volume->input.labels;
  material_styles_.assign(labels.size(), {});
  palette_ = material_palette(results_.volume->input, settings_.view.material_colors);
  for (std::size_t m = 1; m < labels.size(); ++m) material_styles_[m].colour = palette_[m];
  material_styles_[0].opacity = 0;
  const auto apply = [&](std::int64_t label, float opacity, const char* knob) {
    const auto found = std::find(labels.begin() + 1, labels.end(), label);
    if (found == labels.end())
      warn_once(fmt::format("{}: there is no label {}", knob, label));
    else
      material_styles_[std::size_t(found - labels.begin())].opacity = opacity;
  };
  for (const std::int64_t label : labels_of(settings_.view.ghosts)) apply(label, ghost_opacity, "ghosts");
  for (const auto& [label, opacity] : parse_label_opacities(settings_.view.opacity))
    apply(label, float(opacity), "opacity");
  for (const std::int64_t label : labels_of(settings_.view.hidden)) apply(label, 0, "hidden");
  material_pass_.set_styles(material_styles_);
  preview_pass_.set_styles(material_styles_);
  update_edges();
  update_worst();
}

/// Of a triangle, as the pass has it.
static float opacity_of(const std::vector<MaterialStyle>& looks, const std::array<std::uint16_t, 2>& pair) {
  return pair[0] == 0 ? looks[pair[1]].opacity : std::max(looks[pair[0]].opacity, looks[pair[1]].opacity);
}

/// Edges and junctions of the solid triangles; of ghosts, junctions alone.
void MeshScene::update_edges() {
  if (!surface_) return;
  std::vector<float> opacity(drawing_.geometry.edges.size(), 0);
  for (std::size_t t = 0; t < drawing_.edge_of.size(); ++t)
    for (const std::uint32_t e : drawing_.edge_of[t])
      opacity[e] = std::max(opacity[e], opacity_of(material_styles_, drawing_.materials[t]));
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::size_t e = 0; e < opacity.size(); ++e)
    if (opacity[e] == 1) edges.push_back(drawing_.geometry.edges[e]);
  surface_.set_edges(edges);
  std::vector<LineSegment> curves;
  for (const std::uint32_t e : drawing_.junctions) {
    const auto& [a, b] = drawing_.geometry.edges[e];
    if (opacity[e] > 0)
      curves.push_back({drawing_.geometry.vertices[a].position, drawing_.geometry.vertices[b].position});
  }
  curves_ = Buffer::of<LineSegment>(curves);
}

void MeshScene::update_worst() {
  worst_ = Buffer();
  if (!results_.measures || settings_.view.worst <= 0) return;
  std::vector<LineSegment> outlines;
  int left = settings_.view.worst;
  for (const WorstTriangle& worst : results_.measures->worst) {
    if (opacity_of(material_styles_, drawing_.materials[worst.triangle]) <= 0) continue;
    if (left-- == 0) break;
    const Triangle& t = drawing_.geometry.triangles[worst.triangle];
    for (int k = 0; k < 3; ++k)
      outlines.push_back(
          {drawing_.geometry.vertices[t[k]].position, drawing_.geometry.vertices[t[(k + 1) % 3]].position});
  }
  worst_ = Buffer::of<LineSegment>(outlines);
}

/// The knob's; before there is anything else to see, the middle of the volume.
std::optional<SlicePlane> MeshScene::shown_plane() const {
  if (!results_.volume) return {};
  if (const std::optional<SlicePlane> wanted = wanted_slice(*results_.volume, settings_.view)) return wanted;
  if (three_slices()) return {};
  const bool hides = preview_drawn() && results_.volume->input.kind == MeshVolume::Kind::labels;
  if (!complete() && !hides) return slice_plane(results_.volume->input, 2, 0.5);
  return {};
}

/// Values of the volume are made here and now. Fields are the worker's: until it answers, the volume replaces
/// them.
void MeshScene::update_slice() {
  if (!results_.volume) return;
  const std::optional<SlicePlane> wanted = wanted_slice(*results_.volume, settings_.view);
  if (!wanted || settings_.view.slice_field == SliceField::volume) {
    worker_.drop_slice();
    slice_of_field_ = false;
    if (const std::optional<SlicePlane> plane = shown_plane())
      show_volume_slice(*plane);
    else
      slice_pass_.set_image({}, false);
    return;
  }
  const MeshField field = field_of(settings_.view.slice_field);
  if (!slice_of_field_) show_volume_slice(*wanted);
  request_ = {request_.number + 1, *wanted, field};
  worker_.ask_slice(request_);
}

/// The knob's where that means something, else nearly all of the values.
std::array<double, 2> MeshScene::volume_range() {
  const ValueSpread& spread = results_.volume->spread;
  if (!settings_.view.slice_range.empty()) try {
      const auto [low, high] = parse_pair(settings_.view.slice_range, ':', "slice_range");
      if (low < high) return {low, high};
      warn_once(fmt::format("slice_range {} holds nothing", settings_.view.slice_range));
    } catch (const Error& error) {
      warn_once(error.what());
    }
  return {spread.low, spread.high};
}

/// Values of a volume are gray, as scanners show them; fields have the colours that were chosen.
const Colormap& MeshScene::slice_map() const {
  return colormap(settings_.view.slice_field == SliceField::volume ? "gray" : settings_.colormap);
}

void MeshScene::show_volume_slice(const SlicePlane& plane) {
  const ViewedVolume& volume = *results_.volume;
  slice_values_ = volume.input.kind == MeshVolume::Kind::scalar;
  slice_range_ = volume_range();
  slice_pass_.set_image(volume_slice(volume, plane, palette_, slice_map(), slice_range_[0], slice_range_[1]),
                        slice_values_);
  slice_pass_.set_frame(plane.corner, plane.across, plane.up);
}

void MeshScene::take(SliceFilled& told) {
  if (told.number != request_.number) return;
  slice_of_field_ = true;
  slice_values_ = told.field != MeshField::material;
  if (slice_values_) {
    slice_range_ = slice_range(told.values, told.field);
    slice_pass_.set_image(colour_values(told.values, told.columns, told.rows, slice_range_[0], slice_range_[1],
                                        colormap(settings_.colormap)),
                          true);
  } else {
    slice_pass_.set_image(colour_materials(told.values, told.columns, told.rows, palette_), false);
  }
  slice_pass_.set_frame(told.plane.corner, told.plane.across, told.plane.up);
}

/// Sizes: those of the interfaces and up to what the slice has; distances: as far as any slice has looked.
std::array<double, 2> MeshScene::slice_range(const std::vector<float>& values, MeshField field) {
  double low = std::numeric_limits<double>::max(), high = 0;
  for (const float v : values)
    if (std::isfinite(v)) low = std::min(low, double(v)), high = std::max(high, double(v));
  if (field == MeshField::size) return {std::min(low, high), high};
  farthest_ = std::max(farthest_, high);
  return {0, farthest_};
}

std::array<double, 2> MeshScene::size_range() const {
  const double low = results_.info.smallest_size, high = results_.info.largest_size;
  return {low, high > low ? high : low * 1.0001 + 1e-12};
}

/// Three orthogonal slices as the knobs say; fields of the worker are shown by the slice of the view alone.
SliceViews* MeshScene::slices() {
  if (!results_.volume || settings_.view.layout == ViewLayout::single) return nullptr;
  if (!ortho_) ortho_ = std::make_unique<OrthoSlices>();
  SliceContent content;
  content.volume = results_.volume;
  if (triangles_drawn()) content.mesh = results_.mesh;
  content.crosshair = parse_crosshair(settings_.view.crosshair);
  content.materials = settings_.view.slice_field == SliceField::material;
  content.range = volume_range();
  content.palette = palette_;
  for (const MaterialStyle& style : material_styles_) content.drawn.push_back(style.opacity > 0);
  ortho_->show(std::move(content));
  return ortho_.get();
}

bool MeshScene::particles_drawn() const {
  return settings_.view.particles && counts_.total() > 0 && !triangles_drawn();
}

void MeshScene::draw(const View& frame) {
  View view = frame, whole = frame;
  whole.clip.clear();
  view.light =
      turned_light(mesh_light(view.camera), view.camera, settings_.view.light_azimuth, settings_.view.light_height);
  const bool begun = complete();
  if (shown_plane()) slice_pass_.draw(view);
  if (three_slices() && slices()) ortho_->draw_planes(view);
  if (!begun) segment_pass_.draw(whole, outline_place_, outline_, {{0.35f, 0.38f, 0.42f, 1}, 1.5f, false});
  if (preview_drawn()) preview_pass_.draw(view, preview_surface_, Placement(1.0));
  if (particles_drawn()) draw_particles(view);
  if (triangles_drawn()) draw_triangles(view);
  if (settings_.view.boxes && boxes_ && box_count_ > 0) {
    box_pass_.draw_corners(view, voxels_, boxes_->shown(), {sizeof(ShownBox), 0, sizeof(Vec3f)}, 0,
                           std::size_t(box_count_), {0.1f, 0.25f, 0.5f, 0.25f});
    boxes_->drawn();
  }
}

/// Surfaces, curves and points apart: curves have lower energies, and no normal to lie across.
void MeshScene::draw_particles(const View& view) const {
  const bool by_energy = settings_.view.particle_color == ParticleColour::energy;
  const double ideal = settings_.mesh.ideal_energy > 0 ? settings_.mesh.ideal_energy : hexagonal_energy;
  const std::array<double, 2> sizes = size_range(), energies = energy_range(settings_.mesh);
  const auto range = [&](double energy) {
    return by_energy ? std::array{float(energies[0] * energy), float(energies[1] * energy)}
                     : std::array{float(sizes[0]), float(sizes[1])};
  };
  const KeptIteration* const kept = looked_back_at();
  const Buffer& position = kept ? kept->position : particle_positions_->shown();
  const Buffer& direction = kept ? kept->direction : direction_->shown();
  const ShownCounts& counts = kept ? kept->counts : counts_;
  const auto draw = [&](std::int64_t first, std::int64_t count, const ParticleStyle& style) {
    particle_pass_.draw(view, voxels_, position, direction, std::size_t(first), std::size_t(count), style);
  };
  const std::int64_t points = counts.points, curves = counts.curves;
  // A hand on the mouse shall not wait for more discs than there are pixels; pictures have all of them.
  const std::size_t every = lockstep_ ? 1 : particle_share(view, std::size_t(counts.surfaces), diameter_of(seen()));
  draw(points + curves, counts.surfaces, {0.44f, false, by_energy, range(ideal), every});
  draw(points, curves, {0.3f, true, by_energy, range(ideal * row_energy / hexagonal_energy)});
  draw(0, points, {0.45f, true, by_energy, by_energy ? std::array{-1.0f, 1.0f} : range(0)});  // these have no energy
  particle_positions_->drawn();
  direction_->drawn();
}

void MeshScene::draw_triangles(const View& view) const {
  const Placement world(1.0), model = surface_.placement();
  material_pass_.draw(view, surface_, world);
  if (settings_.view.edges) edge_pass_.draw(view, surface_, world, {0, 0, 0, 0.5f});
  if (settings_.view.curves) segment_pass_.draw(view, model, curves_, {{0.08f, 0.08f, 0.1f, 1}, 2, false});
  std::array<float, 4> faint = worst_colour;
  faint[3] = 0.35f;
  segment_pass_.draw(view, model, worst_, {faint, 2.5f, true});
  segment_pass_.draw(view, model, worst_, {worst_colour, 2.5f, false});
}

std::uint64_t MeshScene::overlay_version() const {
  const std::array<double, 2> sizes = size_range(), energies = energy_range(settings_.mesh);
  const std::string key =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", settings_.legend, energies[0], energies[1], particles_drawn(),
                  int(settings_.view.particle_color), sizes[0], sizes[1], slice_has_legend(), slice_values_,
                  slice_range_[0], slice_range_[1], settings_.colormap + title_of(settings_.view.slice_field));
  return std::hash<std::string>()(key);
}

/// A legend of what the colours of particles mean; without these, of the slice's.
Image MeshScene::overlay(int width, int height) {
  Image image(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t(0));
  if (!has_legend()) return image;
  const Colormap& map = colormap(settings_.colormap);
  if (particles_drawn()) {
    const bool by_energy = settings_.view.particle_color == ParticleColour::energy;
    const std::array<double, 2> range = by_energy ? energy_range(settings_.mesh) : size_range();
    draw_legend(image, map, range[0], range[1], by_energy ? "energy / ideal" : "size, voxels");
  } else {
    draw_legend(image, slice_map(), slice_range_[0], slice_range_[1], title_of(settings_.view.slice_field));
  }
  return image;
}

}  // namespace nacre
