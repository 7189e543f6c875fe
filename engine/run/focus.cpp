// Nacre: focus: which part of a surface is in view, and how fine its cells must be.
#include "engine/run/focus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "compute/device/among_all.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/flow_input.hpp"

namespace nacre {
namespace {

constexpr int least_resolution = 16;
constexpr int finest_grid = 12000;  // cells along an axis that the two-level grid can number
constexpr int finest_octree = 1 << 20;
constexpr double picture_cells = 4;        // for each pixel, at most: hidden sheets and slanted ones count, too
constexpr double window_cells = 5e5;       // what two cores make in a second
constexpr double cells_along_pixel = 1.1;  // where a whole surface fills the picture
constexpr double nearest = 1e-3;           // of the distance to the target: what is nearer to the eye is not drawn

/// The view's axes, and where points lie in its picture.
class Projection {
 public:
  explicit Projection(const FlowView& view)
      : view_(view),
        forward_(view.camera.forward()),
        right_(view.camera.right()),
        up_(cross(right_, forward_)),
        distance_(length(view.camera.target - view.camera.eye)) {}

  double distance() const { return distance_; }
  double depth(const Vec3d& p) const { return dot(p - view_.camera.eye, forward_); }
  /// Edge of a pixel at a depth.
  double pixel(double depth) const {
    const double at_target = view_.camera.height / view_.height;
    return view_.camera.orthographic ? at_target : at_target * depth / distance_;
  }
  /// In pixels from the upper left corner; the depth behind it.
  Vec3d operator()(const Vec3d& p) const {
    const Vec3d v = p - view_.camera.eye;
    const double z = depth(p), edge = pixel(z);
    return {0.5 * view_.width + dot(v, right_) / edge, 0.5 * view_.height - dot(v, up_) / edge, z};
  }

  /// The point at a depth that a pixel shows.
  Vec3d position(double x, double y, double depth) const {
    const double edge = pixel(depth);
    return view_.camera.eye + forward_ * depth + right_ * ((x - 0.5 * view_.width) * edge) +
           up_ * ((0.5 * view_.height - y) * edge);
  }

  /// What the picture shows, `margin` wider on all sides.
  std::vector<HalfSpace> sides(double margin) const {
    const double half_height = 0.5 * view_.camera.height, half_width = half_height * view_.width / view_.height;
    std::vector<HalfSpace> sides;
    for (const auto& [axis, half] : {std::pair{right_, half_width}, {up_, half_height}})
      for (const double sign : {-1.0, 1.0}) {
        Vec3d normal = axis * sign;
        if (!view_.camera.orthographic) normal = normalized(normal * distance_ - forward_ * half);
        const double offset = dot(normal, view_.camera.eye) + (view_.camera.orthographic ? half : 0.0);
        sides.push_back({normal, offset + margin});
      }
    if (!view_.camera.orthographic)
      sides.push_back({-forward_, dot(-forward_, view_.camera.eye) - nearest * distance_});
    return sides;
  }

  /// Nothing deeper than `depth`.
  HalfSpace no_deeper(double depth) const { return {forward_, dot(forward_, view_.camera.eye) + depth}; }

