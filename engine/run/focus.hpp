// Nacre: focus: a close-up is computed on the part of the surface in view, with cells as fine as the picture's pixels.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/camera.hpp"
#include "engine/scene/surface/surface_part.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// A picture that a flow is drawn into.
struct FlowView {
  Camera camera;
  int width = 1024, height = 768;

  bool operator==(const FlowView&) const = default;
};

struct Focus {
  SurfacePart part;              ///< what is in view, with a margin as wide as streaks and a step are long
  std::vector<HalfSpace> shown;  ///< what is in view, without it
  int resolution = 0;            ///< for FlowParameters, of the part
  int wanted = 0;                ///< the same, if the memory did not count
  double cell_size = 0;          ///< world units
  double pixel = 0;              ///< edge of a pixel where the surface is nearest, world units
};

/// Larger cells than this many pixels are seen as such.
inline constexpr double coarsest_cell = 1.5;

/// The resolution for a picture of the whole surface, where the knob leaves it open (`parameters.resolution` 0): cells
/// a little smaller than the pixels of the view, or of one that the surface fills where the view is nearer; or larger
/// ones where half of the memory (`available` bytes) or four cells a pixel would not do. Any other resolution is
/// returned as it is; below 16, Error.
int picture_resolution(const FlowView& view, const PreparedSurface& surface, const FlowParameters& parameters,
                       std::size_t available);
/// The same for the surface of `input`, which may be in shares; then it is collective.
int picture_resolution(const FlowView& view, const VectorsInTime& input, const FlowParameters& parameters,
                       std::size_t available);

/// Whether the view shows every triangle completely; of a surface in shares collective.
bool sees_all(const FlowView& view, const VectorsInTime& input);

/// Surface cells of a close-up, at most: in a picture, and in a window, where the user waits for it.
double picture_budget(const FlowView& view);
double window_budget(const FlowView& view);

/// The focus for a view; none where the whole surface is in view, nothing is, or where the whole's cells are fine
/// enough. Cells are a pixel, or larger where the memory (`available` bytes), the `budget` of surface cells, or
/// the limits of the method ask for it.
std::optional<Focus> focus_on(const FlowView& view, const PreparedSurface& whole, const FlowParameters& parameters,
                              std::size_t available, double budget);

/// The same view with `factor` times as much around its middle, in pixels of the same size.
FlowView widened(const FlowView& view, double factor);

/// Whether a focus (its `shown` and `cell_size`) does for another view, too: all that is seen of the surface lies in
/// it, and its cells are fine enough. Looks at some hundred pixels along either side of the picture.
bool serves(std::span<const HalfSpace> shown, double cell_size, const FlowView& view, const PreparedSurface& whole);

/// A sentence for the user where the memory makes a focus coarser; else empty.
std::string coarser_than_pixels(const Focus& focus);

/// Why a surface that moves has no focus: a sentence for the user.
inline constexpr const char* no_focus_where_it_moves =
    "the surface moves: a close-up is drawn with the texture of the whole; a larger resolution makes it sharper";

}  // namespace nacre
