// Nacre: where stars do not settle, the Delaunay triangulation of the particles around decides.
#include "compute/meshing/star_patches.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "compute/math/disjoint_sets.hpp"
#include "compute/math/sort_unique.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/labels_beside.hpp"
#include "compute/meshing/labels_in_void.hpp"
#include "compute/meshing/near_points.hpp"
#include "compute/meshing/repair_at.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/meshing/star_seams.hpp"

namespace nacre {
namespace {

constexpr int patch_rounds = 100;
constexpr double around = 3;  // sizes: as far as the particles are that a patch is made of

// Where patches have a larger share of all particles, or more of them were triangulated in all rounds, mostly again,
// cells of all are quicker.
constexpr double most_in_patches = 0.6, most_work = 3;

/// Corners of a box far around all particles: no facet at a particle is on the hull.
class Guards {
 public:
  static constexpr int count = 8;

  explicit Guards(const PatchWorld& world) {
    Vec3d low = world.points[0], high = world.points[0];
    for (const Vec3d& p : world.points) low = min(low, p), high = max(high, p);
    // In steps, so that guards are in the same places as a rule, and the triangulation has less to do again.
    half_ =
        std::exp2(std::ceil(std::log2(length(high - low) + *std::max_element(world.size.begin(), world.size.end()))));
    const double step = half_ / 4;
    for (int a = 0; a < 3; ++a) middle_[a] = step * std::round((low[a] + high[a]) / (2 * step));
  }

  void add(PatchCells::Points& points) const {
    for (int k = 0; k < count; ++k) {
      // At no corner of a cube exactly, so that no four lie in a plane with others.
      const double far = (6 + 0.37 * k) * half_;
      points.places.push_back(middle_ + Vec3d(k & 1 ? far : -far, k & 2 ? 1.1 * far : -far, k & 4 ? 0.9 * far : -far));
      points.size.push_back(half_);
      points.wanted.push_back(0);
    }
  }

 private:
  Vec3d middle_;  // of a ball around all particles
  double half_ = 0;
};

/// Delaunay cells of some of the particles, and the facets between materials.
class Patch {
 public:
  /// `kept` are triangles of stars that settled, corners as numbers of points: the cells beside them have the materials
  /// on their sides, wherever the centres are.
  Patch(std::shared_ptr<const PatchCells::Made> made, const StarMesh& kept)
      : made_(std::move(made)), label_(made_->label) {
    label_beside(made_->cells, kept.triangles, kept.materials, label_);
    label_void(made_->cells, wanted_members(), label_);
    facets_ = interface_facets(made_->cells, label_);
  }

  /// At the wanted members only: between the parts of the patch, where particles are missing, labels mean nothing.
  void repair(const std::atomic<bool>* stop) {
    const PatchCells::Points& points = made_->points;
    std::vector<std::uint16_t> label = label_;
    defects_ = repair_labels_at(wanted_members(), points.places, made_->cells, label, stop).defects;
    facets_ = interface_facets(made_->cells, label);
  }

  const InterfaceFacets& facets() const { return facets_; }
  const std::vector<std::array<std::uint32_t, 2>>& defects() const { return defects_; }

 private:
  std::span<const std::uint8_t> wanted_members() const {
    return std::span(made_->points.wanted).first(made_->points.wanted.size() - Guards::count);
  }

  std::shared_ptr<const PatchCells::Made> made_;
  std::vector<std::uint16_t> label_;  // per cell
  InterfaceFacets facets_;
  std::vector<std::array<std::uint32_t, 2>> defects_;
};

/// Particles where surfaces are pinched are unsettled, too.
void unsettle_pinched(StarMesh& mesh, std::size_t particles) {
  const std::vector<std::uint32_t> pinched = at_pinched_joints(mesh, particles);
  mesh.unsettled.insert(mesh.unsettled.end(), pinched.begin(), pinched.end());
  sort_unique(mesh.unsettled);
}

/// Removes the elements of these numbers, which ascend.
template <class T>
void remove_at(std::vector<T>& all, std::span<const std::uint32_t> numbers) {
  if (numbers.empty()) return;
  auto to = all.begin() + numbers[0];
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto end = k + 1 < numbers.size() ? all.begin() + numbers[k + 1] : all.end();
    to = std::copy(all.begin() + numbers[k] + 1, end, to);
  }
  all.erase(to, all.end());
}

/// Groups of bad particles, which grow until their facets meet the triangles of stars around them.
class Settling {
 public:
  Settling(const StarMesh& stars, const PatchWorld& world, PatchCells& cells, const std::atomic<bool>* stop)
      : stars_(stars),
        world_(world),
        cells_(cells),
        stop_(stop),
        guards_(world),
        bad_(world.points.size(), 0),
        near_(bad_),
        sets_(bad_.size()),
        group_of_(bad_.size(), none),
        number_(group_of_),
        marked_(bad_),
        corners_(stars.triangles, bad_.size()) {
    for (const std::uint32_t i : stars.unsettled) bad_[i] = 1;
    unsettled_ = bad_;
    for (const std::uint32_t i :
         select_where(bad_.size(), [&](std::size_t i) { return cells.was_in_patch(world.points[i]); }))
      bad_[i] = 1;
  }

