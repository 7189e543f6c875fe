// Nacre: triangles from the particles, and particles changed until the triangles are good.
#include "compute/pipeline/mesh_improvement.hpp"

#include <algorithm>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/meshing/star_mesh.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/meshing/triangle_rings.hpp"

namespace nacre {
namespace {

/// Rounds of an attempt after its first. With stars, which change less from one mesh to the next than cells do, other
/// attempts help more.
int most_further(const ImprovementRule& rule, const StarUse& use) { return rule.stars && use.fallbacks == 0 ? 1 : 4; }

constexpr int most_in_vain = 3;        // attempts
constexpr int most_patchings = 3;      // of what is not acceptable,
constexpr int rounds_of_patching = 6;  // of remeshing in each, at most

/// Cells are tried, too, rather than that triangles of stars are so bad. Below what is aimed at: a triangle or two that
/// nearly reach that are not worth so much.
constexpr double least_accepted = 0.2;
constexpr DefectRule unacceptable{0, least_accepted, least_accepted, false};

/// What an attempt does to the particles around bad points.
struct AttemptKind {
  int turns;    ///< of smoothing; 0: none
  bool shakes;  ///< smoothing begins from random positions
  bool remeshes;
  bool splits;  ///< ... the sides of curves, where that helps
};
/// Tried in turn: smoothing and remeshing together; fewer steps, for particles that flip to and fro; remeshing alone,
/// which leaves the other particles where they are; and both again from a random start.
constexpr std::array<AttemptKind, 4> attempt_kinds{
    {{6, false, true, true}, {2, false, false, false}, {0, false, true, false}, {6, true, true, false}}};

/// `defects` in terms of the mesh's points instead of particles. The mesh has some of the particles, in the same order.
std::vector<std::array<std::uint32_t, 2>> points_of_defects(std::vector<std::array<std::uint32_t, 2>> defects,
                                                            const std::vector<std::uint32_t>& point_of) {
  for (auto& defect : defects)
    for (std::uint32_t& p : defect)
      p = std::uint32_t(std::lower_bound(point_of.begin(), point_of.end(), p) - point_of.begin());
  return defects;
}

/// What stars ask of particles, beyond what these hold.
struct StarInput {
  std::vector<Junction> junction;
  std::vector<JunctionGradients> gradient;

