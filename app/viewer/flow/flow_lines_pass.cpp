// Nacre: draws lines and marks over a flow.
#include "app/viewer/flow/flow_lines_pass.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "engine/run/skeleton_marks.hpp"

namespace nacre {
namespace {

std::array<float, 3> encoded(const Rgba& c) { return {float(c.r) / 255, float(c.g) / 255, float(c.b) / 255}; }
std::array<float, 4> with_opacity(const Rgba& c) {
  const auto [r, g, b] = encoded(c);
  return {r, g, b, float(c.a) / 255};
}

MarkShape shape_of(CriticalKind kind) {
  switch (kind) {
    case CriticalKind::saddle: return MarkShape::diamond;
    case CriticalKind::focus_source:
    case CriticalKind::focus_sink: return MarkShape::ring;
    default: return MarkShape::disc;
  }
}

Buffer buffer_of(const std::vector<LineSegment>& segments) {
  return segments.empty() ? Buffer() : Buffer::of<LineSegment>(segments);
}

}  // namespace

void FlowLinesPass::set_lines(std::shared_ptr<const FlowLines> lines, const SurfaceBuffers& surface) {
  lines_ = std::move(lines);
  std::vector<LineSegment> streamlines, separation, attachment, attracting, repelling, with_flow, against_flow, past,
      later;
  std::vector<Mark> marks;
  if (lines_) {
    const auto in_model = [&](const Vec3d& p) { return Vec3f((p - surface.origin()) / surface.size()); };
    const auto add = [&](std::vector<LineSegment>& segments, const std::vector<Vec3d>& points) {
      for (std::size_t i = 1; i < points.size(); ++i)
        segments.push_back({in_model(points[i - 1]), in_model(points[i])});
    };
    for (const EvenLine& line : lines_->streamlines.lines) add(streamlines, line.points);
    for (const SurfaceLine& line : lines_->skeleton.separatrices)
      add(line.forward ? with_flow : against_flow, line.points);
    for (const SeparationLine& line : lines_->skeleton.separation)
      add(line.separation ? separation : attachment, line.points);
    for (const ClosedOrbit& orbit : lines_->skeleton.orbits)
      add(orbit.attracting ? attracting : repelling, orbit.points);
    if (lines_->tracks)
      for (const PointTrack& track : lines_->tracks->tracks)
        for (const TrackPart& part : parts_of(*lines_->tracks, track, lines_->time))
          add(part.past ? past : later, part.points);
    for (const CriticalPoint& point : lines_->skeleton.topology.points)
      marks.push_back({in_model(point.position), encoded(mark_colour(point.kind)), float(shape_of(point.kind))});
  }
  std::vector<LineSegment> separatrices = with_flow;
  separatrices.insert(separatrices.end(), against_flow.begin(), against_flow.end());
  streamlines_ = buffer_of(streamlines);
  std::vector<LineSegment> orbits = attracting;
  orbits.insert(orbits.end(), repelling.begin(), repelling.end());
  orbits_ = buffer_of(orbits);
  attracting_ = buffer_of(attracting);
  repelling_ = buffer_of(repelling);
  std::vector<LineSegment> tracks = past;
  tracks.insert(tracks.end(), later.begin(), later.end());
  tracks_ = buffer_of(tracks);
  past_ = buffer_of(past);
  later_ = buffer_of(later);
  separation_ = buffer_of(separation);
  attachment_ = buffer_of(attachment);
  separatrices_ = buffer_of(separatrices);
  with_flow_ = buffer_of(with_flow);
  against_flow_ = buffer_of(against_flow);
  mark_pass_.set_marks(marks);
}

void FlowLinesPass::draw(const View& view, const Placement& placement) const {
  if (!lines_) return;
  const float unit = std::max(0.5f, float(std::min(view.width, view.height)) / 768.0f);
  const auto draw_segments = [&](const Buffer& segments, const Rgba& colour, float width) {
    segment_pass_.draw(view, placement, segments, {with_opacity(colour), width * unit, false});
  };
  draw_segments(streamlines_, streamline_ink, 1.4f);
  draw_segments(tracks_, mark_outline, 3.8f);
  draw_segments(later_, later_track_colour, 2.2f);
  draw_segments(past_, track_colour, 2.2f);
  for (const Buffer* lines : {&separation_, &attachment_}) draw_segments(*lines, mark_outline, 3.8f);
  draw_segments(attachment_, attachment_colour, 2.4f);
  draw_segments(separation_, separation_colour, 2.4f);
  draw_segments(separatrices_, mark_outline, 3.2f);
  draw_segments(against_flow_, separatrix_against_flow, 1.8f);
  draw_segments(with_flow_, separatrix_with_flow, 1.8f);
  draw_segments(orbits_, mark_outline, 5.2f);
  draw_segments(attracting_, mark_colour(CriticalKind::sink), 3.6f);
  draw_segments(repelling_, mark_colour(CriticalKind::source), 3.6f);
  mark_pass_.draw(view, placement, 4.5f * unit, encoded(mark_outline));
}

}  // namespace nacre
