// Nacre: unsteady flow on a surface as a moving texture.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "export.hpp"
#include "knobs.hpp"
#include "run.hpp"

namespace nacre {

/// A triangulated surface with vectors at some times; between two times they are interpolated linearly.
struct SurfaceFlow {
  std::vector<std::array<double, 3>> points;            ///< world coordinates
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corners; bad ones are dropped with a warning
  std::vector<double> times{0};                         ///< ascending; one: steady flow
  /// Of a surface that moves: writes its points at `times[step]`, 3 numbers each, called as `vectors` is; `points` are
  /// not used then. Velocities are shown relative to the surface as the knob `relative` says. Null: it stands still.
  std::function<void(std::size_t step, std::span<double> points)> positions;
  /// Writes the vectors at `times[step]`, 3 numbers per point, in world units per unit of time. It may be called more
  /// than once for a step and by any thread, but by one at a time. What it throws ends the run.
  std::function<void(std::size_t step, std::span<float> vectors)> vectors;
  /// Numbers to colour by, one per point, for the name in the knob `color`; null: only "speed" and "none" are there.
  std::function<void(const std::string& name, std::size_t step, std::span<float> numbers)> scalars;
  std::vector<std::string> scalar_names;
  std::string name = "surface";         ///< for messages and the report
  std::string vector_name = "vectors";  ///< the title of the legend
};

/// RGBA, 8 bits a channel, sRGB, row 0 at the top.
struct FlowPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
  std::string origin;  ///< how it came about, a line that `save` writes into the file; may be empty
};

/// The view of a picture, world coordinates. `height` is the visible height at the target.
struct CameraView {
  std::array<double, 3> eye{}, target{}, up{0, 0, 1};
  double height = 1;
  bool orthographic = false;
};

/// How a picture differs from what the knobs say.
struct PictureOptions {
  std::optional<std::string> view;  ///< "iso", "+x", "-x", "+y", "-y", "+z" or "-z"
  std::optional<CameraView> camera;
  std::optional<int> width, height;  ///< pixels
};

/// One entry per surface cell, world coordinates. Of several processes each has its own; one after the other, in the
/// order of the processes, they are those of the whole surface.
struct FlowCells {
  std::vector<std::array<double, 3>> centre, closest_point;
  std::vector<float> value;                            ///< of the texture, 0..1
  std::vector<std::array<float, 3>> velocity, normal;  ///< tangential vector at the time of the frame; unit normal
};

/// A flow run. `step` makes the next frame; the texture is made when it is first needed. A run belongs to one thread at
/// a time. Every call throws Error for bad input and too little memory, and Interrupted when RunOptions::stop is set.
/// Where RunOptions::processes are several, `method` has to be "octree", and all of them call the same members: they
/// get the same pictures and samples, and cells each its own.
class NACRE_API Flow {
 public:
  explicit Flow(SurfaceFlow surface, const KnobValues& knobs = {}, RunOptions options = {});
  ~Flow();
  Flow(Flow&&) noexcept;
  Flow& operator=(Flow&&) noexcept;

  int frames() const;  ///< of the whole run: the knob `steps`, less what `begin_at` skips
  int frame() const;   ///< those that were made
  /// Makes the next frame; false where all were made.
  bool step();
  double time() const;  ///< of the data, at the frame that is shown

  /// Changes a knob. Those of pictures and of the filters concern the frame that is next made or drawn. With those of
  /// the embedding, `ttl`, `warmup` and `seed`, a new texture is made at the time that was reached. Which data are
  /// shown and in how many steps cannot be changed.
  void set(const std::string& knob, const KnobValue& value);
  KnobValue get(const std::string& knob) const;

  /// The frame that was made last, with legend and time as the knobs say: what the program writes as a picture.
  FlowPicture picture(const PictureOptions& options = {});
  FlowCells cells() const;
  /// Shown values at points of the surface, 0..1; `points` in world coordinates.
  std::vector<float> sample(std::span<const std::array<double, 3>> points);
  /// Writes `cells` as .vtp, one point per surface cell, and how they came about: of all processes, by the first. As
  /// .pvtp, each process writes its own beside that list.
  void save(const std::filesystem::path& file) const;

  /// Version, device, knobs, input and timings, as JSON: what the program writes as its report.
  std::string report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes a picture as PNG. Throws Error.
NACRE_API void save(const std::filesystem::path& file, const FlowPicture& picture);

}  // namespace nacre
