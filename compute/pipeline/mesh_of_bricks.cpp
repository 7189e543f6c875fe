// Nacre: the triangles that a process needs for its bricks, from processes that have the surface in shares.
#include "compute/pipeline/mesh_of_bricks.hpp"

#include <utility>

#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/brick_ranges.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/math/sort_unique.hpp"

namespace nacre {
namespace {

constexpr double brick_width = BrickOctreeView::width;
// Cells beyond the band. A triangle may be the closest of a cell within the first of them. The octree is built from
// clusters of triangles, around which it looks for bricks as far as the second (a ball around several triangles is
// smaller, and so is that of one that is not looked at exactly): each brick that it looks at has to have its triangles.
constexpr double triangle_margin = 1, brick_margin = 9;

/// A brick and a process that has to do with it.
struct BrickRank {
  std::uint64_t code;
  std::uint64_t rank;
  friend auto operator<=>(const BrickRank&,
                          const BrickRank&) = default;  // NOLINT(modernize-use-nullptr): a false alarm
};

/// A triangle on its way: corners among the points that go with it.
struct SentTriangle {
  std::uint32_t number;
  Triangle corners;
  Vec3f normal[3];
};

/// Which bricks are near which triangles of a share.
class NearBricks {
 public:
  NearBricks(const FlowMesh& share, const FlowDomain& domain, int levels, double beyond_band)
      : share_(share), domain_(domain), bricks_(1 << levels), margin_((domain.radius + beyond_band) / brick_width) {}

  /// Calls `visit(code)` for all that have a cell in the band of triangle `t`, and some more.
  template <class Visit>
  void of(std::size_t t, const Visit& visit) const {
    const Triangle& c = share_.triangles[t];
    const auto at = [&](std::uint32_t p) { return domain_.to_grid(share_.points[p]) * (1 / brick_width); };
    for_cells_near({at(c.a), at(c.b), at(c.c)}, margin_, bricks_, [&](const Int3& brick) { visit(morton(brick)); });
  }

  std::vector<std::uint64_t> of_all() const {
    std::vector<std::uint64_t> codes;
    std::size_t sorted = 0;
    for (std::size_t t = 0; t < share_.triangles.size(); ++t) {
      of(t, [&](std::uint64_t code) { codes.push_back(code); });
      if (codes.size() < 2 * sorted + (1 << 16)) continue;
      sort_unique(codes);
      sorted = codes.size();
    }
    sort_unique(codes);
    return codes;
  }

