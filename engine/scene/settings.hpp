// Nacre: everything about a run that can be turned.
#pragma once

#include <string>

#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// Values of all knobs; the defaults are the members' initial values. The table is in knobs.hpp.
struct Settings {
  FlowParameters flow;

  std::string method = "grid";
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
