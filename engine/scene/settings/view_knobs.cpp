// Nacre: the knobs of the viewer, one row each. They change what is drawn, and no result.
#include "engine/scene/settings/knob_rows.hpp"

namespace nacre {
namespace {

constexpr const char* group = "view";

std::vector<Knob> drawing_knobs(ViewSettings& l) {
  return {
      {.name = "play",
       .group = group,
       .help = "let time run, or the iterations of the particles; false: pause (in a window)",
       .value = &l.play},
      {.name = "loop", .group = group, .help = "flow: begin again after the last time", .value = &l.loop},
      {.name = "play_speed",
       .group = group,
       .help = "flow: pace in a window; 1: as many steps per second as fps says, if computing keeps up",
       .value = &l.play_speed,
       .min = 0.05,
       .max = 10},
      {.name = "iteration",
       .group = group,
       .help = "mesh: iteration of the particles to show, if it is still in memory; 0: the newest",
       .value = &l.iteration,
       .min = 0,
       .max = 1000000},
      {.name = "edges", .group = group, .help = "draw the edges of the triangles", .value = &l.edges},
      {.name = "arrows", .group = group, .help = "flow: draw the vectors as arrows", .value = &l.arrows},
      {.name = "arrow_count",
       .group = group,
       .help = "flow: number of arrows on the whole surface",
       .value = &l.arrow_count,
       .min = 1,
       .max = 100000},
      {.name = "arrow_length",
       .group = group,
       .help = "flow: length of the arrows; 1: the reference speed reaches from arrow to arrow",
       .value = &l.arrow_length,
       .min = 0.05,
       .max = 20},
      {.name = "triangles", .group = group, .help = "mesh: draw the triangles", .value = &l.triangles},
      {.name = "show_particles", .group = group, .help = "mesh: draw the particles", .value = &l.particles},
      {.name = "curves", .group = group, .help = "mesh: draw the junction curves", .value = &l.curves},
      {.name = "boxes", .group = group, .help = "draw the boxes of the octree, or of the grid", .value = &l.boxes},
      {.name = "particle_color",
       .group = group,
       .help = "mesh: what colours the particles",
       .value = &l.particle_color,
       .choices = {"energy", "size"}},
      {.name = "hidden", .group = group, .help = "mesh: L[,L...]: labels that are not drawn", .value = &l.hidden},
      {.name = "ghosts",
       .group = group,
       .help = "mesh: L[,L...]: labels that are drawn transparent",
       .value = &l.ghosts},
      {.name = "worst",
       .group = group,
       .help = "mesh: number of the worst triangles to highlight",
       .value = &l.worst,
       .min = 0,
       .max = 1000},
  };
}

std::vector<Knob> plane_knobs(ViewSettings& l) {
  return {
      {.name = "clip",
       .group = group,
       .help = "axis that the clipping plane cuts across",
       .value = &l.clip,
       .choices = {"none", "x", "y", "z"}},
      {.name = "clip_at",
       .group = group,
       .help = "position of the clipping plane, as a share of the bounding box",
       .value = &l.clip_at,
       .min = 0,
       .max = 1},
      {.name = "clip_back",
       .group = group,
       .help = "cut away the other side of the clipping plane",
       .value = &l.clip_back},
      {.name = "slice",
       .group = group,
       .help = "mesh: axis that the slice cuts the volume across",
       .value = &l.slice,
       .choices = {"none", "x", "y", "z"}},
      {.name = "slice_at",
       .group = group,
       .help = "position of the slice, as a share of the volume",
       .value = &l.slice_at,
       .min = 0,
       .max = 1},
      {.name = "slice_field",
       .group = group,
       .help = "what the slice shows",
       .value = &l.slice_field,
       .choices = {"volume", "material", "distance", "size"}},
      {.name = "slice_range",
       .group = group,
       .help = "LO:HI: values that a slice of a scalar volume shows in black and in white; empty: nearly all",
       .value = &l.slice_range},
  };
}

std::vector<Knob> light_and_window_knobs(ViewSettings& l) {
  return {
      {.name = "light_azimuth",
       .group = group,
       .unit = "degrees",
       .help = "angle of the light about the camera's up axis",
       .value = &l.light_azimuth,
       .min = -180,
       .max = 180},
      {.name = "light_height",
       .group = group,
       .unit = "degrees",
       .help = "angle of the light above the camera",
       .value = &l.light_height,
       .min = -90,
       .max = 90},
      {.name = "ambient", .group = group, .help = "share of ambient light", .value = &l.ambient, .min = 0, .max = 1},
      {.name = "turning",
       .group = group,
       .help = "how dragging the mouse rotates the view",
       .value = &l.turning,
       .choices = {"turntable", "trackball"}},
      {.name = "panel", .group = group, .help = "show the panel", .value = &l.panel},
      {.name = "tab",
       .group = group,
       .help = "tab of the panel that is open",
       .value = &l.tab,
       .choices = {"data", "knobs", "look", "timings", "result"}},
      {.name = "theme",
       .group = group,
       .help = "colours of the panel",
       .value = &l.theme,
       .choices = {"dark", "light"}},
      {.name = "text_size",
       .group = group,
       .help = "size of the panel's text; 1: normal",
       .value = &l.text_size,
       .min = 0.5,
       .max = 4},
  };
}

}  // namespace

std::vector<Knob> view_knobs(Settings& settings) {
  std::vector<Knob> table;
  for (const auto part : {drawing_knobs, plane_knobs, light_and_window_knobs})
    for (Knob& knob : part(settings.view)) table.push_back(std::move(knob));
  return table;
}

}  // namespace nacre
