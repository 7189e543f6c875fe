// Nacre: a surface with vectors over time, ready for the flow pipeline: the same for commands and viewer.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/camera.hpp"
#include "engine/scene/settings/settings.hpp"
#include "engine/scene/surface/surface.hpp"
#include "engine/scene/surface/surface_part.hpp"
#include "engine/scene/surface/surface_share.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// Receives what a user should know, in the order in which it is found; full sentences.
struct FlowLog {
  std::function<void(const std::string& sentence)> warn;
  std::function<void(const VectorChoice& choice)> chosen;      ///< which vectors, and why
  std::function<void(const std::string& sentence)> note = {};  ///< what was decided; empty: to `warn`
  std::function<void(const Surface& first)> read = {};  ///< the first step, before a choice is made; may be empty
  /// The first step alone, as it can be shown before the others are read: its own statistics and range of colours.
  /// Not called if there is only one; may be empty.
  std::function<void(VectorsInTime& first)> first_step = {};
};

/// Prepares the surface of `series`, chooses vectors and reads all steps. Throws Error where there is nothing to
/// show, Interrupted when `stop` is set.
VectorsInTime make_flow_input(SurfaceSeries series, const Settings& settings, const FlowLog& log,
                              const std::atomic<bool>* stop = nullptr);

/// The same of a surface that processes have in shares; none, and a sentence in `why`, where it has to be whole.
/// Collective.
std::optional<VectorsInTime> make_flow_input(SharedSeries shared, Ranks& ranks, const Settings& settings,
                                             const FlowLog& log, std::string& why,
                                             const std::atomic<bool>* stop = nullptr);

/// By the knobs `relative`, `surface_velocity`, `period` and `crease_angle`; tells the log what is decided. Velocities
/// are taken relative to a surface whose own velocity is known, wall shear stress never is, other vectors only where
/// that is asked for. Throws Error where it is and no velocity is known.
MotionChoice choose_motion(const SurfaceSeries& series, const Surface& first, const std::string& vectors,
                           const Settings& settings, const FlowLog& log);

/// Warns where the vectors show little: all zero, mostly normal to the surface, zero over much of it.
void warn_of_vectors(const VectorsInTime& vectors, const Settings& settings, const FlowLog& log);

/// A prepared surface as the flow pipeline takes it; the surface must outlive it. `share`: of a surface in shares.
inline FlowMesh flow_mesh(const PreparedSurface& surface, const Share* share = nullptr) {
  if (!share) return {surface.points, surface.triangles, surface.corner_normals, surface.second_sheet};
  const std::span<const Vec3f> normals(surface.corner_normals);
  FlowMesh mesh{surface.points, own_triangles(surface, share),
                normals.subspan(3 * share->first_triangle, 3 * share->triangles)};
  mesh.shared = true;
  return mesh;
}

/// The vectors of `input` between two times of the data, as the flow pipeline takes them: on the whole surface or, if
/// `part` is given, on that. Both must outlive them. Where nothing moves, the reference speed is 1.
FlowVectors flow_vectors(VectorsInTime& input, double start, double end, const SurfacePart* part = nullptr);

/// What a camera must see of all steps: `triangle_corners`, and the corners of the boxes around later shapes. Of a
/// surface in shares, what decides on the views that have names; collective.
std::vector<Vec3d> corners_of_all_steps(const VectorsInTime& input);

/// Of a surface in shares, those corners of triangles that decide what `fit_camera` gives for the directions of these
/// cameras. Collective.
std::vector<Vec3d> outermost_corners(const VectorsInTime& input, std::span<const Camera> cameras);

/// The corners of all triangles, one after the other: what a camera must see. Points that no triangle uses do not
/// count.
std::vector<Vec3d> triangle_corners(const PreparedSurface& surface);

}  // namespace nacre