  StarParticles of(const HostParticles& particles) const {
    return {particles.position, particles.direction, junction, gradient};
  }
};

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

}  // namespace

MeshImprovement::MeshImprovement(MovableParticles& particles, const JunctionTable& table, const VolumeFrame& frame,
                                 const ImprovementRule& rule, const TellStage& tell)
    : particles_(particles),
      table_(table),
      frame_(frame),
      rule_(rule),
      tell_(tell),
      delaunay_(rule.threads),
      star_device_(particles.star_device()),
      star_finder_(*star_device_),
      patch_cells_(rule.threads),
      on_junctions_([this](std::span<const Vec3d> points, std::span<const Junction> junctions) {
        return particles_.onto_junctions(points, junctions, false);
      }) {}

ImprovedMesh MeshImprovement::run() {
  std::optional<Kept> best;
  settle(best);
  for (int k = 0; k < most_patchings && stars() && polishes() && !best->acceptable; ++k) patch(*best);
  if (stars() && polishes() && !best->acceptable) {
    ++star_use_.fallbacks;
    remeshed_ = 0, bad_ = most_bad, in_vain_ = 0;
    best.reset();
    settle(best);
  }
  if (rule_.deviation > 0) refine(*best);
  star_use_.flips = best->flips, star_use_.contractions = best->contractions, star_use_.splits = best->splits;
  particles_.upload(best->particles);
  return {std::move(best->made.mesh), count_by_order(best->particles.interface, table_), star_use_, deviation_};
}

/// Triangulates and improves until the mesh is good or nothing helps. `best` is replaced by what is better, where it is
/// the first or no deviation is asked for.
void MeshImprovement::settle(std::optional<Kept>& best) {
  for (bool again = true; again;) {
    tell_("triangulate", fraction(), 0, 0);
    Triangulated made = triangulate();
    if (attempt_) {
      if (continue_attempt(made)) continue;
      if (take_back_attempt()) made = triangulate();
    }
    if (smoothed_ >= rule_.smooth) {
      Kept now;
      if (polishes())
        now = polished(made);
      else
        now.made = made, now.particles = particles_.download();
      now.acceptable = is_acceptable(now.made);
      if (stars() && polishes() && !now.acceptable) patch_at_unacceptable(made);
      in_vain_ = best && !nearer_to_good(now, *best) ? in_vain_ + 1 : 0;
      if (!best || !better_shaped(*best, now)) best = std::move(now);
      if (polishes() && (is_good(*best) || in_vain_ == most_in_vain)) return;
    }
    again = improve(made);
  }
}

bool MeshImprovement::is_acceptable(const Triangulated& made) {
  return made.touching.empty() && fitness(made.mesh, made.order, unacceptable) >= 1;
}

/// Makes the mesh again with cells where it is not acceptable, of the same particles, and improves it: triangles of one
/// kind may be good where those of the other are bad. `best` is replaced where that is better.
void MeshImprovement::patch(Kept& best) {
  particles_.upload(best.particles);
  patch_at_unacceptable(best.made);
  remeshed_ = std::max(1, rule_.remesh - rounds_of_patching), bad_ = most_bad, in_vain_ = 0;
  std::optional<Kept> now;
  settle(now);
  if (stars() && better_shaped(*now, best)) best = std::move(*now);
}

/// The next mesh has cells where `made`, of the particles as they are, is not acceptable.
void MeshImprovement::patch_at_unacceptable(const Triangulated& made) {
  const std::vector<std::uint8_t> bad = bad_points(made, unacceptable.near);
  for (std::size_t v = 0; v < bad.size(); ++v)
    if (bad[v]) patch_cells_.keep_in_patch(made.mesh.points[v]);
}

double MeshImprovement::fraction() const {
  return 0.85 + 0.09 * (smoothed_ + remeshed_) / std::max(1, rule_.smooth + rule_.remesh);
}

MeshImprovement::Triangulated MeshImprovement::triangulate() {
  Triangulated made;
  particles_.in_stage("triangulate", [&] {
    const HostParticles particles = particles_.download();
    const std::vector<Vec3d> points = world_positions(particles.position, frame_);
    // Once cells were needed, all later meshes are of cells, too: triangles good in one kind may be bad in the other.
    if (!stars() || !triangulate_by_stars(particles, points, made)) triangulate_by_cells(points, made);
    check_stop(rule_.stop);
    for (const std::uint32_t i : made.point_of) {
      made.order.push_back(table_.order[particles.interface[i]]);
      made.size.push_back(particles.position[i].w * float(frame_.unit));
    }
    lift_off_junctions(made.mesh, made.order);
    made.fitness = fitness_of(made);
  });
  return made;
}

double MeshImprovement::fitness_of(const Triangulated& made) {
  return made.touching.empty() ? fitness(made.mesh, made.order, worst_defects) : -double(made.touching.size());
}

/// False where the stars do not give a sound mesh.
bool MeshImprovement::triangulate_by_stars(const HostParticles& particles, std::span<const Vec3d> points,
                                           Triangulated& made) {
  const StarInput input = star_input(particles_, particles, table_);
  StarMesh stars = mesh_from_stars(input.of(particles), star_finder_);
  check_stop(rule_.stop);
  std::vector<double> size;
  for (const Float4& p : particles.position) size.push_back(p.w * frame_.unit);
  const auto& axes = frame_.axes;
  const bool mirrored = dot(axes[0], cross(axes[1], axes[2])) < 0;
  const auto material_at = [&](std::span<const Vec3d> at) { return particles_.material_at(at); };
  std::vector<std::array<std::uint32_t, 2>> touching;
  const bool may_settle = double(stars.counts.unsettled) <= rule_.most_unsettled * double(stars.counts.stars);
  const bool settled =
      may_settle && settle_by_cells(stars, {points, size, mirrored, material_at}, patch_cells_, touching, rule_.stop);
  star_use_.last = stars.counts;
  ++(settled ? star_use_.meshes : star_use_.fallbacks);
  if (!settled) return false;
  made.mesh = mesh_of_triangles(points, std::move(stars.triangles), std::move(stars.materials), &made.point_of);
  std::erase_if(touching, [&](const auto& defect) {  // of particles that no triangle has
    return !std::all_of(defect.begin(), defect.end(), [&](std::uint32_t p) {
      return std::binary_search(made.point_of.begin(), made.point_of.end(), p);
    });
  });
  made.touching = points_of_defects(std::move(touching), made.point_of);
  for (const std::uint32_t v : pinched_points(made.mesh)) made.touching.push_back({v, v});
  std::sort(made.touching.begin(), made.touching.end());
  made.touching.erase(std::unique(made.touching.begin(), made.touching.end()), made.touching.end());
  return true;
}

void MeshImprovement::triangulate_by_cells(std::span<const Vec3d> points, Triangulated& made) {
  const DelaunayCells cells = delaunay_.cells(points, rule_.stop);
  std::vector<std::uint16_t> label = particles_.material_at(cells.circumcentres);
  LabelRepair repair = repair_labels(points, cells, label, rule_.stop);
  made.mesh = extract_interfaces(points, cells, label, &made.point_of);
  made.touching = points_of_defects(std::move(repair.defects), made.point_of);
}

/// Changes the particles before they are triangulated again; false where there is nothing to change.
bool MeshImprovement::improve(Triangulated& made) {
  if (smoothed_ + remeshed_ == 0 && rule_.remesh > 0) {
    ++remeshed_;
    if (remesh(made, DefectRule())) return true;
  }
  if (smoothed_ < rule_.smooth) {
    ++smoothed_;
    smooth(made, std::vector<std::uint8_t>(made.mesh.points.size(), 1));
    if (smoothed_ == rule_.smooth && rule_.remesh > 0) remesh(made, worst_defects);
    return true;
  }
  const std::vector<std::uint8_t> bad = bad_points(made);
  const std::int64_t count = std::count(bad.begin(), bad.end(), 1);
  const bool worth = made.fitness < 1 || (count > 0 && 4 * count < 3 * bad_);
  if (remeshed_ >= rule_.remesh || !worth) return false;
  ++remeshed_;
  bad_ = count;
  return begin_attempt(made, bad);
}

/// Changes what is around the points `bad`, by the next of the kinds of attempts. False where none changes anything.
bool MeshImprovement::begin_attempt(Triangulated& made, std::span<const std::uint8_t> bad) {
  before_ = particles_.download();
  attempt_.emplace(before_.count(), made.view(), bad, worst_defects);
  further_ = 0;
  for (std::size_t k = 0; k < attempt_kinds.size(); ++k) {
    const std::uint32_t number = tried_++;
    const AttemptKind& kind = attempt_kinds[number % attempt_kinds.size()];
    const bool moves = kind.turns > 0 && rule_.smooth > 0;
    const bool moved = moves && smooth(made, bad, {kind.turns, kind.shakes ? number : 0}) > 0;
    DefectRule rule = worst_defects;
    rule.splits = kind.splits;
    const bool remeshed = kind.remeshes && remesh(made, rule);
    if (moved || remeshed) return true;
  }
  attempt_.reset();
  return false;
}

/// Goes on with an attempt where triangles have become no better: it may take more than one round. False where it has
/// ended.
bool MeshImprovement::continue_attempt(Triangulated& made) {
  attempt_->judge(made.view());
  const std::vector<std::uint8_t> open = attempt_->open(made.view());
  if (open.empty() || further_ == most_further(rule_, star_use_) || remeshed_ >= rule_.remesh) return false;
  ++further_, ++remeshed_;
  std::vector<std::uint8_t> moving = bad_points(made);
  for (std::size_t v = 0; v < moving.size(); ++v) moving[v] &= open[v];
  const bool moved = rule_.smooth > 0 && smooth(made, moving) > 0;
  return remesh(made, worst_defects, open) || moved;
}

/// Ends an attempt: particles go back to where they were before, in those patches whose triangles are no better since.
/// True where there are some.
bool MeshImprovement::take_back_attempt() {
  const std::vector<Attempt::Source> sources = attempt_->taken_back();
  attempt_.reset();
  if (sources.empty()) return false;
  particles_.upload(take_back(sources, before_, particles_.download()));
  return true;
}

/// Moves the particles at points `moving` of the mesh to where their triangles are best, and the mesh's points with
/// them. How many have moved by more than a hundredth of their size.
std::int64_t MeshImprovement::smooth(Triangulated& made, std::span<const std::uint8_t> moving,
                                     const SmoothingRule& rule) {
  const std::vector<Float4> before = particles_.download().position;
  TriangleRings rings;
  particles_.in_stage("smooth", [&] { rings = triangle_rings(made.mesh, made.point_of, moving, before.size()); });
  particles_.smooth(rings, rule, [&](int turns) { tell_("smooth", fraction(), turns, 0); });
  const std::vector<Float4> after = particles_.download().position;
  std::int64_t far = 0;
  for (std::size_t v = 0; v < made.point_of.size(); ++v) {
    const Float4 a = before[made.point_of[v]], b = after[made.point_of[v]];
    const Vec3d position(b.x, b.y, b.z);
    const double moved = length(position - Vec3d(a.x, a.y, a.z));
    far += moved > 0.01 * a.w;
    const Vec3d was = std::exchange(made.mesh.points[v], frame_.to_world(position));
    // What an attempt moves stays in its patch, which would else begin to grow anew.
    if (attempt_ && moved > 0 && patch_cells_.is_in_patch(was)) patch_cells_.keep_in_patch(made.mesh.points[v]);
    made.size[v] = b.w * float(frame_.unit);
  }
  return far;
}

/// Takes away the particles that spoil triangles, and adds some where a surface touches itself or a rim has a gap; only
/// at the mesh's points `there`, where these are marked. False where nothing is to be changed.
bool MeshImprovement::remesh(const Triangulated& made, const DefectRule& rule, std::span<const std::uint8_t> there) {
  bool changed = false;
  particles_.in_stage("remesh", [&] {
    MeshDefects defects = find_defects(made.mesh, made.order, made.size, made.touching, rule);
    if (!there.empty()) {
      std::erase_if(defects.remove, [&](std::uint32_t v) { return !there[v]; });
      std::erase_if(defects.insert, [&](const MeshDefects::NewPoint& p) { return !there[p.at]; });
    }
    changed = !defects.remove.empty() || !defects.insert.empty();
    if (!changed) return;
    std::vector<std::uint8_t> gone(std::size_t(particles_.count()), 0);
    for (const std::uint32_t v : defects.remove) gone[made.point_of[v]] = 1;
    particles_.replace(gone, defects.insert);
    if (attempt_) attempt_->change(gone, std::size_t(particles_.count()));
  });
  return changed;
}

}  // namespace nacre
