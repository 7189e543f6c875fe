// Nacre: triangles from the particles, and particles changed until the triangles are good.
#include "compute/pipeline/mesh_improvement.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/math/sort_unique.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/meshing/star_mesh.hpp"
#include "compute/meshing/star_seams.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/meshing/triangle_rings.hpp"

namespace nacre {
namespace {

/// What stars ask of particles, beyond what these hold.
struct StarInput {
  std::vector<Junction> junction;
  std::vector<JunctionGradients> gradient;  // of those on curves and at points

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
  input.gradient = fields.junction_gradients(position, junction);
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
      patch_cells_(rule.threads),
      on_junctions_([this](std::span<const Vec3d> points, std::span<const Junction> junctions) {
        return particles_.onto_junctions(points, junctions, false);
      }) {}

ImprovedMesh MeshImprovement::run() {
  Kept best = whole();
  settle(best);
  const auto unacceptable = [&] { return stars() && rule_.deviation == 0 && !best.acceptable; };
  if (unacceptable()) settle_unacceptable(best);
  // Cells of all particles rather than a mesh of stars that is not even acceptable.
  if (unacceptable()) {
    ++star_use_.fallbacks;
    remeshed_ = 0;
    particles_.upload(best.particles);
    best = whole();
    settle(best);
  }
  if (rule_.deviation > 0) refine(best);
  star_use_.flips = best.flips, star_use_.contractions = best.contractions, star_use_.splits = best.splits;
  particles_.upload(best.particles);
  return {std::move(best.made.mesh), count_by_order(best.particles.interface, table_), star_use_, deviation_};
}

/// A mesh of all particles, which are remeshed and smoothed until that is done; polished.
MeshImprovement::Kept MeshImprovement::whole() {
  Triangulated made;
  do {
    tell_("triangulate", fraction(), 0, 0);
    made = triangulate(needs_patches());
  } while (improve(made));
  Kept best = as_made(std::move(made));
  if (rule_.stars && rule_.deviation == 0) polish(best);
  return best;
}

/// A mesh with its particles as they are.
MeshImprovement::Kept MeshImprovement::as_made(Triangulated made) {
  Kept kept;
  kept.particles = select(particles_.download(), made.point_of);
  std::iota(made.point_of.begin(), made.point_of.end(), 0u);
  kept.made = std::move(made);
  judge(kept);
  return kept;
}

double MeshImprovement::fraction() const {
  return 0.85 + 0.09 * (smoothed_ + remeshed_) / std::max(1, rule_.smooth + rule_.remesh);
}

/// Whether what follows the next mesh needs triangles where stars do not settle, too. Before the last round of
/// smoothing it does not: the particles there stay as they are until then.
bool MeshImprovement::needs_patches() const { return !remeshes_first() && smoothed_ + 1 >= rule_.smooth; }

/// Whether the next mesh is the first, whose clear defects are remeshed before any smoothing.
bool MeshImprovement::remeshes_first() const { return smoothed_ + remeshed_ == 0 && rule_.remesh > 0; }

MeshImprovement::Triangulated MeshImprovement::triangulate(bool patches) {
  Triangulated made;
  particles_.in_stage("triangulate", [&] {
    const HostParticles particles = particles_.download();
    const std::vector<Vec3d> points = world_positions(particles.position, frame_);
    // Once cells were needed, all later meshes are of cells, too: triangles good in one kind may be bad in the other.
    if (!stars() || !triangulate_by_stars(particles, points, patches, made)) triangulate_by_cells(points, made);
    check_stop(rule_.stop);
    finish(made, particles);
  });
  return made;
}

/// What follows from the mesh and the particles.
void MeshImprovement::finish(Triangulated& made, const HostParticles& particles) const {
  made.order.resize(made.point_of.size()), made.size.resize(made.point_of.size());
  tbb::parallel_for(std::size_t(0), made.point_of.size(), [&](std::size_t v) {
    const std::uint32_t i = made.point_of[v];
    made.order[v] = table_.order[particles.interface[i]];
    made.size[v] = particles.position[i].w * float(frame_.unit);
  });
  lift_off_junctions(made.mesh, made.order);
  made.fitness = fitness_of(made);
}

double MeshImprovement::fitness_of(const Triangulated& made) {
  return made.touching.empty() ? fitness(made.mesh, made.order, worst_defects) : -double(made.touching.size());
}

/// False where the stars do not give a sound mesh.
bool MeshImprovement::triangulate_by_stars(const HostParticles& particles, std::span<const Vec3d> points, bool patches,
                                           Triangulated& made) {
  const StarInput input = star_input(particles_, particles, table_);
  StarMesh stars = mesh_from_stars(input.of(particles), *star_device_);
  check_stop(rule_.stop);
  const auto& axes = frame_.axes;
  if (dot(axes[0], cross(axes[1], axes[2])) < 0)  // the particles' own coordinates are left-handed in the world
    for (Triangle& t : stars.triangles) std::swap(t.b, t.c);
  std::vector<double> size(particles.count());
  tbb::parallel_for(std::size_t(0), size.size(),
                    [&](std::size_t i) { size[i] = particles.position[i].w * frame_.unit; });
  const auto material_at = [&](std::span<const Vec3d> at) { return particles_.material_at(at); };
  std::vector<std::array<std::uint32_t, 2>> touching;
  const bool may_settle = double(stars.counts.unsettled) <= rule_.most_unsettled * double(stars.counts.stars);
  patches |= stars.triangles.empty();
  const bool settled = may_settle && (!patches || settle_by_cells(stars, {points, size, material_at}, patch_cells_,
                                                                  touching, rule_.stop));
  star_use_.last = stars.counts;
  ++(settled ? star_use_.meshes : star_use_.fallbacks);
  if (!settled) return false;
  if (patches) {
    for (const std::uint32_t i : at_pinched_joints(stars, points.size())) touching.push_back({i, i});
    take_triangles(points, std::move(stars), std::move(touching), made);
  } else {
    take_without_patches(points, std::move(stars), made);
  }
  return true;
}

/// Triangles are missing at particles that are unsettled.
void MeshImprovement::take_without_patches(std::span<const Vec3d> points, StarMesh stars, Triangulated& made) {
  std::vector<std::uint8_t> settled(points.size(), 1);
  for (const std::uint32_t i : stars.unsettled) settled[i] = 0;
  made.mesh = mesh_of_triangles(points, std::move(stars.triangles), std::move(stars.materials), &made.point_of);
  made.settled.resize(made.point_of.size());
  tbb::parallel_for(std::size_t(0), made.settled.size(),
                    [&](std::size_t v) { made.settled[v] = settled[made.point_of[v]]; });
}

void MeshImprovement::take_triangles(std::span<const Vec3d> points, StarMesh stars,
                                     std::vector<std::array<std::uint32_t, 2>> touching, Triangulated& made) {
  made.mesh = mesh_of_triangles(points, std::move(stars.triangles), std::move(stars.materials), &made.point_of);
  std::erase_if(touching, [&](const auto& defect) {  // of particles that no triangle has
    return !std::all_of(defect.begin(), defect.end(), [&](std::uint32_t p) {
      return std::binary_search(made.point_of.begin(), made.point_of.end(), p);
    });
  });
  made.touching = std::move(touching);
  renumber(made.touching, made.point_of);
  sort_unique(made.touching);
}

/// Points are where the mesh touches itself, too: all are looked at.
void MeshImprovement::add_pinched(Triangulated& made) {
  for (const std::uint32_t v : pinched_points(made.mesh)) made.touching.push_back({v, v});
  sort_unique(made.touching);
}

void MeshImprovement::triangulate_by_cells(std::span<const Vec3d> points, Triangulated& made) {
  const DelaunayCells cells = delaunay_.cells(points, rule_.stop);
  std::vector<std::uint16_t> label = particles_.material_at(cells.circumcentres);
  LabelRepair repair = repair_labels(points, cells, label, rule_.stop);
  made.mesh = extract_interfaces(points, cells, label, &made.point_of);
  made.touching = std::move(repair.defects);
  renumber(made.touching, made.point_of);
}

/// Changes all particles before they are triangulated again; false where that has been done as often as is asked.
bool MeshImprovement::improve(Triangulated& made) {
  if (remeshes_first()) {
    ++remeshed_;
    if (!remesh(made, DefectRule(), made.settled).empty()) return true;
  }
  if (smoothed_ >= rule_.smooth) return false;
  ++smoothed_;
  smooth(made, made.settled.empty() ? std::vector<std::uint8_t>(made.mesh.points.size(), 1) : made.settled);
  if (smoothed_ == rule_.smooth && rule_.remesh > 0) remesh(made, worst_defects, made.settled);
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
    made.mesh.points[v] = frame_.to_world(position);
    made.size[v] = b.w * float(frame_.unit);
  }
  return far;
}

/// Takes away the particles that spoil triangles, and adds some where a surface touches itself or a rim has a gap; only
/// at the mesh's points `there`, where these are marked. Marks those that are gone; empty where nothing is to be
/// changed.
std::vector<std::uint8_t> MeshImprovement::remesh(const Triangulated& made, const DefectRule& rule,
                                                  std::span<const std::uint8_t> there) {
  std::vector<std::uint8_t> gone;
  particles_.in_stage("remesh", [&] {
    MeshDefects defects = find_defects(made.mesh, made.order, made.size, made.touching, rule);
    if (!there.empty()) {
      std::erase_if(defects.remove, [&](std::uint32_t v) { return !there[v]; });
      std::erase_if(defects.insert, [&](const MeshDefects::NewPoint& p) { return !there[p.at]; });
    }
    if (defects.remove.empty() && defects.insert.empty()) return;
    gone.assign(std::size_t(particles_.count()), 0);
    for (const std::uint32_t v : defects.remove) gone[made.point_of[v]] = 1;
    particles_.replace(gone, defects.insert);
  });
  return gone;
}

}  // namespace nacre
