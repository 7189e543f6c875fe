// Nacre: the knobs of meshing, one row each.
#include <limits>

#include "engine/scene/settings/knob_rows.hpp"

namespace nacre {
namespace {

constexpr double largest_int = std::numeric_limits<int>::max();

std::vector<Knob> material_knobs(Settings& s) {
  MaterialSettings& m = s.materials;
  const std::string group = "materials";
  return {
      {.name = "labels",
       .group = group,
       .help = "treat the values as labels, whatever they look like",
       .value = &m.labels},
      {.name = "isovalue",
       .group = group,
       .help = "V[,V...]: cut a scalar volume at these values",
       .value = &m.isovalue},
      {.name = "threshold",
       .group = group,
       .help = "LO:HI: mesh the region with values from LO to HI",
       .value = &m.threshold},
      {.name = "materials",
       .group = group,
       .help = "L[,L...]: labels to keep, all others become outside; empty: keep all",
       .value = &m.materials},
      {.name = "merge", .group = group, .help = "A:B[,A:B...]: label A becomes label B", .value = &m.merge},
      {.name = "min_component",
       .group = group,
       .unit = "voxels",
       .help = "connected pieces with fewer voxels take the label around them",
       .value = &m.min_component,
       .min = 0,
       .max = largest_int},
      {.name = "size_image",
       .group = group,
       .help = "volume file of largest distances between particles, in the units of its spacing, in place of max_size; "
               "0, negative or no number: max_size",
       .value = &m.size_image},
  };
}

/// Which labels a file gives, and what they are called.
std::vector<Knob> label_knobs(Settings& s) {
  MaterialSettings& m = s.materials;
  return {
      {.name = "names",
       .group = "labels",
       .help = "file with names of labels, of ITK-SNAP, FreeSurfer or 3D Slicer; empty: those in the volume's file",
       .value = &m.names},
      {.name = "layer",
       .group = "labels",
       .help = "the layer of a 4-D .seg.nrrd to take, from 0; -1: all, later segments over earlier ones",
       .value = &m.layer,
       .min = -1,
       .max = largest_int},
  };
}

std::vector<Knob> field_knobs(Settings& s) {
  MeshParameters& m = s.mesh;
  const std::string fields = "fields", sizing = "sizing";
  return {
      {.name = "tighten",
       .group = fields,
       .unit = "voxels",
       .help = "width of the smoothing of label boundaries; 0: keep the voxel staircase",
       .value = &m.tighten,
       .min = 0,
       .max = 1.5},
      {.name = "stairs",
       .group = fields,
       .unit = "voxels",
       .help = "staircases of labels become slopes where their treads are at most this long; 0: never",
       .value = &m.stairs,
       .min = 0,
       .max = 128},
      {.name = "kernel",
       .group = fields,
       .help = "reconstruction kernel of the fields",
       .value = &m.kernel,
       .choices = {"catmull-rom", "b-spline"}},
      {.name = "mesh_subcells",
       .group = fields,
       .help = "closest-point cells per voxel and axis; twice as many for sheets thinner than particles are apart",
       .value = &m.subcells,
       .min = 1,
       .max = 8},
      {.name = "epsilon",
       .group = sizing,
       .help = "distance between particles as a share of the local feature size",
       .value = &m.epsilon,
       .min = 0.01,
       .max = 100},
      {.name = "delta",
       .group = sizing,
       .help = "largest slope of the sizing field",
       .value = &m.delta,
       .min = 0.01,
       .max = 100},
      {.name = "min_size",
       .group = sizing,
       .unit = "voxels",
       .help = "smallest distance between particles, at most max_size",
       .value = &m.min_size,
       .min = 0.05,
       .max = 1000},
      {.name = "max_size",
       .group = sizing,
       .unit = "voxels",
       .help = "largest distance between particles, at least min_size",
       .value = &m.max_size,
       .min = 0.05,
       .max = 1000},
      {.name = "sizes",
       .group = sizing,
       .unit = "voxels",
       .help =
           "WHAT:SIZE[,WHAT:SIZE...]: largest distance there, instead of max_size; WHAT: a label, a name, box x0 y0 "
           "z0 x1 y1 z1, or ball x y z radius (in the units of the data)",
       .value = &m.sizes},
      {.name = "curvature",
       .group = sizing,
       .help = "also bound the sizing field by epsilon / largest curvature",
       .value = &m.curvature},
      {.name = "max_deviation",
       .group = sizing,
       .unit = "voxels",
       .help = "largest distance of triangles from the interface that they stand for: particles are nearer where it "
               "bends; 0: any",
       .value = &m.max_deviation,
       .min = 0.001,
       .max = 1000,
       .or_zero = true},
  };
}

std::vector<Knob> particle_knobs(Settings& s) {
  MeshParameters& m = s.mesh;
  const std::string group = "particles";
  return {
      {.name = "quality",
       .group = group,
       .help = "draft: quick, for looking and for turning knobs; best: more rounds of everything",
       .value = &m.quality,
       .choices = {"draft", "standard", "best"}},
      {.name = "solver",
       .group = group,
       .help = "how particles are moved",
       .value = &m.solver,
       .choices = {"tree", "redblack", "serial"}},
      {.name = "theta",
       .group = group,
       .help = "tree solver: a node smaller than theta times its distance counts as one particle",
       .value = &m.theta,
       .min = 0,
       .max = 2},
      {.name = "iterations",
       .group = group,
       .help = "most iterations per junction order",
       .value = &m.iterations,
       .min = 0,
       .max = 1000000},
      {.name = "stagnation",
       .group = group,
       .help = "stop when the energy falls by less than this share",
       .value = &m.stagnation,
       .min = 0,
       .max = 1},
      {.name = "step",
       .group = group,
       .help = "tree solver: share of the Newton step that is taken",
       .value = &m.step,
       .min = 0.01,
       .max = 4},
      {.name = "momentum",
       .group = group,
       .help = "tree solver: share of the last step that is added to the next",
       .value = &m.momentum,
       .min = 0,
       .max = 0.99},
      {.name = "ideal_energy",
       .group = group,
       .help = "ideal energy of a particle; 0: that in a hexagonal lattice",
       .value = &m.ideal_energy,
       .min = 0,
       .max = 1000},
      {.name = "add_below",
       .group = group,
       .help = "split particles below this share of the ideal energy",
       .value = &m.add_below,
       .min = 0,
       .max = 1},
      {.name = "delete_above",
       .group = group,
       .help = "delete particles above this multiple of the ideal energy",
       .value = &m.delete_above,
       .min = 1,
       .max = 1000},
      {.name = "control_every",
       .group = group,
       .help = "iterations between two controls of the population",
       .value = &m.control_every,
       .min = 1,
       .max = 1000000},
      {.name = "by_density",
       .group = group,
       .help = "serial and redblack solvers: control the population by estimated density, not by the thesis's rule",
       .value = &m.by_density},
      {.name = "smooth",
       .group = group,
       .unit = "rounds",
       .help = "how often vertices are moved within the triangles around them",
       .value = &m.smooth,
       .min = 0,
       .max = 100},
      {.name = "remesh",
       .group = group,
       .unit = "rounds",
       .help = "how often, at most, particles are deleted and inserted at bad triangles (local remeshing)",
       .value = &m.remesh,
       .min = 0,
       .max = 100,
       .old_names = {"mend"}},
      {.name = "triangulation",
       .group = group,
       .help =
           "what triangles are made of: each particle's neighbours (stars), whose bad triangles are then changed edge "
           "by edge, or cells of the Delaunay triangulation alone; auto: stars, but cells for tetrahedra",
       .value = &m.triangles,
       .choices = {"auto", "delaunay", "stars"}},
      {.name = "seeds",
       .group = group,
       .help = "where particles on surfaces begin; auto: with the tree solver on the embedding, else at vertices of "
               "marching cubes",
       .value = &m.seeds,
       .choices = {"auto", "embedding", "marching-cubes"}},
      {.name = "particles",
       .group = group,
       .help = "seed this many on surfaces (junctions as usual) and add none; 0: as many as the sizing field asks for",
       .value = &m.particles,
       .min = 0,
       .max = largest_int},
      {.name = "max_cell",
       .group = "cells",
       .unit = "voxels",
       .help = "longest edge of the tetrahedra; 0: they grow with the distance from the surface",
       .value = &s.max_cell,
       .min = 0,
       .max = 1e6},
      {.name = "element_order",
       .group = "cells",
       .help = "2: triangles and tetrahedra with a node on each edge, those of interfaces curved; 1: straight",
       .value = &s.element_order,
       .min = 1,
       .max = 2,
       .old_names = {"order"}},
  };
}

}  // namespace

std::vector<Knob> mesh_knobs(Settings& settings) {
  std::vector<Knob> table = material_knobs(settings);
  for (const auto part : {field_knobs, particle_knobs, label_knobs})
    for (Knob& knob : part(settings)) table.push_back(std::move(knob));
  return table;
}

}  // namespace nacre