  /// Parts of the patch that have no particle within reach in common. Returns how many particles those have that are
  /// new or have grown since they were asked for last: these are to be made again.
  std::size_t regroup() {
    std::vector<std::uint32_t> all = marked(bad_);
    std::vector<std::uint32_t> more;
    std::set_difference(all.begin(), all.end(), all_bad_.begin(), all_bad_.end(), std::back_inserter(more));
    all_bad_ = std::move(all);
    for_points_near(world_.points, more, world_.size, around, [&](std::uint32_t i, std::span<const std::uint32_t> bad) {
      near_[i] = 1;
      for (const std::uint32_t b : bad) sets_.join(i, b);
    });
    const std::vector<std::uint32_t> members = marked(near_);
    members_ = members.size();
    std::vector<std::uint32_t> roots;
    for (const std::uint32_t i : members) roots.push_back(sets_.find(i));
    std::vector<Group> groups;
    std::vector<std::uint32_t> grown_from;  // of each: the largest group that is part of it now, or none
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::uint32_t i = members[k];
      const std::uint32_t was_in = group_of_[i];
      if (roots[k] == i) group_of_[i] = std::uint32_t(groups.size()), groups.emplace_back(), grown_from.push_back(none);
      group_of_[i] = group_of_[roots[k]];
      Group& group = groups[group_of_[i]];
      number_[i] = std::uint32_t(group.members.size());
      group.members.push_back(i);
      group.bad += bad_[i];
      std::uint32_t& largest = grown_from[group_of_[i]];
      if (was_in != none && (largest == none || size_of(largest) < size_of(was_in))) largest = was_in;
    }
    std::size_t changed = 0;
    for (std::size_t k = 0; k < groups.size(); ++k) {
      Group& group = groups[k];
      Group* before = grown_from[k] == none ? nullptr : &groups_[grown_from[k]];
      // Groups only grow: as many are the same.
      if (before && before->bad == group.bad && before->members.size() == group.members.size()) {
        group = std::move(*before);
        continue;
      }
      changed += group.members.size();
      group.delaunay = before ? std::move(before->delaunay) : cells_.delaunay();
    }
    groups_ = std::move(groups);
    return changed;
  }

  /// Makes the cells of groups that have none.
  void make(bool repairs) {
    std::vector<std::uint32_t> fresh;
    std::vector<PatchCells::Wanted> wanted;
    for (std::uint32_t k = 0; k < groups_.size(); ++k)
      if (!groups_[k].patch) fresh.push_back(k), wanted.push_back({points_of(groups_[k]), groups_[k].delaunay.get()});
    const auto made = cells_.make(std::move(wanted), world_, stop_);
    tbb::parallel_for(std::size_t(0), fresh.size(), [&](std::size_t i) {
      Group& group = groups_[fresh[i]];
      group.patch.emplace(made[i], kept_in(group));
      if (repairs) group.patch->repair(stop_);
      list_at_bad(group);
    });
  }

  void repair() {
    tbb::parallel_for(std::size_t(0), groups_.size(), [&](std::size_t k) {
      Group& group = groups_[k];
      group.patch->repair(stop_);
      list_at_bad(group);
      group.edges_match = group.no_pinches = false;
    });
  }

  /// Edges and vertices at bad particles where the surface still touches itself.
  std::vector<std::array<std::uint32_t, 2>> touching() const {
    std::vector<std::array<std::uint32_t, 2>> touching;
    for (const Group& group : groups_)
      for (const auto& defect : group.patch->defects()) {
        if (std::max(defect[0], defect[1]) >= group.members.size()) continue;
        const std::array<std::uint32_t, 2> particles = {group.members[defect[0]], group.members[defect[1]]};
        if (bad_[particles[0]] || bad_[particles[1]]) touching.push_back(particles);
      }
    for (const Group& group : groups_) touching.insert(touching.end(), group.touching.begin(), group.touching.end());
    sort_unique(touching);
    return touching;
  }

