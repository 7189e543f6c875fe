// Nacre: particles added where triangles are too far from their interfaces.
#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/math/point_hash.hpp"
#include "compute/meshing/point_tree.hpp"
#include "compute/pipeline/mesh_improvement.hpp"

namespace nacre {
namespace {

constexpr int most_turns = 4;         ///< of adding particles and then improving triangles
constexpr int most_rounds = 16;       ///< of adding particles in one turn;
constexpr int rounds_smoothed = 5;    ///< so many of them smooth around new particles
constexpr int remeshing_of_turn = 6;  ///< rounds of remeshing in one turn, at most
constexpr int smoothing_turns = 4;
constexpr double crowded = 0.1;  ///< a new particle that comes as near to another as this, in `detail`, goes

}  // namespace

/// Better is a mesh that touches itself less often, then one with fewer triangles above the bound that could be
/// divided, then one with better triangles.
bool MeshImprovement::better(const Kept& a, const Kept& b) {
  const auto rank = [](const Kept& k) {
    return std::make_tuple(k.made.touching.size(), k.further.above - k.further.above_detail, -k.made.fitness);
  };
  return rank(a) < rank(b);
}

void MeshImprovement::measure(Kept& kept) {
  particles_.in_stage("refine", [&] {
    kept.deviation = measure_deviation(kept.made.mesh, std::ref(on_junctions_), frame_.unit);
    const auto tried = [&](std::uint16_t third, const Vec3d& p) { return refined_at_.contains(hash_point(third, p)); };
    // Rules are in voxels, meshes in the world.
    kept.further = refine_deviation(kept.made.mesh, kept.deviation,
                                    {rule_.deviation, rule_.detail * frame_.unit, frame_.unit, tried});
    for (const MeshDefects::NewPoint& p : kept.further.insert) refined_at_.insert(hash_point(p.third, p.position));
  });
  check_stop(rule_.stop);
}

/// Takes out the particles from number `first` on that have come to lie beside others of their interface or of one that
/// bounds it.
void MeshImprovement::drop_crowded(std::size_t first) {
  const HostParticles now = particles_.download();
  const std::vector<Vec3d> position = world_positions(now.position, frame_);
  const PointTree tree(position, std::vector<std::uint32_t>{0, std::uint32_t(now.count())});
  std::vector<std::uint8_t> gone(now.count());
  std::vector<PointTree::Found> found;
  for (std::size_t i = first; i < now.count(); ++i) {
    found.clear();
    tree.within(0, position[i], crowded * rule_.detail * frame_.unit, found);
    const Junction& mine = table_.junctions[now.interface[i]];
    gone[i] = std::any_of(found.begin(), found.end(), [&](const PointTree::Found& f) {
      const Junction& other = table_.junctions[now.interface[f.point]];
      return f.point < i && gone[f.point] == 0 && (mine.bounds(other) || other.bounds(mine));
    });
  }
  if (std::find(gone.begin(), gone.end(), 1) != gone.end()) particles_.replace(gone, {});
}

/// Adds particles, and smooths what is around them. Those of which `made` has no point go before: new ones might come
/// to lie beside them. Where there is no room for any, the next round tries other places.
void MeshImprovement::add_where_far(Triangulated& made, const DeviationRefinement& further, bool smooths) {
  std::size_t before = 0;  // particles that stay
  particles_.in_stage("refine", [&] {
    std::vector<std::uint8_t> gone(std::size_t(particles_.count()), 1);
    for (const std::uint32_t i : made.point_of) gone[i] = 0;
    before = std::size_t(std::count(gone.begin(), gone.end(), 0));
    const std::vector<std::uint32_t> taken = particles_.replace(gone, further.insert);
    const auto onto = [&](std::span<const Vec3d> points, std::span<const Junction> junctions) {
      return particles_.onto_junctions(points, junctions, false);
    };
    const auto material_at = [&](std::span<const Vec3d> points) { return particles_.material_at(points); };
    const std::vector<MeshDefects::NewPoint> on_rims =
        points_on_rims(made.mesh, further.insert, taken, rule_.detail * frame_.unit, onto, material_at);
    particles_.replace(std::vector<std::uint8_t>(std::size_t(particles_.count()), 0), on_rims);
    drop_crowded(before);
  });
  const std::size_t added = std::size_t(particles_.count()) - before;
  deviation_.inserted += std::int64_t(added);
  made = triangulate();
  if (added == 0 || !smooths || rule_.smooth == 0) return;
  std::vector<std::uint8_t> fresh(made.mesh.points.size()), moving(made.mesh.points.size());
  for (std::size_t v = 0; v < fresh.size(); ++v) fresh[v] = made.point_of[v] >= before;
  for (const Triangle& t : made.mesh.triangles)
    if (fresh[t.a] || fresh[t.b] || fresh[t.c]) moving[t.a] = moving[t.b] = moving[t.c] = 1;
  smooth(made, moving, {smoothing_turns, 0});
  made = triangulate();
}

/// Adds particles in the triangles that are too far away, until there are none or nothing helps; then improves bad
/// triangles, and so on in turn.
void MeshImprovement::refine(Kept& best) {
  measure(best);
  deviation_.first_max = best.deviation.max;
  deviation_.first_above = best.further.above;
  Kept answer = best;
  for (int turn = 0; turn < most_turns; ++turn) {
    particles_.upload(best.particles);
    Kept now = best;
    for (int round = 0; round < most_rounds && !now.further.insert.empty(); ++round) {
      tell_("refine", fraction(), round + 1, 0);
      ++deviation_.rounds;
      add_where_far(now.made, now.further, round < rounds_smoothed);
      now.particles = particles_.download();
      measure(now);
      if (better(now, best)) best = now;
    }
    if (better(best, answer)) answer = best;
    if (best.made.fitness >= 1 || turn + 1 == most_turns) break;
    remeshed_ = std::max(1, std::min(remeshed_, rule_.remesh - remeshing_of_turn));
    const double fitness_before = best.made.fitness;
    settle(best);
    measure(best);
    if (better(best, answer)) answer = best;
    if (best.further.insert.empty() || !(best.made.fitness > fitness_before)) break;
  }
  best = std::move(answer);
  deviation_.max = best.deviation.max;
  deviation_.mean = best.deviation.mean;
  deviation_.above_detail = best.further.above_detail;
  deviation_.above_junctions = best.further.above_junctions;
  deviation_.above_others = best.further.above - best.further.above_detail - best.further.above_junctions;
  for (const std::uint32_t t : best.further.worst) {
    const Triangle& c = best.made.mesh.triangles[t];
    deviation_.places.push_back((best.made.mesh.points[c.a] + best.made.mesh.points[c.b] + best.made.mesh.points[c.c]) /
                                3.0);
  }
}

}  // namespace nacre
