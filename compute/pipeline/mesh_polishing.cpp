// Nacre: a mesh made better without triangulating it again: edges are edited and split and points smoothed in turn.
#include <algorithm>
#include <numeric>

#include "compute/meshing/edge_edits.hpp"
#include "compute/meshing/edge_splits.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/pipeline/mesh_improvement.hpp"

namespace nacre {
namespace {

constexpr int most_rounds = 8;

/// How far from bad points is cut, sizes: an edit looks at two rings of triangles around one, and some follow others.
constexpr double polish_reach = 5;
}  // namespace

/// Marks the points of a mesh at triangles that are bad by `rule`, and where it touches itself.
std::vector<std::uint8_t> MeshImprovement::bad_points(const Triangulated& made, const DefectRule& rule) {
  std::vector<std::uint8_t> bad = points_at_bad(made.mesh, made.order, rule);
  for (const auto& defect : made.touching)
    for (const std::uint32_t point : defect) bad[point] = 1;
  return bad;
}

/// What polishing aims at: what is asked, or more.
DefectRule MeshImprovement::polish_rule() const { return rule_.aim.ratio < wanted_ratio ? mediocre : rule_.aim; }

bool MeshImprovement::better_shaped(const Kept& a, const Kept& b) {
  if (a.acceptable != b.acceptable) return a.acceptable;
  return a.made.fitness != b.made.fitness ? a.made.fitness > b.made.fitness : a.mediocre < b.mediocre;
}

/// Changes bad triangles by their edges. `fixed` marks points; those are added where a curve goes that their particles
/// are not on. Returns how many changes it made.
std::int64_t MeshImprovement::edit(Kept& kept, std::vector<std::uint8_t>& fixed) {
  Triangulated& made = kept.made;
  std::vector<std::uint8_t> order = made.order;
  for (const auto& defect : made.touching)
    for (const std::uint32_t point : defect) order[point] = 0;  // stays: remeshing has to find it
  const EdgeEdits edits = edit_edges(made.mesh, order, polish_rule());
  const auto keep = [&](auto& of_points) {
    for (std::size_t v = 0; v < edits.kept.size(); ++v) of_points[v] = of_points[edits.kept[v]];
    of_points.resize(edits.kept.size());
  };
  keep(made.point_of), keep(made.order), keep(made.size), keep(fixed);
  renumber(made.touching, edits.kept);
  for (const std::uint32_t v : edits.crossed) fixed[v] = 1;
  kept.flips += edits.flips, kept.contractions += edits.contractions;
  return edits.flips + edits.contractions;
}

/// Splits long edges of bad triangles by new particles. Returns how many.
std::int64_t MeshImprovement::split(Kept& kept, std::vector<std::uint8_t>& fixed) {
  Triangulated& made = kept.made;
  std::vector<EdgeSplit> splits = edges_to_split(made.mesh, made.order, made.size, polish_rule());
  if (splits.empty()) return 0;
  std::vector<Vec3d> middle;
  std::vector<Junction> junction;
  for (const auto& [ends, point] : splits) {
    middle.push_back(point.position);
    junction.push_back(point.third == 0xffff ? Junction(point.materials[0], point.materials[1])
                                             : Junction(point.materials[0], point.materials[1], point.third));
  }
  const std::vector<Vec3d> on = particles_.onto_junctions(middle, junction, true);
  std::vector<MeshDefects::NewPoint> born;
  for (std::size_t k = 0; k < splits.size(); ++k) {
    born.push_back(splits[k].point);
    if (is_finite(on[k])) born.back().position = on[k];
  }
  const auto before = std::size_t(particles_.count());
  const std::vector<std::uint32_t> taken = particles_.replace(std::vector<std::uint8_t>(before, 0), born);
  for (std::size_t k = 0; k < taken.size(); ++k) splits[k] = splits[taken[k]];
  splits.resize(taken.size());
  const std::vector<Float4> position = particles_.download().position;
  std::vector<Vec3d> at;
  for (std::size_t i = before; i < position.size(); ++i)
    at.push_back(frame_.to_world({position[i].x, position[i].y, position[i].z}));
  const std::vector<std::uint32_t> done = split_edges(made.mesh, made.order, splits, at, polish_rule());
  for (const std::uint32_t k : done) {
    made.point_of.push_back(std::uint32_t(before + k));
    made.order.push_back(splits[k].point.third == 0xffff ? 2 : 1);
    made.size.push_back(position[before + k].w * float(frame_.unit));
    fixed.push_back(0);
  }
  kept.splits += std::int64_t(done.size());
  return std::int64_t(done.size());
}

/// Polishes what is around bad triangles, cut out of the mesh, and puts back what became better.
void MeshImprovement::polish(Kept& best) {
  Cut cut;
  particles_.in_stage("remesh",
                      [&] { cut = cut_out(best, marked(bad_points(best.made, polish_rule())), polish_reach); });
  if (cut.point.empty()) return;
  particles_.upload(cut.piece.particles);
  const Kept now = polished(cut.piece.made);
  particles_.in_stage("remesh", [&] {
    if (take_better(best, cut, now)) drop_unused(best);
  });
  best.flips = now.flips, best.contractions = now.contractions, best.splits = now.splits;
}

/// The best that edits and smoothing make of a mesh of the particles. What is kept has the particles of its mesh alone.
MeshImprovement::Kept MeshImprovement::polished(const Triangulated& made) {
  Kept now, best;
  now.made = made;
  std::vector<std::uint8_t> fixed(made.mesh.points.size(), 0), bad;
  for (int round = 0; round <= most_rounds; ++round) {
    std::int64_t changes = 0;
    particles_.in_stage("remesh", [&] {
      changes = edit(now, fixed) + split(now, fixed);
      bad = judge(now);
    });
    const bool better = round == 0 || better_shaped(now, best);
    if (better) best = now, best.particles = select(particles_.download(), now.made.point_of);
    if (now.mediocre == 0 || rule_.smooth == 0 || !(better || changes > 0)) break;
    for (std::size_t v = 0; v < bad.size(); ++v) bad[v] &= !fixed[v];
    smooth(now.made, bad);
  }
  std::iota(best.made.point_of.begin(), best.made.point_of.end(), 0u);
  return best;
}

}  // namespace nacre
