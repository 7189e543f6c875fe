// Nacre: frames of a flow as pictures, with legend, time stamp and axes.
#pragma once

#include <array>
#include <utility>

#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/picture/image.hpp"
#include "engine/run/dye_run.hpp"
#include "engine/run/flow_tracks.hpp"
#include "engine/run/shown_colours.hpp"
#include "engine/scene/session/session.hpp"
#include "engine/scene/surface/surface_part.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Draws frames of one run, without OpenGL, as the knobs of `session` say. Both references and `session` must outlive
/// it.
class FlowPainter {
 public:
  /// `frame_time`: of the data, from frame to frame. Throws Error for a camera or a colour that does not exist.
  FlowPainter(FlowPipeline& pipeline, VectorsInTime& input, const Session& session, double frame_time);

  const Camera& camera() const { return camera_; }  ///< of the first frame

  /// The pipeline works on this part of the surface only; it must outlive the painter.
  void show_part(const SurfacePart& part) { part_ = &part; }

  /// Blends it over the pictures; it must outlive the painter.
  void show_dye(const DyeRun& dye) { dye_ = &dye; }

  /// Draws them over the pictures.
  void show_tracks(FlowTracks tracks) { tracks_ = std::move(tracks); }

  /// The frame that is shown now; `frame` counts from 0, and turns the camera by the knob `orbit`.
  Image paint(int frame);

 private:
  FlowPipeline& pipeline_;
  VectorsInTime& input_;
  const Settings& settings_;
  double frame_time_;
  const Colormap& map_;
  const ShownColours colours_;
  Camera camera_;
  const SurfacePart* part_ = nullptr;
  const DyeRun* dye_ = nullptr;
  FlowTracks tracks_;
  std::array<float, 3> background_{1, 1, 1};
  bool transparent_ = false;
};

}  // namespace nacre