 private:
  FlowView view_;
  Vec3d forward_, right_, up_;
  double distance_;
};

struct Depths {
  double nearest, farthest;
};

constexpr double rounding = 1e-9;
constexpr float nothing = std::numeric_limits<float>::infinity();

/// The depth that each pixel shows, or `nothing`.
std::vector<float> depth_buffer(const Projection& project, const FlowView& view, const PreparedSurface& surface) {
  std::vector<float> buffer(std::size_t(view.width) * view.height, nothing);
  for (const Triangle& t : surface.triangles) {
    const Vec3d a = project(surface.points[t.a]), b = project(surface.points[t.b]), c = project(surface.points[t.c]);
    const double twice_area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (twice_area == 0) continue;
    const auto first = [](double low, int end) { return std::clamp(int(std::ceil(low - 0.5)), 0, end); };
    const int x0 = first(std::min({a.x, b.x, c.x}), view.width), y0 = first(std::min({a.y, b.y, c.y}), view.height);
    const int x1 = first(std::max({a.x, b.x, c.x}), view.width), y1 = first(std::max({a.y, b.y, c.y}), view.height);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / twice_area;
        const double v = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / twice_area;
        if (u < -rounding || v < -rounding || u + v > 1 + rounding) continue;  // no hole between two triangles
        // Exact with parallel rays; else between the corners' depths, which is enough for a bound.
        const auto z = float(std::max(a.z + u * (b.z - a.z) + v * (c.z - a.z), std::min({a.z, b.z, c.z})));
        float& nearest_here = buffer[std::size_t(y) * view.width + x];
        nearest_here = std::min(nearest_here, z);
      }
  }
  return buffer;
}

/// The depths that are seen. None: no pixel shows the surface.
std::optional<Depths> visible_depths(std::vector<float> buffer) {
  std::erase(buffer, nothing);
  if (buffer.empty()) return {};
  // One pixel in a hundred may be nearer: a spike towards the eye does not decide how fine all cells are.
  const auto hundredth = buffer.begin() + std::ptrdiff_t(buffer.size() / 100);
  std::nth_element(buffer.begin(), hundredth, buffer.end());
  return Depths{*hundredth, *std::max_element(buffer.begin(), buffer.end())};
}

double area_of(const PreparedSurface& surface) {
  double twice = 0;
  for (const Triangle& t : surface.triangles) {
    const Vec3d& a = surface.points[t.a];
    twice += length(cross(surface.points[t.b] - a, surface.points[t.c] - a));
  }
  return 0.5 * twice;
}

/// Along an axis, that the method can number.
int most_cells(const FlowParameters& parameters) {
  return parameters.method == EmbeddingKind::grid ? finest_grid : finest_octree;
}

/// The finest resolution, at most `wanted`, that the method can number and the memory holds; 0: none does.
int affordable(const FlowMesh& mesh, const MeshMeasure& measure, FlowParameters parameters, double wanted,
               double available) {
  const bool grid = parameters.method == EmbeddingKind::grid;
  parameters.resolution = int(std::min<double>(wanted, most_cells(parameters)));
  while (parameters.resolution >= least_resolution) {
    const double bytes =
        grid ? estimate_flow_bytes(mesh, parameters) : estimate_octree_bytes(measure, mesh, parameters);
    if (bytes <= available) return parameters.resolution;
    parameters.resolution = parameters.resolution * 15 / 16;
  }
  return 0;
}

/// `corners`: what decides on a camera in the direction of the view's.
int resolution_for(const FlowView& view, const FlowMesh& mesh, const MeshMeasure& measure,
                   std::span<const Vec3d> corners, const FlowParameters& parameters, std::size_t available) {
  const Camera fitted = fit_camera(view.camera, corners, view.width, view.height);
  const Vec3d side = measure.triangles > 0 ? measure.upper - measure.lower : Vec3d{};
  const double longest = std::max({side.x, side.y, side.z}), pixels = double(view.width) * view.height;
  const double cell = std::max(std::max(fitted.height, view.camera.height) / view.height / cells_along_pixel,
                               std::sqrt(measure.area / (picture_cells * pixels)));
  if (!(longest > 0) || !(cell > 0)) return least_resolution;
  return std::max(least_resolution,
                  affordable(mesh, measure, parameters, std::ceil(longest / cell), 0.5 * double(available)));
}

/// What the knob says; 0: nothing.
int asked_resolution(const FlowParameters& parameters) {
  if (parameters.resolution > 0 && parameters.resolution < least_resolution)
    throw Error("`resolution` " + std::to_string(parameters.resolution) + " is too coarse", "",
                "use " + std::to_string(least_resolution) + " or more, or 0");
  return std::max(0, parameters.resolution);
}

}  // namespace

int picture_resolution(const FlowView& view, const PreparedSurface& surface, const FlowParameters& parameters,
                       std::size_t available) {
  if (const int asked = asked_resolution(parameters); asked > 0) return asked;
  const FlowMesh mesh = flow_mesh(surface);
  return resolution_for(view, mesh, measure_mesh(mesh), triangle_corners(surface), parameters, available);
}

int picture_resolution(const FlowView& view, const VectorsInTime& input, const FlowParameters& parameters,
                       std::size_t available) {
  if (!input.share()) return picture_resolution(view, input.surface(), parameters, available);
  if (const int asked = asked_resolution(parameters); asked > 0) return asked;
  const FlowMesh mesh = flow_mesh(input.surface(), input.share());
  const std::vector<Vec3d> corners = outermost_corners(input, {&view.camera, 1});
  return resolution_for(view, mesh, measure_mesh(mesh, input.share()->ranks), corners, parameters, available);
}

