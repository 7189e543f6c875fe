// Nacre: what is under the cursor on the surface of a flow.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/viewer/flow/flow_scene.hpp"

namespace nacre {
namespace {

/// The part of a ray that the planes leave; low > high: none of it.
Range kept_part(const ClipPlanes& clip, const Vec3d& from, const Vec3d& along) {
  Range part{0, std::numeric_limits<double>::infinity()};
  for (const ClipPlane& plane : clip.all()) {
    const double before = plane.offset - dot(plane.normal, from), rate = dot(plane.normal, along);
    if (rate > 0) part.low = std::max(part.low, before / rate);
    if (rate < 0) part.high = std::min(part.high, before / rate);
    if (rate == 0 && before > 0) part.high = -1;
  }
  return part;
}

}  // namespace

std::optional<ProbeResult> FlowScene::probe(const Vec3d& from, const Vec3d& along) {
  if (!results_.tree) return {};
  const Range part = kept_part(view_.clip, from, along);
  if (part.low > part.high) return {};
  const std::optional<TriangleHit> hit = results_.tree->first(from, along, part.low, part.high);
  if (!hit) return {};
  return ProbeResult{hit->position, describe(*hit)};
}

std::vector<std::string> FlowScene::describe(const TriangleHit& hit) {
  const Triangle& t = results_.tree->triangles()[hit.triangle];
  std::vector<std::string> lines{
      fmt::format("position: {:.5g} {:.5g} {:.5g}", hit.position.x, hit.position.y, hit.position.z),
      fmt::format("triangle: {}", hit.triangle)};
  if (vectors_) {
    const Vec3f v = interpolate<Vec3f>(*vectors_, t, hit.weights);
    lines.push_back(fmt::format("{}: {:.4g} {:.4g} {:.4g}", results_.data.array, v.x, v.y, v.z));
    lines.push_back(fmt::format("magnitude: {:.4g}", length(v)));
  }
  if (!scalar_.empty())
    lines.push_back(fmt::format("{}: {:.4g}", results_.data.color, interpolate<float>(scalar_, t, hit.weights)));
  lines.push_back("time: " + time_text(results_.time));
  if (!shown_ || looks_back_) return lines;
  // The texture's value lies on the device of compute: the worker looks it up between its steps.
  const double near = shown_->info.cell_size;
  if (!asked_ || asked_step_ != taken_ || length(*asked_ - hit.position) > 0.5 * near) {
    worker_.sample(hit.position);
    asked_ = hit.position;
    asked_step_ = taken_;
  }
  if (sampled_ && length(sampled_->position - hit.position) <= near)
    lines.push_back(fmt::format("texture: {:.2f}", sampled_->value));
  return lines;
}

}  // namespace nacre
