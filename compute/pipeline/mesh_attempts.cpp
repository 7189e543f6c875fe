// Nacre: attempts at bad triangles, each in a piece that is cut out of the mesh, and taken where it made them better.
#include <algorithm>
#include <numeric>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/halves.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/near_points.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/pipeline/mesh_improvement.hpp"

namespace nacre {
namespace {

/// Cells are tried, too, rather than that triangles of stars are so bad. Below what is aimed at: a triangle or two that
/// nearly reach that are not worth so much.
constexpr double least_accepted = 0.2;
constexpr DefectRule unacceptable{0, least_accepted, least_accepted, false};

/// How far from bad points is cut, sizes: patches of cells reach three around what has changed, and may grow.
constexpr double attempt_reach = 10;

/// Rounds of an attempt after its first, where nothing is better by then: where a particle has gone, triangles are
/// often worse before they get better.
constexpr int most_further = 3;

using Marks = std::vector<std::uint8_t>;

/// `marks`, and what has a triangle with a marked point.
Marks with_neighbours(const SurfaceMesh& mesh, const Marks& marks) {
  Marks wider = marks;
  for (const Triangle& t : mesh.triangles)
    if (marks[t.a] || marks[t.b] || marks[t.c]) wider[t.a] = wider[t.b] = wider[t.c] = 1;
  return wider;
}

}  // namespace

/// Returns the marks of the points at triangles that could be better.
std::vector<std::uint8_t> MeshImprovement::judge(Kept& kept) const {
  Marks bad = bad_points(kept.made, polish_rule());
  kept.mediocre = std::count(bad.begin(), bad.end(), 1);
  kept.made.fitness = fitness_of(kept.made);
  kept.acceptable = kept.made.touching.empty() && fitness(kept.made.mesh, kept.made.order, unacceptable) >= 1;
  return bad;
}

/// Attempts at what is bad. A mesh that is to be of Delaunay cells alone is then made of all particles once more: those
/// of a piece differ where labels were repaired.
void MeshImprovement::settle(Kept& best) {
  if (rule_.stars) {
    attempt(best, rule_.aim, 1);
    return;
  }
  for (Kept now = best; attempt(now, rule_.aim, 1);) {
    particles_.upload(now.particles);
    now = as_made(triangulate());
    if (!better_shaped(now, best)) return;
    best = now;
  }
}

/// As many attempts again at those triangles alone for which all would be made of cells; more of the particles around
/// them move.
void MeshImprovement::settle_unacceptable(Kept& best) {
  remeshed_ = 0;
  attempt(best, unacceptable, 3);
}

/// Changes what is around triangles that are bad by `rule` until there are none, or each kind of attempt was made in
/// vain in so many `turns`. In more than one, more rings of neighbours move, one more with each attempt in vain. True
/// where something was changed.
bool MeshImprovement::attempt(Kept& best, const DefectRule& rule, std::size_t turns) {
  // Tried in turn: cells in place of stars, for triangles of one kind may be good where those of the other are bad;
  // smoothing and remeshing together; fewer steps, for particles that flip to and fro; remeshing alone, which leaves
  // the other particles where they are; and both again from a random start.
  constexpr std::array<AttemptKind, 5> kinds{{{0, false, false, false},
                                              {6, false, true, true},
                                              {2, false, false, false},
                                              {0, false, true, false},
                                              {6, true, true, false}}};
  std::size_t least = best.made.mesh.points.size() + 1, in_vain = 0;
  bool changed = false;
  while (in_vain < turns * kinds.size() && remeshed_ < rule_.remesh) {
    const std::vector<std::uint32_t> bad = marked(bad_points(best.made, rule));
    if (bad.empty()) break;
    in_vain = bad.size() < least ? 0 : in_vain + 1;
    least = std::min(least, bad.size());
    check_stop(rule_.stop);
    tell_("remesh", fraction(), remeshed_, 0);
    AttemptKind kind = kinds[tried_++ % kinds.size()];
    if (turns > 1) kind.rings = 2 + int(in_vain);
    ++remeshed_, ++star_use_.attempts;
    changed |= attempt_at(best, bad, kind);
  }
  if (changed) particles_.in_stage("remesh", [&] { drop_unused(best); });
  return changed;
}

/// True where some of the triangles at the points `bad` became better. Points that have no triangle any more remain, so
/// that the others keep their numbers.
bool MeshImprovement::attempt_at(Kept& best, std::span<const std::uint32_t> bad, const AttemptKind& kind) {
  Cut cut;
  particles_.in_stage("remesh", [&] { cut = cut_out(best, bad, attempt_reach); });
  std::optional<Kept> now = attempted(cut, kind);
  if (!now) {  // where cells do not settle, they shall not keep the others from it
    bool any = false;
    for (std::vector<std::uint32_t>& half : halves(cut.piece.made.mesh, cut.bad)) {
      for (std::uint32_t& v : half) v = cut.point[v];
      any |= attempt_at(best, half, kind);
    }
    return any;
  }
  for (int further = 0; now; ++further) {
    bool better = false;
    particles_.in_stage("remesh", [&] { better = take_better(best, cut, *now); });
    if (better || further == most_further) return better;
    Cut next;
    next.bad = bad_points(now->made, rule_.aim);
    for (const std::uint32_t v : same_particles(cut.piece.particles, now->particles))
      next.on_rim.push_back(v != none && cut.on_rim[v]);
    next.piece = std::move(*now);
    now = attempted(next, {6, false, true, true});
  }
  return false;
}

/// All points within `reach` sizes of some, and the triangles between them.
MeshImprovement::Cut MeshImprovement::cut_out(const Kept& best, std::span<const std::uint32_t> bad, double reach) {
  const SurfaceMesh& mesh = best.made.mesh;
  const std::vector<double> size(best.made.size.begin(), best.made.size.end());
  Marks near(mesh.points.size(), 0), is_bad(near);
  for (const std::uint32_t v : bad) is_bad[v] = 1;
  mark_near(mesh.points, bad, size, reach, near);
  const Marks used = mark_corners(mesh.triangles, near.size());
  Cut cut;
  cut.point = select_where(near.size(), [&](std::size_t v) { return near[v] && used[v]; });
  cut.triangle = select_where(mesh.triangles.size(), [&](std::size_t i) {
    const Triangle& t = mesh.triangles[i];
    return near[t.a] && near[t.b] && near[t.c];
  });
  std::vector<std::uint32_t> number(mesh.points.size(), none);
  Kept& piece = cut.piece;
  Triangulated& made = piece.made;
  for (std::uint32_t k = 0; k < cut.point.size(); ++k) {
    const std::uint32_t v = cut.point[k];
    number[v] = k;
    made.mesh.points.push_back(mesh.points[v]);
    made.point_of.push_back(k);
    made.order.push_back(best.made.order[v]);
    made.size.push_back(best.made.size[v]);
    cut.bad.push_back(is_bad[v]);
  }
  piece.particles = select(best.particles, cut.point);
  cut.on_rim.assign(cut.point.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const bool all = near[t.a] && near[t.b] && near[t.c];
    for (int k = 0; k < 3 && !all; ++k)
      if (number[t[k]] != none) cut.on_rim[number[t[k]]] = 1;
  }
  for (const std::uint32_t i : cut.triangle) {
    const Triangle& t = mesh.triangles[i];
    made.mesh.triangles.push_back({number[t.a], number[t.b], number[t.c]});
    made.mesh.materials.push_back(mesh.materials[i]);
  }
  for (const auto& [a, b] : best.made.touching)
    if (number[a] != none && number[b] != none) made.touching.push_back({number[a], number[b]});
  return cut;
}

/// The piece with its particles changed, triangulated anew there, and polished; nothing where cells do not settle.
std::optional<MeshImprovement::Kept> MeshImprovement::attempted(const Cut& cut, const AttemptKind& kind) {
  particles_.upload(cut.piece.particles);
  Triangulated made = cut.piece.made;
  Marks loose = cut.bad;
  for (int ring = 0; ring < kind.rings; ++ring) loose = with_neighbours(made.mesh, loose);
  for (std::size_t v = 0; v < loose.size(); ++v) loose[v] = loose[v] && !cut.on_rim[v];
  if (kind.turns > 0 && rule_.smooth > 0) smooth(made, loose, {kind.turns, kind.shakes ? tried_ : 0});
  Marks gone;
  if (kind.remeshes) {
    DefectRule rule = rule_.aim;
    rule.splits = kind.splits;
    gone = remesh(made, rule, loose);
  }
  std::optional<Triangulated> again;
  particles_.in_stage("triangulate", [&] { again = triangulate_again(made, gone, kind.turns > 0 ? loose : cut.bad); });
  if (!again) return {};
  Kept now = rule_.stars ? polished(*again) : as_made(std::move(*again));
  add_pinched(now.made);
  return now;
}

/// Cells in place of the triangles at points that are `loose`, at those of particles that are `gone`, and at particles
/// that are new, behind the others. Nothing where they do not settle.
std::optional<MeshImprovement::Triangulated> MeshImprovement::triangulate_again(const Triangulated& made,
                                                                                std::span<const std::uint8_t> gone,
                                                                                std::span<const std::uint8_t> loose) {
  const HostParticles particles = particles_.download();
  const std::vector<Vec3d> points = world_positions(particles.position, frame_);
  std::vector<std::uint32_t> number(made.mesh.points.size(), none);
  std::uint32_t stay = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v)
    if (gone.empty() || !gone[v]) number[v] = stay++;
  Marks unsettled(points.size(), 0);
  for (std::uint32_t v = 0; v < number.size(); ++v)
    if (loose[v] && number[v] != none) unsettled[number[v]] = 1;
  std::fill(unsettled.begin() + stay, unsettled.end(), 1);
  StarMesh kept;
  for (std::size_t i = 0; i < made.mesh.triangles.size(); ++i) {
    const Triangle& t = made.mesh.triangles[i];
    const Triangle now{number[t.a], number[t.b], number[t.c]};
    if (now.a != none && now.b != none && now.c != none) {
      kept.triangles.push_back(now), kept.materials.push_back(made.mesh.materials[i]);
      continue;
    }
    for (int k = 0; k < 3; ++k)
      if (now[k] != none) unsettled[now[k]] = 1;
  }
  kept.unsettled = marked(unsettled);
  std::vector<double> size;
  for (const Float4& p : particles.position) size.push_back(p.w * frame_.unit);
  const auto material_at = [&](std::span<const Vec3d> at) { return particles_.material_at(at); };
  PatchCells cells(rule_.threads);
  std::vector<std::array<std::uint32_t, 2>> touching;
  if (!settle_by_cells(kept, {points, size, material_at}, cells, touching, rule_.stop)) return {};
  Triangulated again;
  take_triangles(points, std::move(kept), std::move(touching), again);
  add_pinched(again);
  finish(again, particles);
  return again;
}