bool sees_all(const FlowView& view, const VectorsInTime& input) {
  const std::vector<HalfSpace> sides = Projection(view).sides(0);
  std::uint64_t beyond = 0;
  for (const Triangle& t : own_triangles(input.surface(), input.share()))
    for (int k = 0; k < 3; ++k)
      for (const HalfSpace& side : sides) beyond += dot(side.normal, input.surface().points[t[k]]) - side.offset > 0;
  return sum_of_all(input.share() ? input.share()->ranks : nullptr, beyond) == 0;
}

double picture_budget(const FlowView& view) { return picture_cells * view.width * view.height; }

double window_budget(const FlowView& view) {
  return std::min(picture_budget(view), std::max(window_cells, 0.6 * view.width * view.height));
}

std::optional<Focus> focus_on(const FlowView& view, const PreparedSurface& whole, const FlowParameters& parameters,
                              std::size_t available, double budget) {
  const Projection project(view);
  const double coarse = Extent(whole.points, whole.triangles).longest_side() / parameters.resolution;
  if (!(coarse > 0) || !(project.distance() > 0) || !(view.camera.height > 0)) return {};
  const SurfacePart seen = cut_surface(whole, project.sides(0));
  if (seen.whole_triangles == whole.triangles.size()) return {};  // all of it
  const std::optional<Depths> depths = visible_depths(depth_buffer(project, view, seen.surface));
  if (!depths) return {};

  Focus focus;
  focus.pixel = project.pixel(depths->nearest);
  if (coarse <= coarsest_cell * focus.pixel) return {};
  // What flows into the picture begins outside of it, and streaks read what lies beside it; a pattern ends at the rim.
  const bool streaks = parameters.texture == FlowTexture::streaks;
  const double cells_beside = streaks ? parameters.streaks + 2 * parameters.step_cells : 2 * parameters.pattern_spacing;
  double cell = focus.pixel;
  for (int attempt = 0; attempt < 2; ++attempt) {  // a coarser cell needs a wider margin
    std::vector<HalfSpace> inside = project.sides(cells_beside * cell);
    inside.push_back(project.no_deeper(depths->farthest + cells_beside * cell));
    focus.part = cut_surface(whole, inside);
    focus.shown = project.sides(0);
    focus.shown.push_back(inside.back());
    cell = std::max(cell, std::sqrt(area_of(focus.part.surface) / budget));
  }
  const double longest = Extent(focus.part.surface.points, focus.part.surface.triangles).longest_side();
  if (!(longest > 0)) return {};
  focus.wanted = int(std::min<double>(std::ceil(longest / cell), most_cells(parameters)));
  const FlowMesh mesh = flow_mesh(focus.part.surface);
  focus.resolution = affordable(mesh, measure_mesh(mesh), parameters, focus.wanted, double(available));
  if (focus.resolution == 0) return {};
  focus.cell_size = longest / focus.resolution;
  if (focus.cell_size * coarsest_cell > coarse) return {};  // no finer than the whole
  return focus;
}

FlowView widened(const FlowView& view, double factor) {
  FlowView wide = view;
  wide.width = int(std::lround(view.width * factor));
  wide.height = int(std::lround(view.height * factor));
  wide.camera.height = view.camera.height * wide.height / view.height;
  return wide;
}

bool serves(std::span<const HalfSpace> shown, double cell_size, const FlowView& view, const PreparedSurface& whole) {
  constexpr int along = 200;  // pixels looked at, along the longer side
  FlowView coarse = view;
  const double scale = double(along) / std::max(view.width, view.height);
  coarse.width = std::max(1, int(view.width * scale));
  coarse.height = std::max(1, int(view.height * scale));
  const Projection project(coarse);
  const std::vector<float> buffer = depth_buffer(project, coarse, cut_surface(whole, project.sides(0)).surface);
  const std::optional<Depths> depths = visible_depths(buffer);
  if (!depths) return true;  // nothing is seen
  if (cell_size > coarsest_cell * Projection(view).pixel(depths->nearest)) return false;
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      const float depth = buffer[std::size_t(y) * coarse.width + x];
      if (depth == nothing) continue;
      const Vec3d p = project.position(x + 0.5, y + 0.5, depth);
      for (const HalfSpace& side : shown)
        if (dot(side.normal, p) > side.offset) return false;
    }
  return true;
}

std::string coarser_than_pixels(const Focus& focus) {
  if (focus.resolution >= focus.wanted) return {};
  return fmt::format("the memory holds {} of the {} cells along a close-up that its pixels ask for: it is coarser",
                     focus.resolution, focus.wanted);
}

}  // namespace nacre
