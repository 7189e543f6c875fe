// Nacre: junction points that were not found, where the curves that end there tell.
#include "compute/pipeline/missing_points.hpp"

#include <algorithm>

#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr double together = 1;     // sizes: so far apart are the last particles of curves that meet
constexpr double nearby = 1.5;     // sizes: so far from their middle may the point be,
constexpr double beside = 0.3;     // and so far at least from one that is known
constexpr double too_close = 0.5;  // sizes: nearer to the point no last particle stays

/// A curve's last particle.
struct End {
  std::uint32_t particle;
  Junction curve;
};

std::vector<End> list_ends(const StarParticles& particles, std::span<const CurveNode> nodes) {
  std::vector<End> ends;
  for (const CurveNode& node : nodes) {
    if (!node.is_broken() || particles.junction[node.particle].order() != 1) continue;
    ends.push_back({node.particle, particles.junction[node.particle]});
  }
  std::sort(ends.begin(), ends.end(), [](const End& s, const End& t) { return s.particle < t.particle; });
  return ends;
}

}  // namespace

std::vector<CurveMeeting> curve_meetings(const StarParticles& particles, std::span<const CurveNode> nodes,
                                         const JunctionTable& table) {
  const std::vector<End> ends = list_ends(particles, nodes);
  std::vector<CurveMeeting> meetings;
  std::vector<std::uint8_t> taken(ends.size(), 0);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (taken[i]) continue;
    const Vec3d here = particles.point(ends[i].particle);
    const double reach = together * particles.position[ends[i].particle].w;
    std::vector<std::size_t> best;
    CurveMeeting meeting;
    for (std::uint32_t k = 0; k < table.junctions.size(); ++k) {
      const Junction& point = table.junctions[k];
      if (point.order() != 0 || !point.bounds(ends[i].curve)) continue;
      std::vector<std::size_t> some = {i};
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        const bool is_new =
            std::none_of(some.begin(), some.end(), [&](std::size_t s) { return ends[s].curve == ends[j].curve; });
        if (!taken[j] && is_new && point.bounds(ends[j].curve) &&
            length(particles.point(ends[j].particle) - here) <= reach)
          some.push_back(j);
      }
      if (some.size() > best.size()) best = some, meeting.junction = k;
    }
    if (best.size() < 3) continue;
    for (const std::size_t j : best) {
      taken[j] = 1;
      meeting.ends.push_back(ends[j].particle);
      meeting.middle += particles.point(ends[j].particle) / double(best.size());
    }
    meetings.push_back(std::move(meeting));
  }
  return meetings;
}

StarInput star_input(MovableParticles& fields, const HostParticles& particles, const JunctionTable& table) {
  StarInput input;
  input.junction.resize(particles.count());
  const std::vector<std::uint32_t> on_rims = select_where(particles.count(), [&](std::size_t i) {
    input.junction[i] = table.junctions[particles.interface[i]];
    return input.junction[i].order() < 2;
  });
  std::vector<Vec3f> position;
  std::vector<Junction> junction;
  for (const std::uint32_t i : on_rims) {
    position.push_back({particles.position[i].x, particles.position[i].y, particles.position[i].z});
    junction.push_back(input.junction[i]);
  }
  const std::vector<JunctionGradients> gradient = fields.junction_gradients(position, junction);
  input.gradient.resize(particles.count());
  for (std::size_t k = 0; k < on_rims.size(); ++k) input.gradient[on_rims[k]] = gradient[k];
  return input;
}

std::size_t put_missing_points(MovableParticles& particles, const JunctionTable& table, const VolumeFrame& frame) {
  HostParticles host = particles.download();
  const StarInput input = star_input(particles, host, table);
  const StarParticles view = input.of(host);
  const std::vector<CurveMeeting> meetings = curve_meetings(view, link_curves(view), table);
  if (meetings.empty()) return 0;
  std::vector<Vec3d> from;
  std::vector<Junction> onto;
  for (const CurveMeeting& m : meetings) {
    from.push_back(frame.to_world(m.middle));
    onto.push_back(table.junctions[m.junction]);
  }
  const std::vector<Vec3d> on = particles.onto_junctions(from, onto, true);
  std::vector<Vec3d> known;
  for (std::size_t i = 0; i < host.count(); ++i)
    if (input.junction[i].order() == 0) known.push_back(view.point(i));
  std::vector<std::uint8_t> gone(host.count(), 0);
  const std::size_t before = known.size();
  for (std::size_t k = 0; k < meetings.size(); ++k) {
    if (!is_finite(on[k])) continue;
    const std::uint32_t first = meetings[k].ends[0];
    const double size = host.position[first].w;
    const Vec3d at = frame.to_voxels(on[k]);
    const auto is_here = [&](const Vec3d& p) { return length(p - at) < beside * size; };
    if (length(at - meetings[k].middle) > nearby * size || std::any_of(known.begin(), known.end(), is_here)) continue;
    for (const std::uint32_t i : meetings[k].ends)
      gone[i] = i != first && length(view.point(i) - at) < too_close * size;
    host.position[first] = {float(at.x), float(at.y), float(at.z), float(size)};
    host.direction[first] = {0, 0, 0, 0};
    host.interface[first] = meetings[k].junction;
    known.push_back(at);
  }
  replace_particles(host, gone, {}, table, frame, host.count());
  particles.upload(host);
  return known.size() - before;
}

}  // namespace nacre
