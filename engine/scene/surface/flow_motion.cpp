// Nacre: a flow on a surface that moves: when its shape is embedded again, and what is shown.
#include "engine/scene/surface/flow_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/material_map.hpp"

namespace nacre {
namespace {

constexpr double lost_share = 0.5;  // of the cells, above which a texture has not been carried but started over

}  // namespace

FlowMotion::FlowMotion(FlowPipeline& pipeline, VectorsInTime& input, std::function<void(const std::string&)> warn,
                       std::function<double(double)> wrap)
    : pipeline_(pipeline), input_(input), warn_(std::move(warn)), wrap_(std::move(wrap)) {}

void FlowMotion::embed(double t) {
  input_.enter(data_time(t));
  input_.rebase(data_time(t));
  cell_size_ = 0;
  pipeline_.embed(mesh());
  cell_size_ = pipeline_.flow().embedding().cell_size;
  longest_ = Extent(input_.surface().points, input_.surface().triangles).longest_side();
}

bool FlowMotion::start(const FlowVectors& vectors, const std::function<void()>& between) {
  const bool embed_again = input_.moves() && (input_.enter(data_time(vectors.start)) || is_stretched(vectors.start));
  if (embed_again) embed(vectors.start);
  vectors_ = vectors;
  pipeline_.flow().start(vectors, between);
  show();
  return embed_again;
}

void FlowMotion::go_on(const FlowVectors& vectors, double base, int rebuilds, int next, const TakeBytes& take,
                       const std::function<void()>& between) {
  if (rebuilds > 0) {
    input_.enter(base);
    input_.rebase(base);
    pipeline_.embed(mesh());
  }
  rebuilds_ = rebuilds;
  vectors_ = vectors;
  pipeline_.flow().go_on(vectors, next, take, between);
  show();
}

bool FlowMotion::follow() {
  if (!input_.moves()) return false;
  const double length = vectors_.end - vectors_.start;
  const double next = pipeline_.flow().time() + length / std::max(1, pipeline_.parameters.steps);
  const double t = std::min(next, vectors_.end);
  const bool other = input_.enter(data_time(t));
  if (!other && !is_stretched(t)) return false;
  input_.rebase(data_time(t));
  const double found = pipeline_.carry(mesh(), vectors_, other ? FlowCarry::closest_point : FlowCarry::material);
  ++rebuilds_;
  if (found < lost_share && warn_)
    warn_(
        fmt::format("at time {:.6g} the surface has jumped farther than the band around it: {:.0f}% of the texture "
                    "starts over",
                    data_time(t), 100 * (1 - found)));
  return true;
}

void FlowMotion::show() {
  if (!input_.moves()) return;
  StageTimers::Scope scope(pipeline_.timers(), "move");
  const double t = data_time(pipeline_.flow().time());
  const PreparedSurface shape = input_.shape(t);
  std::vector<Vec3f> vectors(shape.points.size());
  input_.vectors(t, vectors);
  pipeline_.flow().move({shape.points, shape.corner_normals, vectors});
}

bool FlowMotion::is_stretched(double t) {
  const PreparedSurface& embedded = input_.surface();
  return distorted_share(embedded.points, input_.points(data_time(t)), embedded.triangles, most_stretch) >
         stretched_share;
}

/// Texture cells stay as large as they were at first, within a factor of two of what the resolution means now: so the
/// texture is as fine everywhere in time.
FlowMesh FlowMotion::mesh() const {
  const PreparedSurface& surface = input_.surface();
  FlowMesh mesh = flow_mesh(surface, input_.share());
  mesh.moves = input_.moves();
  if (cell_size_ > 0) {
    const double growth = Extent(surface.points, surface.triangles).longest_side() / longest_;
    mesh.cell_size = cell_size_ * std::clamp(1.0, 0.5 * growth, 2 * growth);
  }
  return mesh;
}

}  // namespace nacre