/// Puts the better parts of a piece back into the mesh; false where there are none.
bool MeshImprovement::take_better(Kept& best, const Cut& cut, const Kept& now) {
  const std::vector<std::uint32_t> same = same_particles(cut.piece.particles, now.particles);
  std::vector<std::int64_t> facets;
  for (const auto& [low, high] : best.made.mesh.materials) {
    facets.resize(std::max<std::size_t>(facets.size(), high + 1u));
    ++facets[low], ++facets[high];
  }
  const BetterParts parts =
      better_parts(cut.piece.made.judged(), now.made.judged(), same, cut.on_rim, std::move(facets), rule_.aim);
  if (parts.gone.empty()) return false;
  star_use_.specks += parts.specks;
  SurfaceMesh& mesh = best.made.mesh;
  Marks replaced(mesh.points.size(), 0), gone(mesh.triangles.size(), 0);
  for (const std::uint32_t i : parts.gone) {
    const Triangle& t = mesh.triangles[cut.triangle[i]];
    replaced[t.a] = replaced[t.b] = replaced[t.c] = gone[cut.triangle[i]] = 1;
  }
  std::size_t left = 0;
  for (std::size_t i = 0; i < gone.size(); ++i)
    if (!gone[i]) mesh.triangles[left] = mesh.triangles[i], mesh.materials[left++] = mesh.materials[i];
  mesh.triangles.resize(left), mesh.materials.resize(left);
  std::erase_if(best.made.touching,
                [&](const std::array<std::uint32_t, 2>& d) { return replaced[d[0]] || replaced[d[1]]; });

  std::vector<std::uint32_t> number(now.made.mesh.points.size(), none);
  for (const std::uint32_t i : parts.taken) {
    const Triangle& t = now.made.mesh.triangles[i];
    for (int k = 0; k < 3; ++k)
      if (number[t[k]] == none) number[t[k]] = put(best, now, t[k], same[t[k]] == none ? none : cut.point[same[t[k]]]);
    mesh.triangles.push_back({number[t.a], number[t.b], number[t.c]});
    mesh.materials.push_back(now.made.mesh.materials[i]);
  }
  return true;
}

