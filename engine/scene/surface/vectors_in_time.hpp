// Nacre: the vectors of a series at any time, for the flow pipeline.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// What is shown of the vectors of a surface that moves, and whether time comes round.
struct MotionChoice {
  bool relative = false;         ///< less the surface's own velocity
  std::string surface_velocity;  ///< an array that has it; empty: from the positions
  double period = 0;             ///< of the data's time; 0: it does not come round
  double crease_degrees = 40;    ///< for the normals of later shapes
  bool operator==(const MotionChoice&) const = default;
};

/// Whether a colour is this: "FTLE", in any case. These colours are computed from the vectors afterwards
/// (engine/run/flow_maps.hpp), and there are none until then, unless an array has that name.
bool is_ftle(const std::string& color);

/// Interpolates linearly between the two steps around a time, which it keeps; also a scalar array to colour by.
///
/// Where the series moves, `surface()` is one shape of the steps that have the same triangles as the present one (a
/// group): the shape that is embedded, whose triangles stand for the material. `points`, `shape` and `vectors` tell how
/// it is at a time, `material_vectors` what flows on it. Between two groups, the nearer step counts.
class VectorsInTime {
 public:
  /// `vectors`: an array of the series or an analytic field; `color`: an array, "speed", "none", or TAWSS, OSI or RRT
  /// (haemodynamics.hpp) of the vectors, where no array has that name. Looks at every step
  /// once for the reference speed and the range of the colours. Throws Error where an array is missing in a step.
  /// Interrupted where `stop` is set. `share`: the surface is what this process has of one; statistics and ranges are
  /// those of all, and this and `vectors` and `scalar` are collective. Numbers at points of others are 0.
  VectorsInTime(SurfaceSeries series, PreparedSurface surface, std::string vectors, std::string color,
                const std::atomic<bool>* stop = nullptr, MotionChoice motion = {},
                std::shared_ptr<const Share> share = nullptr);

  const Share* share() const { return share_.get(); }

  // Other choices, without reading again what they do not concern. Where one throws, all is as it was.

  /// The same points with other triangles or normals.
  void set_surface(PreparedSurface surface);
  void set_vectors(const std::string& vectors);
  void set_color(const std::string& color);
  void set_motion(const MotionChoice& motion);
  /// Colours by numbers that were computed from the vectors, one per point, the same at all times.
  void show_scalar(const std::string& name, std::vector<float> values);

  // Of a surface that moves.

  bool moves() const { return series_.motion != nullptr; }
  const MotionChoice& motion() const { return motion_; }
  /// Changes to the group of steps around `t`; true if it was another: then `surface()` has other triangles.
  bool enter(double t);
  /// Makes the shape at `t` that which is embedded.
  void rebase(double t);
  double base() const { return base_; }  ///< the time of that shape
  /// The points of `surface()` at a time.
  std::vector<Vec3d> points(double t);
  /// `surface()` with points and normals of a time.
  PreparedSurface shape(double t);
  /// The vectors at time `t`, as they are on `surface()`: what carries a texture that stays with the material.
  void material_vectors(double t, std::span<Vec3f> out);

  const SurfaceSeries& series() const { return series_; }
  const PreparedSurface& surface() const { return surface_; }
  const std::string& array() const { return vectors_; }  ///< the vectors' name
  const std::string& color() const { return color_; }
  double start() const { return start_; }
  double end() const { return end_; }

  /// Over all steps: the mean of the steps' 98th percentile, the largest speed, the smallest share of zeros; the share
  /// that is normal is the first step's. Relative vectors: the percentile is at least `least_relative_speed` of the
  /// surface's own, so that rounding is not shown as a flow.
  const VectorStatistics& statistics() const { return statistics_; }
  const ColourSpread& color_spread() const { return color_ == "speed" ? speeds_ : scalars_; }
  bool colored() const { return color_ != "none"; }
  /// Of a surface that moves: root mean square over its points and steps; 0 where it is not known.
  double surface_speed() const { return surface_speed_; }
  /// Relative vectors below this share of it are what the surface itself does, up to how well that is known.
  static constexpr double least_relative_speed = 0.01;

  /// One vector per point at time `t`.
  void vectors(double t, std::span<Vec3f> out);

  /// One number per point at time `t`: the array's (magnitude of vectors), or the tangential speed.
  std::vector<float> scalar(double t);

 private:
  struct Step {
    std::size_t number = ~std::size_t(0);
    std::vector<Vec3f> vectors, surface_velocity;
    std::vector<float> scalar;
    std::vector<Vec3d> points;  ///< of a series that moves
    std::uint64_t used = 0;     ///< later than that of all before
  };

  Step load(std::size_t number) const;
  const Step& step(std::size_t number);
  void survey(bool vectors_too = true);
  bool colours_by_array() const { return color_ != "speed" && color_ != "none" && !derived_; }
  float speed_of(const Vec3f& vector, std::size_t point) const;
  void choose(const std::string& vectors, const std::string& color);
  /// The steps around `t` and the share of the later one.
  struct Between {
    std::size_t before, after;
    float share;
  };
  Between around(double t) const;
  void check_period() const;
  double time_in_period(double t) const;
  void enter_group(std::size_t group);
  void begin_group(PreparedSurface surface);
  std::pair<std::size_t, std::size_t> beside(std::size_t step) const;
  void add_surface_velocity(const Between& at, float factor, std::span<Vec3f> out);
  std::vector<float> speeds(const PreparedSurface& shape, std::span<const Vec3f> vectors) const;
  void survey_motion(bool vectors_too);

  SurfaceSeries series_;
  PreparedSurface surface_;
  std::vector<Vec3f> point_normals_;
  std::string vectors_, color_;
  bool analytic_;
  bool derived_ = false;               ///< the colours were computed from the vectors, for all times
  std::vector<float> derived_scalar_;  ///< those numbers
  double start_, end_, base_;
  ColourSpread speeds_, scalars_;  ///< of the vectors; of the array that colours
  VectorStatistics statistics_;
  double surface_speed_ = 0;
  std::vector<Step> steps_;  ///< the last ones: two, four of a surface that moves
  std::uint64_t uses_ = 0;
  MotionChoice motion_;
  std::size_t group_ = 0, first_ = 0, last_ = 0;  ///< the present group and its steps
  std::vector<std::uint32_t> same_;               ///< first_at_position of its first shape
  PreparedSurface began_;                         ///< that shape, for analytic fields
  const std::atomic<bool>* stop_;
  std::shared_ptr<const Share> share_;  ///< null: the surface is whole
};

/// Mean corner normal of each point: what speed on the surface is measured against.
std::vector<Vec3f> point_normals(const PreparedSurface& surface);

inline constexpr std::size_t largest_sample = 1 << 16;  ///< about; of the values that percentiles are taken of

}  // namespace nacre
