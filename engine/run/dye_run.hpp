// Nacre: dye beside the texture of a run: carried from frame to frame, drawn, reported.
#pragma once

#include <atomic>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "compute/raycast/camera.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "compute/transport/dye.hpp"
#include "engine/picture/image.hpp"
#include "engine/run/dye_sources.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Dye by the knobs `dye`, `dye_release` and `dye_diffusion`, on the triangles of the data. `input` and `settings` must
/// outlive it.
class DyeRun {
 public:
  /// Puts the dye on the surface as it is at `start`. `steady_step`: the time of a step where vectors are steady.
  /// Throws Error for sources that there are not, where all vectors are zero and dye does not diffuse, and where
  /// the triangles change.
  DyeRun(VectorsInTime& input, const Settings& settings, double start, double steady_step,
         const std::atomic<bool>* stop);

  /// To the frame at a time of the data; steady vectors: by a step. Throws Error where it would be unstable.
  void go_to(double time);
  /// Blends the dye over a picture of the surface as it is then; its texture stays visible.
  void draw(Image& image, const Camera& camera) const;
  /// The concentration at points of the surface.
  std::vector<float> at(std::span<const Vec3d> points) const;
  /// The report's key `dye`.
  nlohmann::json report() const;

 private:
  void show(double time);
  void note();

  VectorsInTime& input_;
  const Settings& settings_;
  const std::atomic<bool>* stop_;
  double time_, steady_step_;
  bool steady_ = false;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> sources_;
  Dye dye_;
  TriangleTree tree_;  ///< the present shape
  std::vector<float> concentration_;
  struct Frame {
    double time, mass, released, left;
    int sub_steps;
  };
  std::vector<Frame> frames_;
  int sub_steps_ = 0;
};

}  // namespace nacre