 private:
  const FlowMesh& share_;
  const FlowDomain& domain_;
  Int3 bricks_;
  double margin_;
};

/// For bricks near triangles of this share, the processes that want these, ascending. Each process tells the owners of
/// bricks where it has triangles; owners know then which bricks there are; whoever wants some asks their owners, who
/// pass it on to those who have triangles there.
std::vector<BrickRank> find_wishes(Ranks& ranks, const NearBricks& near, int levels,
                                   std::span<const std::uint64_t> begin, int depth) {
  const auto owner_of = [&](std::uint64_t code) {
    return std::size_t(std::upper_bound(begin.begin(), begin.end() - 1, code) - begin.begin()) - 1;
  };
  const auto ask_owners = [&](const std::vector<std::uint64_t>& codes) {
    ForEachRank<std::uint64_t> send = for_each_rank<std::uint64_t>(ranks);
    for (const std::uint64_t code : codes) send[owner_of(code)].push_back(code);
    return exchange_items(ranks, send);
  };
  std::vector<BrickRank> sources;
  std::vector<std::uint64_t> own;
  const ForEachRank<std::uint64_t> told = ask_owners(near.of_all());
  for (std::size_t q = 0; q < told.size(); ++q)
    for (const std::uint64_t code : told[q]) sources.push_back({code, q}), own.push_back(code);
  std::sort(sources.begin(), sources.end());
  sort_unique(own);
  ForEachRank<BrickRank> send = for_each_rank<BrickRank>(ranks);
  const ForEachRank<std::uint64_t> wanted = ask_owners(codes_around(own, depth, levels));
  for (std::size_t q = 0; q < wanted.size(); ++q)
    for (const std::uint64_t code : wanted[q]) {
      auto source = std::lower_bound(sources.begin(), sources.end(), BrickRank{code, 0});
      for (; source != sources.end() && source->code == code; ++source) send[source->rank].push_back({code, q});
    }
  std::vector<BrickRank> wishes;
  for (const std::vector<BrickRank>& from : exchange_items(ranks, send))
    wishes.insert(wishes.end(), from.begin(), from.end());
  std::sort(wishes.begin(), wishes.end());
  return wishes;
}

/// The triangles of the share for each process.
ForEachRank<std::uint32_t> triangles_for(Ranks& ranks, const FlowMesh& share, const NearBricks& near,
                                         const std::vector<BrickRank>& wishes) {
  ForEachRank<std::uint32_t> chosen = for_each_rank<std::uint32_t>(ranks);
  for (std::uint32_t t = 0; t < share.triangles.size(); ++t)
    near.of(t, [&](std::uint64_t code) {
      auto wish = std::lower_bound(wishes.begin(), wishes.end(), BrickRank{code, 0});
      for (; wish != wishes.end() && wish->code == code; ++wish) {
        std::vector<std::uint32_t>& to = chosen[wish->rank];
        if (to.empty() || to.back() != t) to.push_back(t);
      }
    });
  return chosen;
}

}  // namespace

MeshOfBricks::MeshOfBricks(Ranks& ranks, const FlowMesh& share, const FlowDomain& domain, int levels,
                           std::span<const std::uint64_t> begin, int depth)
    : ranks_(ranks), share_points_(share.points.size()), lent_(for_each_rank<std::uint32_t>(ranks)) {
  const NearBricks bricks(share, domain, levels, brick_margin), near(share, domain, levels, triangle_margin);
  const std::vector<BrickRank> wishes = find_wishes(ranks, bricks, levels, begin, depth);
  ForEachRank<std::uint32_t> chosen = triangles_for(ranks, share, near, wishes);
  const std::vector<std::uint64_t> counts = values_of_all(&ranks, share.triangles.size());
  std::uint64_t first = 0;
  for (int q = 0; q < ranks.rank(); ++q) first += counts[std::size_t(q)];
  ForEachRank<SentTriangle> triangles = for_each_rank<SentTriangle>(ranks);
  ForEachRank<Vec3d> points = for_each_rank<Vec3d>(ranks);
  std::vector<std::uint32_t> number(share.points.size(), none);
  for (std::size_t q = 0; q < chosen.size(); ++q) {
    const auto numbered = [&](std::uint32_t p) {
      if (number[p] == none) {
        number[p] = std::uint32_t(lent_[q].size());
        lent_[q].push_back(p);
        points[q].push_back(share.points[p]);
      }
      return number[p];
    };
    triangles[q].reserve(chosen[q].size());
    for (const std::uint32_t t : chosen[q]) {
      const Triangle& c = share.triangles[t];
      const Vec3f* normal = share.corner_normals.data() + 3 * std::size_t(t);
      triangles[q].push_back(
          {std::uint32_t(first + t), {numbered(c.a), numbered(c.b), numbered(c.c)}, {normal[0], normal[1], normal[2]}});
    }
    for (const std::uint32_t p : lent_[q]) number[p] = none;
    std::vector<std::uint32_t>().swap(chosen[q]);
  }
  std::vector<std::uint32_t> first_point;
  for (const std::vector<Vec3d>& from : exchange_items(ranks, points)) {
    first_point.push_back(std::uint32_t(points_.size()));
    points_.insert(points_.end(), from.begin(), from.end());
  }
  const ForEachRank<SentTriangle> received = exchange_items(ranks, triangles);
  for (std::size_t q = 0; q < received.size(); ++q)
    for (const SentTriangle& t : received[q]) {
      const std::uint32_t p = first_point[q];
      numbers_.push_back(t.number);
      triangles_.push_back({t.corners.a + p, t.corners.b + p, t.corners.c + p});
      corner_normals_.insert(corner_normals_.end(), t.normal, t.normal + 3);
    }
}

std::uint64_t MeshOfBricks::bytes() const {
  std::uint64_t lent = 0;
  for (const std::vector<std::uint32_t>& points : lent_) lent += points.size();
  return points_.size() * sizeof(Vec3d) + triangles_.size() * (sizeof(Triangle) + 3 * sizeof(Vec3f) + 4) + 4 * lent;
}

}  // namespace nacre
