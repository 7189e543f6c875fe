// Nacre: where stars do not settle, the Delaunay triangulation of the particles around decides.
#include "compute/meshing/star_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "compute/math/disjoint_sets.hpp"
#include "compute/math/sort_unique.hpp"
#include "compute/meshing/labels_beside.hpp"
#include "compute/meshing/labels_in_void.hpp"
#include "compute/meshing/near_points.hpp"
#include "compute/meshing/point_tree.hpp"
#include "compute/meshing/repair_at.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/meshing/star_seams.hpp"

namespace nacre {
namespace {

constexpr int patch_rounds = 100;
constexpr double around = 3;       // sizes: as far as the particles are that a patch is made of
constexpr double most_work = 0.6;  // particles triangulated in all rounds, by those that there are

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
  Patch(const Guards& guards, const PatchWorld& world, const std::atomic<bool>* stop)
      : guards_(&guards), world_(&world), stop_(stop) {}

  /// Of `members`, ascending; facets are wanted at those that are `wanted`. `kept` are triangles of stars that settled,
  /// corners as numbers of members: the cells beside them have the materials on their sides, wherever the centres are.
  void make(std::span<const std::uint32_t> members, std::vector<std::uint8_t> wanted, const StarMesh& kept,
            PatchCells& cells) {
    PatchCells::Points points;
    for (const std::uint32_t i : members)
      points.places.push_back(world_->points[i]), points.size.push_back(world_->size[i]);
    points.wanted = std::move(wanted);
    guards_->add(points);
    made_ = cells.make(std::move(points), *world_, stop_);
    label_ = made_->label;
    label_beside(made_->cells, kept.triangles, kept.materials, label_);
    label_void(made_->cells, wanted_members(), label_);
    facets_ = interface_facets(made_->cells, label_);
    defects_.clear();
  }

  /// At the wanted members only: between the parts of the patch, where particles are missing, labels mean nothing.
  void repair() {
    const PatchCells::Points& points = made_->points;
    std::vector<std::uint16_t> label = label_;
    defects_ = repair_labels_at(wanted_members(), points.places, made_->cells, label, stop_).defects;
    facets_ = interface_facets(made_->cells, label);
  }

  const InterfaceFacets& facets() const { return facets_; }
  const std::vector<std::array<std::uint32_t, 2>>& defects() const { return defects_; }

 private:
  std::span<const std::uint8_t> wanted_members() const {
    return std::span(made_->points.wanted).first(made_->points.wanted.size() - Guards::count);
  }

  const Guards* guards_;
  const PatchWorld* world_;
  const std::atomic<bool>* stop_;
  std::shared_ptr<const PatchCells::Made> made_;
  std::vector<std::uint16_t> label_;  // per cell
  InterfaceFacets facets_;
  std::vector<std::array<std::uint32_t, 2>> defects_;
};

/// Particles where surfaces are pinched are unsettled, too.
void add_pinched(StarMesh& mesh, std::size_t particles) {
  std::vector<std::uint8_t> marked(particles, 0);
  for (const std::uint32_t i : mesh.joined) marked[i] = 1;
  const std::vector<std::uint32_t> pinched = at_pinched_vertices(mesh, marked);
  mesh.unsettled.insert(mesh.unsettled.end(), pinched.begin(), pinched.end());
  std::sort(mesh.unsettled.begin(), mesh.unsettled.end());
  mesh.unsettled.erase(std::unique(mesh.unsettled.begin(), mesh.unsettled.end()), mesh.unsettled.end());
}

class Settling {
 public:
  Settling(const StarMesh& stars, const PatchWorld& world, const PatchCells& cells)
      : stars_(stars),
        world_(world),
        guards_(world),
        bad_(world.points.size(), 0),
        near_(bad_),
        sets_(bad_.size()),
        group_of_(bad_.size(), none),
        number_(group_of_),
        wide_(bad_) {
    for (const std::uint32_t i : stars.unsettled) bad_[i] = 1;
    unsettled_ = bad_;
    for (std::size_t i = 0; i < bad_.size(); ++i) bad_[i] = bad_[i] || cells.was_in_patch(world.points[i]);
  }

