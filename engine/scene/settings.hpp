// Nacre: everything about a run that can be turned.
#pragma once

#include <string>

#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// What becomes a material of a volume, as words; engine/scene/material_words.hpp turns them into what they mean.
struct MaterialWords {
  bool labels = false;    ///< the values are labels, whatever they look like
  std::string isovalue;   ///< V[,V...]
  std::string threshold;  ///< LO:HI
  std::string materials;  ///< L[,L...]: labels to keep; empty: all
  std::string merge;      ///< A:B[,A:B...]: label A becomes B
  int min_component = 0;  ///< drop pieces of fewer voxels
};

/// Values of all knobs; the defaults are the members' initial values. The table is in knobs.hpp.
struct Settings {
  FlowParameters flow;
  MeshParameters mesh;
  MaterialWords materials;
  double max_cell = 0;  ///< longest edge of tetrahedra, voxels; 0: they grow with the distance from the surface

  std::string vectors;  ///< array name or @field; empty: chosen
  double crease = 40;   ///< degrees
  std::string color = "speed";
  std::string colormap = "sea";
  std::string camera = "iso";      ///< a view or a JSON file
  double orbit = 0;                ///< degrees per frame
  int width = 1024, height = 768;  ///< of the picture
  int samples = 2;                 ///< rays per pixel and axis
  std::string background = "#ffffff";
  int fps = 25;
  bool legend = true, time_stamp = true;
};

}  // namespace nacre
