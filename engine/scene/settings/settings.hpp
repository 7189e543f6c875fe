// Nacre: all settings of a run.
#pragma once

#include <string>

#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// What becomes a material of a volume, as text; engine/scene/volume/material_options.hpp parses it.
struct MaterialSettings {
  bool labels = false;     ///< the values are labels, whatever they look like
  std::string isovalue;    ///< V[,V...]
  std::string threshold;   ///< LO:HI
  std::string materials;   ///< L[,L...]: labels to keep; empty: all
  std::string merge;       ///< A:B[,A:B...]: label A becomes B
  int min_component = 0;   ///< drop pieces of fewer voxels
  std::string names;       ///< a file with the names of labels; empty: those of the volume
  std::string size_image;  ///< a volume file of wanted sizes; empty: none
  int layer = -1;          ///< of a segmentation whose segments overlap, from 0; -1: all, later segments over earlier
};

/// That a plane of the viewer cuts across. none: there is no plane; plane: in the first of `clip_planes` (a slice).
enum class PlaneAxis { none, x, y, z, plane };
enum class ParticleColour { energy, size };
enum class SliceField { volume, material, distance, size };
enum class ViewLayout { single, slices, x, y, z };  ///< the view; beside three slices; one slice alone
enum class Turning { turntable, trackball };
enum class PanelSide { left, right };
enum class PanelTab { data, knobs, look, timings, result };
enum class Theme { dark, light };
enum class RelativeVectors { when_velocity, on, off };
enum class DyeRelease { once, always };
enum class ColourScale { linear, log };

/// What the viewer draws, and how. Nothing here changes a result.
struct ViewSettings {
  bool play = true;                         ///< time goes on; a mesh: iterations do
  bool loop = true;                         ///< flow: after the last time comes the first
  double play_speed = 1;                    ///< flow: pace in a window; 1: `fps` steps a second
  int iteration = 0;                        ///< mesh: of the particles that are drawn; 0: the newest
  bool edges = false;                       ///< of triangles
  bool arrows = false;                      ///< flow: vectors as arrows
  int arrow_count = 1500;                   ///< over the whole surface
  double arrow_length = 1;                  ///< of the reference speed, in mean distances between arrows
  bool triangles = true, particles = true;  ///< mesh
  bool curves = true;                       ///< mesh: junctions
  bool boxes = false;                       ///< those of the tree, or grid
  ParticleColour particle_color = ParticleColour::energy;
  std::string hidden, ghosts;         ///< L[,L...]: labels of materials
  int worst = 0;                      ///< mesh: so many of the worst triangles stand out
  PlaneAxis clip = PlaneAxis::none;   ///< nothing is drawn before the plane
  double clip_at = 0.5;               ///< its position in the bounding box
  bool clip_back = false;             ///< nothing is drawn behind it instead
  std::string clip_planes;            ///< nx ny nz x y z;...: further ones, in any direction
  PlaneAxis slice = PlaneAxis::none;  ///< a plane of the volume
  double slice_at = 0.5;
  SliceField slice_field = SliceField::volume;
  std::string slice_range;  ///< LO:HI of a volume's values; empty: nearly all of them
  ViewLayout layout = ViewLayout::single;
  std::string crosshair = "0.5 0.5 0.5";       ///< shares of the volume, along its axes: where its slices meet
  double light_azimuth = 0, light_height = 0;  ///< degrees, from the light beside the camera
  double ambient = 0.3;                        ///< share of the light that comes from everywhere
  Turning turning = Turning::turntable;        ///< how dragging rotates the camera
  std::string material_colors;                 ///< L:#rrggbb[,L:...]: of materials, by label
  std::string opacity;                         ///< L:0..1[,L:...]: of materials, by label
  int isolines = 0;                            ///< of a flow, over the colour range
  std::string ruler;                           ///< x y z;x y z;...: points to measure between
  std::string notes;                           ///< x y z text;...
  std::string cameras;                         ///< name:numbers;...: to come back to
  std::string compare;        ///< same, sample:NAME or FILE[;FILE...]: shown in a second view; empty: there is none
  std::string compare_knobs;  ///< name=value[;...]: in which the second view differs
  PanelSide panel_side = PanelSide::left;
  double panel_width = 1;  ///< 1: normal
  bool preview = true;     ///< of a volume, a quick surface until there is a better one
  bool panel = true;       ///< over the picture
  PanelTab tab = PanelTab::data;
  Theme theme = Theme::dark;  ///< of the panels
  double text_size = 1;       ///< of the panels
};

inline FlowParameters default_flow() {
  FlowParameters flow;
  flow.resolution = 0;  // as the picture asks: engine/run/focus.hpp
  return flow;
}

/// Values of all knobs; the defaults are the members' initial values. The table is in knobs.hpp.
struct Settings {
  FlowParameters flow = default_flow();
  MeshParameters mesh;
  MaterialSettings materials;
  ViewSettings view;
  double max_cell = 0;    ///< longest edge of tetrahedra, voxels; 0: they grow with the distance from the surface
  int element_order = 1;  ///< of triangles and tetrahedra in files: 2 with a node on each edge

  std::string patch;                                          ///< names of the parts of a case to show; empty: all
  std::string vectors;                                        ///< array name or @field; empty: chosen
  double crease_angle = 40;                                   ///< degrees
  std::string time;                                           ///< LO:HI of the data; empty: all of it
  double begin_at = 0;                                        ///< share of that time at which the first frame is
  RelativeVectors relative = RelativeVectors::when_velocity;  ///< vectors less the velocity of the surface
  std::string surface_velocity;                               ///< an array that has it; empty: from the positions
  double period = 0;                                          ///< of the data's time; 0: it does not come round
  std::string color = "speed";
  std::string colormap = "sea";
  std::string color_range;       ///< LO:HI, or percentiles A%:B%; empty: of the data
  bool color_symmetric = false;  ///< as far below 0 as above
  ColourScale color_scale = ColourScale::linear;
  std::string color_below, color_above;  ///< #rrggbb beyond the range; empty: the ends of the map
  std::string color_nan = "#808080";     ///< #rrggbb where there is no number
  BackFaces back_faces = BackFaces::shown;
  std::string camera = "iso";      ///< a view or a JSON file
  bool focus = true;               ///< close-ups are computed at the picture's resolution
  double orbit = 0;                ///< degrees per frame
  int width = 1024, height = 768;  ///< of the picture
  int samples = 2;                 ///< rays per pixel and axis
  std::string background = "#ffffff";
  int fps = 25;
  bool legend = true, time_stamp = true;
  bool topology = false;      ///< critical points and separatrices are drawn
  bool tracks = false;        ///< the paths of critical points in time are drawn
  std::string probe;          ///< points of which the times are told (engine/run/flow_probes.hpp); empty: none
  bool streamlines = false;   ///< evenly spaced streamlines are drawn
  double persistence = 0.02;  ///< share of the reference speed; zeros that cancel below it are left out
  std::string dye;            ///< sources (engine/run/dye_sources.hpp); empty: none
  DyeRelease dye_release = DyeRelease::once;
  double dye_diffusion = 0;    ///< area per time of the data
  std::string dye_regions;     ///< array of whole numbers, for the report; empty: none
  double ftle_time = 0;        ///< of flow maps, time of the data; below 0: backward; 0: chosen
  double line_spacing = 0.02;  ///< of evenly spaced streamlines; share of the longest side of the bounding box
};

}  // namespace nacre