  /// Parts of the patch that have no particle within reach in common. Returns how many particles those have that are
  /// new or have grown since they were asked for last: these are to be made again.
  std::size_t regroup() {
    std::vector<std::uint32_t> all = marked(bad_);
    std::vector<std::uint32_t> more;
    std::set_difference(all.begin(), all.end(), all_bad_.begin(), all_bad_.end(), std::back_inserter(more));
    all_bad_ = std::move(all);
    mark_near(world_.points, more, world_.size, around, near_);
    const std::vector<std::uint32_t> members = marked(near_);
    join_around(more, members);
    std::vector<std::uint32_t> roots;
    for (const std::uint32_t i : members) roots.push_back(sets_.find(i));
    std::vector<Group> groups;
    for (std::size_t k = 0; k < members.size(); ++k) {
      if (roots[k] == members[k]) group_of_[members[k]] = std::uint32_t(groups.size()), groups.emplace_back();
      Group& group = groups[group_of_[roots[k]]];
      group_of_[members[k]] = group_of_[roots[k]];
      number_[members[k]] = std::uint32_t(group.members.size());
      group.members.push_back(members[k]);
      group.bad += bad_[members[k]];
    }
    std::size_t changed = 0;
    std::map<std::uint32_t, std::size_t> known;  // by the first member
    for (std::size_t k = 0; k < groups_.size(); ++k) known[groups_[k].members[0]] = k;
    for (Group& group : groups) {
      const auto at = known.find(group.members[0]);
      // Groups only grow: as many are the same.
      if (at != known.end() && groups_[at->second].bad == group.bad &&
          groups_[at->second].members.size() == group.members.size())
        group = std::move(groups_[at->second]);
      else
        changed += group.members.size();
    }
    groups_ = std::move(groups);
    return changed;
  }

  /// Makes the cells of groups that have none.
  void make(PatchCells& cells, const std::atomic<bool>* stop, bool repairs) {
    std::vector<StarMesh> kept(groups_.size());
    list_kept(kept);
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      Group& group = groups_[k];
      if (group.patch) continue;
      group.patch.emplace(guards_, world_, stop);
      group.patch->make(group.members, marks(group.members), kept[k], cells);
      if (repairs) group.patch->repair();
      list_at_bad(group);
    }
  }

  void repair() {
    for (Group& group : groups_) {
      group.patch->repair();
      list_at_bad(group);
    }
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
    touching.insert(touching.end(), touching_.begin(), touching_.end());
    sort_unique(touching);
    return touching;
  }

  /// Facets at bad particles, and the triangles of stars beside them.
  StarMesh join() {
    StarMesh at_bad;
    for (const Group& group : groups_) {
      at_bad.triangles.insert(at_bad.triangles.end(), group.at_bad.triangles.begin(), group.at_bad.triangles.end());
      at_bad.materials.insert(at_bad.materials.end(), group.at_bad.materials.begin(), group.at_bad.materials.end());
    }
    while (!mark_corners(at_bad)) look_around();
    StarMesh joined;
    for (const std::uint32_t i : around_) {
      const Triangle& t = stars_.triangles[i];
      if ((!marked_[t.a] && !marked_[t.b] && !marked_[t.c]) || at_bad_one(t)) continue;
      joined.triangles.push_back(t);
      joined.materials.push_back(stars_.materials[i]);
    }
    beside_ = joined.triangles.size();
    joined.triangles.insert(joined.triangles.end(), at_bad.triangles.begin(), at_bad.triangles.end());
    joined.materials.insert(joined.materials.end(), at_bad.materials.begin(), at_bad.materials.end());
    return joined;
  }