  /// Adds what lies at edges that do not match, or at pinched vertices; false where that is nothing new. Looks only at
  /// groups whose cells were made since they were found to be without such.
  bool grow(bool repaired) {
    std::vector<std::uint32_t> open;
    const StarMesh at_changed = join(&Group::edges_match);
    for (Group& group : groups_)
      if (!group.edges_match) group.edges_match = true, group.touching.clear();
    for (const EdgeFault& fault : edge_faults(at_changed, marked_)) {
      const bool inside = bad_[fault.ends[0]] && bad_[fault.ends[1]];
      // Cells alone may touch themselves, too: then that is how the particles are.
      if (!fault.open && repaired && inside) {
        groups_[group_of_[fault.ends[0]]].touching.push_back(fault.ends);
        continue;
      }
      open.insert(open.end(), fault.ends.begin(), fault.ends.end());
      if (inside) groups_[group_of_[fault.ends[0]]].edges_match = false;
    }
    bool any = false;
    for (const std::uint32_t i : open) any = any || !bad_[i], bad_[i] = 1;
    stuck_ = !open.empty() && !any;
    if (!open.empty()) return any;
    pinched_ = false;
    const StarMesh beside_fans = join(&Group::no_pinches);
    for (Group& group : groups_) group.no_pinches = true;
    for (const std::uint32_t i : at_pinched_vertices(beside_fans, marked_)) {
      if (bad_[i]) pinched_ = true, groups_[group_of_[i]].no_pinches = false;
      any = any || !bad_[i], bad_[i] = 1;
    }
    return any;
  }

  /// In `stars`, facets of cells in place of the triangles at bad particles.
  void replace(StarMesh& stars) const {
    const std::vector<std::uint32_t> gone =
        select_where(stars.triangles.size(), [&](std::size_t i) { return at_bad_one(stars.triangles[i]); });
    const auto join = [&](const Triangle& t) { stars.joined.insert(stars.joined.end(), {t.a, t.b, t.c}); };
    for (const std::uint32_t i : gone) join(stars.triangles[i]);
    remove_at(stars.triangles, gone), remove_at(stars.materials, gone);
    for (const Group& group : groups_) {
      for (const Triangle& t : group.at_bad.triangles) join(t);
      stars.triangles.insert(stars.triangles.end(), group.at_bad.triangles.begin(), group.at_bad.triangles.end());
      stars.materials.insert(stars.materials.end(), group.at_bad.materials.begin(), group.at_bad.materials.end());
    }
  }

  std::size_t members() const { return members_; }  ///< particles that patches are made of
  bool stuck() const { return stuck_; }             ///< edges do not match where all is of cells
  bool touches() const { return stuck_ || pinched_; }
  bool is_bad(std::uint32_t i) const { return bad_[i]; }
  std::int64_t count() const { return std::count(bad_.begin(), bad_.end(), 1); }

 private:
  /// Bad particles whose reaches overlap, with all that is within these.
  struct Group {
    std::vector<std::uint32_t> members;  // ascending
    std::int64_t bad = 0;                // of these
    std::unique_ptr<Delaunay> delaunay;
    std::optional<Patch> patch;
    StarMesh at_bad;                                     // facets at bad ones; corners are particles
    std::vector<std::array<std::uint32_t, 2>> touching;  // edges where its cells alone touch themselves
    bool edges_match = false, no_pinches = false;        // checked since its cells were made
  };

  std::size_t size_of(std::uint32_t group) const { return groups_[group].members.size(); }

  PatchCells::Points points_of(const Group& group) const {
    PatchCells::Points points;
    for (const std::uint32_t i : group.members) {
      points.places.push_back(world_.points[i]);
      points.size.push_back(world_.size[i]);
      points.wanted.push_back(bad_[i]);
    }
    guards_.add(points);
    return points;
  }

  /// Facets at the bad particles of those groups for which `checked` is false, and all triangles that have a corner in
  /// common with them or with the triangles of stars that they replace. Marks these corners.
  StarMesh join(bool Group::*checked) {
    std::fill(marked_.begin(), marked_.end(), 0);
    const auto mark = [&](const Triangle& t) { marked_[t.a] = marked_[t.b] = marked_[t.c] = 1; };
    for (const Group& group : groups_) {
      if (group.*checked) continue;
      for (const Triangle& t : group.at_bad.triangles) mark(t);
      for (const std::uint32_t i : group.members) {
        if (!bad_[i]) continue;
        marked_[i] = 1;
        // A triangle of a star that is gone leaves its edges to facets that may not be there.
        for (const std::uint32_t corner : corners_.corners(i)) mark(stars_.triangles[corner / 3]);
      }
    }
    StarMesh joined;
    for (const std::uint32_t v : marked(marked_))
      for (const std::uint32_t corner : corners_.corners(v)) {
        const Triangle& t = stars_.triangles[corner / 3];
        const bool seen = (t.a < v && marked_[t.a]) || (t.b < v && marked_[t.b]) || (t.c < v && marked_[t.c]);
        if (seen || at_bad_one(t)) continue;
        joined.triangles.push_back(t);
        joined.materials.push_back(stars_.materials[corner / 3]);
      }
    for (const Group& group : groups_)
      for (std::size_t i = 0; i < group.at_bad.triangles.size(); ++i) {
        const Triangle& t = group.at_bad.triangles[i];
        if (!marked_[t.a] && !marked_[t.b] && !marked_[t.c]) continue;
        joined.triangles.push_back(t);
        joined.materials.push_back(group.at_bad.materials[i]);
      }
    return joined;
  }