/// A point of a piece in the whole, with its particle: as point `number` or, if that is `none`, as a new one. Returns
/// its number.
std::uint32_t MeshImprovement::put(Kept& best, const Kept& now, std::uint32_t v, std::uint32_t number) {
  if (number == none) {
    number = std::uint32_t(best.made.mesh.points.size());
    best.made.mesh.points.push_back(now.made.mesh.points[v]);
    best.made.point_of.push_back(number);
    best.made.size.push_back(now.made.size[v]);
    best.made.order.push_back(0);
    best.particles.position.push_back(now.particles.position[v]);
    best.particles.direction.push_back(now.particles.direction[v]);
    best.particles.interface.push_back(now.particles.interface[v]);
  }
  best.made.order[number] = now.made.order[v];  // a junction may end elsewhere now
  return number;
}

/// Leaves out the points that no triangle has, and their particles, and judges what is left.
void MeshImprovement::drop_unused(Kept& best) const {
  Triangulated& made = best.made;
  std::vector<std::uint32_t> used;
  const std::vector<Vec3d> points = std::move(made.mesh.points);
  made.mesh = mesh_of_triangles(points, std::move(made.mesh.triangles), std::move(made.mesh.materials), &used);
  best.particles = select(best.particles, used);
  for (std::size_t v = 0; v < used.size(); ++v) made.order[v] = made.order[used[v]], made.size[v] = made.size[used[v]];
  made.order.resize(used.size()), made.size.resize(used.size()), made.point_of.resize(used.size());
  std::iota(made.point_of.begin(), made.point_of.end(), 0u);
  renumber(made.touching, used);
  judge(best);
}

}  // namespace nacre