  /// Adds what lies at edges of the mesh joined last that do not match, or at pinched vertices; false where that is
  /// nothing new.
  bool grow(const StarMesh& joined, bool repaired) {
    std::vector<std::uint32_t> open;
    touching_.clear();
    for (const EdgeFault& fault : edge_faults(joined, marked_)) {
      // Cells alone may touch themselves, too: then that is how the particles are.
      const bool stays = !fault.open && repaired && bad_[fault.ends[0]] && bad_[fault.ends[1]];
      if (stays)
        touching_.push_back(fault.ends);
      else
        open.insert(open.end(), fault.ends.begin(), fault.ends.end());
    }
    bool any = false;
    for (const std::uint32_t i : open) any = any || !bad_[i], bad_[i] = 1;
    stuck_ = !open.empty() && !any;
    if (!open.empty()) return any;
    pinched_ = false;
    for (const std::uint32_t i : at_pinched_vertices(joined, marked_)) {
      pinched_ = pinched_ || bad_[i];
      any = any || !bad_[i], bad_[i] = 1;
    }
    return any;
  }

  /// In `stars`, facets of the mesh joined last in place of the triangles at bad particles.
  void replace(StarMesh& stars, const StarMesh& joined) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < stars.triangles.size(); ++i) {
      if (at_bad_one(stars.triangles[i])) continue;
      stars.triangles[kept] = stars.triangles[i];
      stars.materials[kept++] = stars.materials[i];
    }
    stars.triangles.resize(kept), stars.materials.resize(kept);
    const auto facets = std::ptrdiff_t(beside_);
    stars.triangles.insert(stars.triangles.end(), joined.triangles.begin() + facets, joined.triangles.end());
    stars.materials.insert(stars.materials.end(), joined.materials.begin() + facets, joined.materials.end());
  }

  bool stuck() const { return stuck_; }  ///< edges do not match where all is of cells
  bool touches() const { return stuck_ || pinched_; }
  bool is_bad(std::uint32_t i) const { return bad_[i]; }
  std::int64_t count() const { return std::count(bad_.begin(), bad_.end(), 1); }

 private:
  /// Bad particles whose reaches overlap, with all that is within these.
  struct Group {
    std::vector<std::uint32_t> members;  // ascending
    std::int64_t bad = 0;                // of these
    std::optional<Patch> patch;
    StarMesh at_bad;  // facets at bad ones; corners are particles
  };

  /// Joins what is within reach of each of `more`; all of that is among `members`.
  void join_around(std::span<const std::uint32_t> more, std::span<const std::uint32_t> members) {
    if (more.empty()) return;
    std::vector<Vec3d> places;
    for (const std::uint32_t i : members) places.push_back(world_.points[i]);
    const std::uint32_t first[2] = {0, std::uint32_t(places.size())};
    const PointTree tree(places, first);
    std::vector<PointTree::Found> found;
    for (const std::uint32_t i : more) {
      found.clear();
      tree.within(0, world_.points[i], around * world_.size[i], found);
      for (const PointTree::Found& f : found) sets_.join(i, members[f.point]);
    }
  }

  /// Triangles of stars within each group that has no cells yet, all of whose corners have settled: where a patch has
  /// grown over them, its cells are to follow them.
  void list_kept(std::vector<StarMesh>& kept) const {
    const auto is_kept = [&](std::uint32_t i) { return near_[i] && !unsettled_[i] && !groups_[group_of_[i]].patch; };
    for (const std::uint32_t i : select_where(stars_.triangles.size(), [&](std::size_t i) {
           const Triangle& t = stars_.triangles[i];
           return is_kept(t.a) && is_kept(t.b) && is_kept(t.c) && group_of_[t.a] == group_of_[t.b] &&
                  group_of_[t.a] == group_of_[t.c];
         })) {
      const Triangle& t = stars_.triangles[i];
      StarMesh& of_group = kept[group_of_[t.a]];
      of_group.triangles.push_back({number_[t.a], number_[t.b], number_[t.c]});
      of_group.materials.push_back(stars_.materials[i]);
    }
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

  std::vector<std::uint8_t> marks(std::span<const std::uint32_t> members) const {
    std::vector<std::uint8_t> marks;
    for (const std::uint32_t i : members) marks.push_back(bad_[i]);
    return marks;
  }

  /// Marks what the triangles at bad particles have for corners; false where `around_` lacks triangles at one of them.
  bool mark_corners(const StarMesh& at_bad) {
    marked_ = bad_;
    bool all = wide_reach_ > 0;
    const auto mark = [&](const Triangle& t) {
      for (int k = 0; k < 3; ++k) marked_[t[k]] = 1, all = all && wide_[t[k]];
    };
    for (const std::uint32_t i : all_bad_) all = all && wide_[i];
    for (const Triangle& t : at_bad.triangles) mark(t);
    // A triangle of a star that is gone leaves its edges to facets that may not be there.
    for (const std::uint32_t i : around_)
      if (at_bad_one(stars_.triangles[i])) mark(stars_.triangles[i]);
    return all;
  }

  /// Lists the triangles of stars at particles around bad ones, twice as far as is needed at first.
  void look_around() {
    wide_reach_ = wide_reach_ > 0 ? 2 * wide_reach_ : 2 * around;
    mark_near(world_.points, all_bad_, world_.size, wide_reach_, wide_);
    around_ = select_where(stars_.triangles.size(), [&](std::size_t i) {
      const Triangle& t = stars_.triangles[i];
      return wide_[t.a] || wide_[t.b] || wide_[t.c];
    });
  }

  bool at_bad_one(const Triangle& t) const { return bad_[t.a] || bad_[t.b] || bad_[t.c]; }

  const StarMesh& stars_;
  const PatchWorld& world_;
  Guards guards_;
  std::vector<std::uint8_t> bad_;
  std::vector<std::uint8_t> unsettled_;  // those that were bad from the start
  std::vector<std::uint32_t> all_bad_;   // when members were asked for last
  std::vector<std::uint8_t> near_;       // within reach of these
  DisjointSets sets_;                    // particles within reach of the same ones
  std::vector<Group> groups_;
  std::vector<std::array<std::uint32_t, 2>> touching_;  // edges where cells of the patch alone touch themselves
  std::vector<std::uint32_t> group_of_, number_;  // per particle near: its group, and its place in the list of this
  std::vector<std::uint8_t> marked_;              // corners of triangles at bad ones, of stars or facets
  std::vector<std::uint8_t> wide_;                // particles whose triangles are listed:
  std::vector<std::uint32_t> around_;             // triangles of stars
  double wide_reach_ = 0;                         // sizes; 0: none are listed yet
  std::size_t beside_ = 0;                        // triangles of stars in the mesh joined last
  bool stuck_ = false, pinched_ = false;
};

}  // namespace

bool settle_by_cells(StarMesh& mesh, const PatchWorld& world, PatchCells& cells,
                     std::vector<std::array<std::uint32_t, 2>>& touching, const std::atomic<bool>* stop) {
  touching.clear();
  if (world.points.empty()) return false;
  if (world.mirrored)
    for (Triangle& t : mesh.triangles) std::swap(t.b, t.c);
  add_pinched(mesh, world.points.size());
  cells.begin();
  Settling settling(mesh, world, cells);
  if (settling.count() == 0) return !mesh.triangles.empty();
  bool repairs = false;
  double work = 0;  // particles triangulated
  for (int round = 0; round < patch_rounds; ++round) {
    work += double(settling.regroup());
    if (world.points.size() > 1000 && work >= most_work * double(world.points.size())) return false;
    settling.make(cells, stop, repairs);
    StarMesh joined = settling.join();
    if (settling.grow(joined, repairs)) continue;
    if (settling.touches() && !repairs) {
      repairs = true;
      settling.repair();
      joined = settling.join();
      if (settling.grow(joined, repairs)) continue;
    }
    if (settling.stuck()) return false;
    touching = settling.touching();
    settling.replace(mesh, joined);
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