  /// Triangles of stars within a group, all of whose corners have settled: where a patch has grown over them, its cells
  /// are to follow them.
  StarMesh kept_in(const Group& group) const {
    const std::uint32_t own = group_of_[group.members[0]];
    const auto is_kept = [&](std::uint32_t i) { return group_of_[i] == own && !unsettled_[i]; };
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t i : group.members)
      for (const std::uint32_t corner : corners_.corners(i)) {
        const Triangle& t = stars_.triangles[corner / 3];
        if (t.a == i && is_kept(t.a) && is_kept(t.b) && is_kept(t.c)) numbers.push_back(corner / 3);
      }
    std::sort(numbers.begin(), numbers.end());
    StarMesh kept;
    for (const std::uint32_t k : numbers) {
      const Triangle& t = stars_.triangles[k];
      kept.triangles.push_back({number_[t.a], number_[t.b], number_[t.c]});
      kept.materials.push_back(stars_.materials[k]);
    }
    return kept;
  }

  void list_at_bad(Group& group) const {
    group.at_bad = {};
    const InterfaceFacets& facets = group.patch->facets();
    for (std::size_t i = 0; i < facets.triangles.size(); ++i) {
      const Triangle& f = facets.triangles[i];
      if (std::max({f.a, f.b, f.c}) >= group.members.size()) continue;  // a guard
      const Triangle t{group.members[f.a], group.members[f.b], group.members[f.c]};
      if (at_bad_one(t)) group.at_bad.triangles.push_back(t), group.at_bad.materials.push_back(facets.materials[i]);
    }
  }

  bool at_bad_one(const Triangle& t) const { return bad_[t.a] || bad_[t.b] || bad_[t.c]; }

  const StarMesh& stars_;
  const PatchWorld& world_;
  PatchCells& cells_;
  const std::atomic<bool>* stop_;
  Guards guards_;
  std::vector<std::uint8_t> bad_;
  std::vector<std::uint8_t> unsettled_;  // those that were bad from the start
  std::vector<std::uint32_t> all_bad_;   // when members were asked for last
  std::vector<std::uint8_t> near_;       // within reach of these
  std::size_t members_ = 0;              // how many are
  DisjointSets sets_;                    // particles within reach of the same ones
  std::vector<Group> groups_;
  std::vector<std::uint32_t> group_of_, number_;  // per particle near: its group, and its place in the list of this
  std::vector<std::uint8_t> marked_;              // corners of triangles at bad ones, of stars or facets
  VertexTable corners_;                           // of the triangles of stars
  bool stuck_ = false, pinched_ = false;
};

}  // namespace

bool settle_by_cells(StarMesh& mesh, const PatchWorld& world, PatchCells& cells,
                     std::vector<std::array<std::uint32_t, 2>>& touching, const std::atomic<bool>* stop) {
  touching.clear();
  if (world.points.empty()) return false;
  unsettle_pinched(mesh, world.points.size());
  cells.begin();
  Settling settling(mesh, world, cells, stop);
  if (settling.count() == 0) return !mesh.triangles.empty();
  bool repairs = false;
  double work = 0;  // particles triangulated
  for (int round = 0; round < patch_rounds; ++round) {
    work += double(settling.regroup());
    const auto all = double(world.points.size());
    const bool too_much = double(settling.members()) >= most_in_patches * all || work >= most_work * all;
    if (too_much && all > 1000) return false;
    settling.make(repairs);
    if (settling.grow(repairs)) continue;
    if (settling.touches() && !repairs) {
      repairs = true;
      settling.repair();
      if (settling.grow(repairs)) continue;
    }
    if (settling.stuck()) return false;
    touching = settling.touching();
    settling.replace(mesh);
    if (mesh.triangles.empty()) return false;
    mesh.counts.in_patches = settling.count();
    for (std::size_t i = 0; i < world.points.size(); ++i)
      if (settling.is_bad(std::uint32_t(i))) cells.keep_in_patch(world.points[i]);
    mesh.unsettled.clear();
    return true;
  }
  return false;
}

}  // namespace nacre
