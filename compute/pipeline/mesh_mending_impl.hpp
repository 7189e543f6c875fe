// Nacre: the part of the mesh pipeline that makes triangles of the particles, and moves, takes and adds these for their sake.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "compute/pipeline/mesh_pipeline_impl.hpp"

namespace nacre {

inline constexpr int most_further = 4;  ///< rounds of an attempt after its first

/// How an attempt changes what is around bad points.
struct AttemptWay {
  int turns;    ///< of smoothing; 0: none
  bool shakes;  ///< they begin at random places
  bool mends;   ///< particles that spoil triangles go, others come
};
/// One after the other: as it is done at first; by less, where that made particles flip to and fro; without moving others;
/// from elsewhere.
inline constexpr std::array<AttemptWay, 4> attempt_ways{
    {{6, false, true}, {2, false, false}, {0, false, true}, {6, true, true}}};

template <class Backend>
auto MeshPipelineOf<Backend>::triangulate_once(Delaunay& delaunay) -> Triangulated {
  auto stage = exec_.stage("triangulate");
  const std::vector<Vec3d> points = particle_places();
  const DelaunayCells cells = delaunay.cells(points, stop_);
  std::vector<std::uint16_t> label = material_at(cells.circumcentres);
  Triangulated made;
  made.repair = repair_labels(points, cells, label, stop_);
  made.mesh = extract_interfaces(points, cells, label, &made.point_of);
  check_stop(stop_);
  made.fitness = -double(made.repair.places.size());
  if (made.repair.places.empty()) made.fitness = fitness(made.mesh, point_facts(made).order, worst_defects);
  return made;
}

/// World coordinates.
template <class Backend>
std::vector<Vec3d> MeshPipelineOf<Backend>::particle_places() const {
  const ParticleSet& set = solver_->particles();
  std::vector<Vec3d> points;
  points.reserve(std::size_t(set.count));
  for (const Float4& p : set.place.download(0, std::size_t(set.count)))
    points.push_back(frame_.to_world(Vec3d(p.x, p.y, p.z)));
  return points;
}

/// Triangulates the particles, and changes them for better triangles until none is to be had: first the clear defects go,
/// then all particles move within their triangles, at last those alone at bad ones. Of these last meshes the best counts.
template <class Backend>
SurfaceMesh MeshPipelineOf<Backend>::triangulate() {
  if (!solver_) throw Error("no particles");
  finish_relaxing();
  begin_unmended();
  Delaunay delaunay(exec_.device().threads());
  MeshRounds rounds;
  Triangulated made;
  std::optional<Triangulated> best;
  HostParticles best_particles;
  for (bool again = true; again;) {
    tell("triangulate", improve_fraction(rounds));
    made = triangulate_once(delaunay);
    if (rounds.attempt) {
      if (go_on(rounds, made)) continue;
      if (take_back(rounds)) made = triangulate_once(delaunay);
    }
    if (rounds.smoothed >= parameters.smooth && !(best && made.fitness < best->fitness)) {
      best = made;
      best_particles = download_particles();
    }
    again = improve(rounds, made);
  }
  upload_particles(best_particles);
  info_.final = std::int64_t(best_particles.interface.size());
  std::int64_t of_order[3] = {};
  for (const std::uint32_t k : best_particles.interface) ++of_order[junctions_[k].order()];
  info_.points_final = of_order[0], info_.curves_final = of_order[1], info_.surfaces_final = of_order[2];
  return std::move(best->mesh);
}

/// The first mesh after `relax` is made of what it left, and so are all others: mending has changed the particles since.
template <class Backend>
void MeshPipelineOf<Backend>::begin_unmended() {
  if (relaxed_)
    upload_particles(*relaxed_);
  else
    relaxed_ = download_particles();
}

/// Changes the particles before they are triangulated again; false where there is nothing to change.
template <class Backend>
bool MeshPipelineOf<Backend>::improve(MeshRounds& rounds, Triangulated& made) {
  if (rounds.smoothed + rounds.mended == 0 && parameters.mend > 0) {
    ++rounds.mended;
    if (mend(made, DefectRule())) return true;
  }
  if (rounds.smoothed < parameters.smooth) {
    ++rounds.smoothed;
    smooth(rounds, made, std::vector<std::uint8_t>(made.mesh.points.size(), 1));
    if (rounds.smoothed == parameters.smooth && parameters.mend > 0) mend(made, worst_defects);
    return true;
  }
  const std::vector<std::uint8_t> bad = bad_points(made);
  const std::int64_t count = std::count(bad.begin(), bad.end(), 1);
  const bool worth = made.fitness < 1 || (count > 0 && 4 * count < 3 * rounds.bad);
  if (rounds.mended >= parameters.mend || !worth) return false;
  ++rounds.mended;
  rounds.bad = count;
  return attempt(rounds, made, bad);
}

/// Changes what is around the points `bad`, each time in the next of the ways. False where none changes anything.
template <class Backend>
bool MeshPipelineOf<Backend>::attempt(MeshRounds& rounds, Triangulated& made, std::span<const std::uint8_t> bad) {
  rounds.before = download_particles();
  const PointFacts facts = point_facts(made);
  const auto touching = touching_points(made);
  rounds.attempt.emplace(rounds.before.interface.size(), Attempt::View{made.mesh, made.point_of, facts.order, touching},
                         bad, worst_defects);
  rounds.further = 0;
  for (std::size_t tried = 0; tried < attempt_ways.size(); ++tried) {
    const std::uint32_t number = std::uint32_t(rounds.attempts++);
    const AttemptWay& way = attempt_ways[number % attempt_ways.size()];
    const bool moves = way.turns > 0 && parameters.smooth > 0;
    const bool moved = moves && smooth(rounds, made, bad, {way.turns, way.shakes ? number : 0}) > 0;
    const bool mended = way.mends && mend(made, worst_defects, &*rounds.attempt);
    if (moved || mended) return true;
  }
  rounds.attempt.reset();
  return false;
}

/// Goes on with an attempt where triangles have become no better: it may take more steps than one. False where it has ended.
template <class Backend>
bool MeshPipelineOf<Backend>::go_on(MeshRounds& rounds, Triangulated& made) {
  const PointFacts facts = point_facts(made);
  const auto touching = touching_points(made);
  const Attempt::View view{made.mesh, made.point_of, facts.order, touching};
  rounds.attempt->judge(view);
  const std::vector<std::uint8_t> open = rounds.attempt->open(view);
  if (open.empty() || rounds.further == most_further || rounds.mended >= parameters.mend) return false;
  ++rounds.further, ++rounds.mended;
  std::vector<std::uint8_t> moving = bad_points(made);
  for (std::size_t v = 0; v < moving.size(); ++v) moving[v] &= open[v];
  const bool moved = parameters.smooth > 0 && smooth(rounds, made, moving) > 0;
  return mend(made, worst_defects, &*rounds.attempt, open) || moved;
}

/// Ends an attempt: particles go back to where they were before, in those patches whose triangles are no better since. True
/// where there are some.
template <class Backend>
bool MeshPipelineOf<Backend>::take_back(MeshRounds& rounds) {
  const std::vector<Attempt::Source> sources = rounds.attempt->taken_back();
  rounds.attempt.reset();
  if (sources.empty()) return false;
  const HostParticles now = download_particles();
  HostParticles mixed;
  for (const auto& [before, i] : sources) {
    const HostParticles& from = before ? rounds.before : now;
    mixed.place.push_back(from.place[i]);
    mixed.direction.push_back(from.direction[i]);
    mixed.interface.push_back(from.interface[i]);
  }
  upload_particles(mixed);
  return true;
}

/// Marks the points of the mesh at triangles that are worth further work, and where it touches itself.
template <class Backend>
std::vector<std::uint8_t> MeshPipelineOf<Backend>::bad_points(const Triangulated& made) const {
  std::vector<std::uint8_t> bad = points_at_triangles_under(wanted_ratio, made.mesh);
  for (const auto& place : touching_points(made))
    for (const std::uint32_t point : place) bad[point] = 1;
  return bad;
}

/// Moves the particles at points `moving` of the mesh to where their triangles are best, and the mesh's points with them.
/// How many have moved by more than a hundredth of their size.
template <class Backend>
std::int64_t MeshPipelineOf<Backend>::smooth(const MeshRounds& rounds, Triangulated& made,
                                             std::span<const std::uint8_t> moving, SmoothingRule rule) {
  ParticleSet& set = solver_->particles();
  const std::size_t count = std::size_t(set.count);
  const TriangleRings ring = [&] {
    auto stage = exec_.stage("smooth");
    return triangle_rings(made.mesh, made.point_of, moving, count);
  }();
  const std::vector<Float4> before = set.place.download(0, count);
  Arena::Scope scope(exec_.arena());
  Arena& arena = exec_.arena();
  Array<std::uint32_t> first = arena.temporary<std::uint32_t>(ring.first.size());
  Array<RingEdge> edge = arena.temporary<RingEdge>(ring.edge.size());
  Array<Float4> moved = arena.temporary<Float4>(count);
  first.upload(ring.first);
  edge.upload(ring.edge);
  moved.upload(before);
  const auto turn = [&](const Array<Float4>& from, Array<Float4>& to, std::uint32_t shake) {
    auto stage = exec_.stage("smooth");
    exec_.for_each(set.count, detail::SmoothInRing<FieldGround>{field_ground(), first.data(), edge.data(),
                                                                order_.data(), set.interface.data(), from.data(),
                                                                to.data(), set.direction.data(), shake});
  };
  for (int k = 0; k < rule.turns; k += 2) {
    turn(set.place, moved, k == 0 ? rule.shake : 0);
    turn(moved, set.place, 0);
    tell("smooth", improve_fraction(rounds), k + 2);
  }
  const std::vector<Float4> after = set.place.download(0, count);
  std::int64_t far = 0;
  for (std::size_t v = 0; v < made.point_of.size(); ++v) {
    const Float4 a = before[made.point_of[v]], b = after[made.point_of[v]];
    const Vec3d place(b.x, b.y, b.z);
    far += length(place - Vec3d(a.x, a.y, a.z)) > 0.01 * a.w;
    made.mesh.points[v] = frame_.to_world(place);
  }
  return far;
}

/// Order and size of the particles at the points of a mesh.
template <class Backend>
auto MeshPipelineOf<Backend>::point_facts(const Triangulated& made) const -> PointFacts {
  const HostParticles particles = download_particles();
  PointFacts facts;
  for (const std::uint32_t i : made.point_of) {
    facts.order.push_back(std::uint8_t(junctions_[particles.interface[i]].order()));
    facts.size.push_back(particles.place[i].w * float(frame_.unit));
  }
  lift_off_junctions(made.mesh, facts.order);
  return facts;
}

/// Where the mesh touches itself: two points of it, or one twice.
template <class Backend>
std::vector<std::array<std::uint32_t, 2>> MeshPipelineOf<Backend>::touching_points(const Triangulated& made) const {
  const std::vector<std::uint32_t>& point_of = made.point_of;
  std::vector<std::array<std::uint32_t, 2>> touching = made.repair.places;
  for (auto& place : touching)  // particles; the mesh has those that facets use, in the same order
    for (std::uint32_t& p : place)
      p = std::uint32_t(std::lower_bound(point_of.begin(), point_of.end(), p) - point_of.begin());
  return touching;
}

/// Takes away the particles that spoil triangles, and adds some where a surface touches itself or a rim has a gap; only at the
/// mesh's points `there`, where these are marked. False where nothing is to be changed.
template <class Backend>
bool MeshPipelineOf<Backend>::mend(const Triangulated& made, const DefectRule& rule, Attempt* attempt,
                                   std::span<const std::uint8_t> there) {
  auto stage = exec_.stage("mend");
  const PointFacts facts = point_facts(made);
  MeshDefects defects = find_defects(made.mesh, facts.order, facts.size, touching_points(made), rule);
  if (!there.empty()) {
    std::erase_if(defects.remove, [&](std::uint32_t v) { return !there[v]; });
    std::erase_if(defects.insert, [&](const MeshDefects::NewPoint& p) { return !there[p.at]; });
  }
  if (defects.remove.empty() && defects.insert.empty()) return false;
  std::vector<std::uint8_t> gone(std::size_t(solver_->particles().count), 0);
  for (const std::uint32_t v : defects.remove) gone[made.point_of[v]] = 1;
  polish(change_particles(gone, defects.insert));  // the others lie on the fields
  if (attempt) attempt->change(gone, std::size_t(solver_->particles().count));
  return true;
}

}  // namespace nacre
