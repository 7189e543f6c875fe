// Nacre: dyes beside the texture of a run: carried from frame to frame, drawn, reported.
#pragma once

#include <atomic>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "compute/raycast/camera.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "compute/transport/dye.hpp"
#include "engine/picture/dye_colours.hpp"
#include "engine/picture/image.hpp"
#include "engine/run/dye_sources.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Time of the data in which the reference speed goes as far as the texture goes in a step, where vectors are steady.
double steady_dye_step(const VectorsInTime& input, const Settings& settings, double cell_size);

/// Dyes by the knobs `dye`, `dye_release`, `dye_diffusion` and `dye_regions`, on the triangles of the data. `input`
/// must outlive it.
class DyeRun {
 public:
  /// Puts the dyes on the surface as it is at `start`. `steady_step`: the time of a step where vectors are steady.
  /// Throws Error for sources and regions that there are not, where all vectors are zero and dye does not diffuse, and
  /// where the triangles change.
  DyeRun(VectorsInTime& input, const Settings& settings, double start, double steady_step,
         const std::atomic<bool>* stop);

  /// Takes other knobs over. Sources that were not there before are filled now, and dye that is on the surface stays.
  /// Throws Error as the constructor does; all is as before then.
  void set(const Settings& settings);
  /// To the frame at a time of the data; steady vectors: by a step. Throws Error where it would be unstable.
  void go_to(double time);
  /// The data come round: what is on the surface now is there at this time.
  void come_round(double time) { time_ = time; }

  /// Blends the dyes over a picture of the surface as it is then; its texture stays visible.
  void draw(Image& image, const Camera& camera) const;
  /// Concentrations at points of the surface, an array for each dye: `dye`, `dye_2` and so on.
  std::vector<PointArray> at(std::span<const Vec3d> points) const;
  /// Concentrations at the points of the file.
  std::vector<DyeMix> mixes() const;
  double time() const { return time_; }

  void note();  ///< the masses of this time, for the report
  /// The report's key `dye`.
  nlohmann::json report() const;

 private:
  struct Frame {
    double time, mass, released, left;
    int sub_steps;
    std::map<int, double> regions;
  };
  struct OneDye {
    std::string text;  ///< its sources, as the knob has them
    std::vector<DyeSource> parts;
    std::vector<std::uint32_t> sources;  ///< points
    Dye dye;
    std::vector<float> concentration;
    std::vector<Frame> frames;
    int sub_steps = 0;
  };

  void check(const Settings& settings) const;
  void find_regions(const std::string& array);
  void show();

  VectorsInTime& input_;
  const std::atomic<bool>* stop_;
  double time_, steady_step_;
  bool steady_ = false;
  DyeRelease release_ = DyeRelease::once;
  std::vector<Triangle> triangles_;    ///< of welded points
  std::vector<std::uint32_t> welded_;  ///< of each point of the file
  std::vector<OneDye> dyes_;
  std::vector<int> region_;  ///< of each welded point; empty: none are wanted
  TriangleTree tree_;        ///< the present shape
  bool has_tree_ = false;
};

}  // namespace nacre
