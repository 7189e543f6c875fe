// Nacre: which points coincide, and triangles wound alike.
#include "engine/scene/surface/winding.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace nacre {
namespace {

constexpr std::uint32_t no_twin = SidePairs::no_twin, open_edge = SidePairs::open_edge;

/// One side of one triangle, listed under the smaller of its two points.
struct Side {
  std::uint32_t larger;    // the edge's other point
  std::uint32_t opposite;  // the triangle's third point
  std::uint32_t id;        // 3 * triangle + corner where the side starts

  friend bool operator<(const Side& s, const Side& t) {
    if (s.larger != t.larger) return s.larger < t.larger;
    if (s.opposite != t.opposite) return s.opposite < t.opposite;
    return s.id < t.id;
  }
};

/// All sides by their smaller point (`first[point]` to `first[point + 1]`), sorted, so that an edge's sides and
/// duplicates among its triangles stand together.
struct SideTable {
  std::vector<std::size_t> first;
  std::vector<Side> sides;
};

SideTable list_sides(std::span<const std::uint32_t> same, std::span<const Triangle> triangles) {
  SideTable table;
  table.first.assign(same.size() + 2, 0);
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) ++table.first[std::min(same[t[k]], same[t[(k + 1) % 3]]) + 2];
  for (std::size_t p = 2; p < table.first.size(); ++p) table.first[p] += table.first[p - 1];
  table.sides.resize(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const std::uint32_t v[3] = {same[t.a], same[t.b], same[t.c]};
    for (int k = 0; k < 3; ++k) {
      const auto [small, large] = std::minmax(v[k], v[(k + 1) % 3]);
      table.sides[table.first[small + 1]++] = {large, v[(k + 2) % 3], std::uint32_t(3 * i + k)};
    }
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, same.size(), 4096), [&](const auto& range) {
    for (std::size_t p = range.begin(); p < range.end(); ++p)
      std::sort(table.sides.begin() + table.first[p], table.sides.begin() + table.first[p + 1]);
  });
  return table;
}

/// Calls `visit(begin, end)` for the sides of each edge.
template <class Visit>
void for_each_edge(const SideTable& table, const Visit& visit) {
  for (std::size_t p = 0; p + 2 < table.first.size(); ++p)
    for (std::size_t i = table.first[p], end = i; i < table.first[p + 1]; i = end) {
      while (end < table.first[p + 1] && table.sides[end].larger == table.sides[i].larger) ++end;
      visit(&table.sides[i], &table.sides[0] + end);
    }
}

std::vector<char> find_duplicates(const SideTable& table, std::size_t triangles) {
  std::vector<char> duplicate(triangles, 0);
  for_each_edge(table, [&](const Side* begin, const Side* end) {
    for (const Side* side = begin + 1; side < end; ++side)
      if (side->opposite == side[-1].opposite) duplicate[side->id / 3] = 1;
  });
  return duplicate;
}

/// For each side the one across the edge, or no_twin or open_edge. Duplicates have no neighbours.
std::vector<std::uint32_t> find_twins(const SideTable& table, const std::vector<char>& duplicate) {
  std::vector<std::uint32_t> twin(table.sides.size(), no_twin);
  for_each_edge(table, [&](const Side* begin, const Side* end) {
    std::uint32_t found[2] = {};
    std::size_t count = 0;
    for (const Side* side = begin; side < end; ++side)
      if (!duplicate[side->id / 3]) {
        if (count < 2) found[count] = side->id;
        ++count;
      }
    if (count == 2) {
      twin[found[0]] = found[1];
      twin[found[1]] = found[0];
    } else if (count % 2 == 1) {
      for (const Side* side = begin; side < end; ++side) twin[side->id] = open_edge;
    }
  });
  return twin;
}

/// The walk over one part after another.
class Orientation {
 public:
  Orientation(std::span<const Vec3d> points, std::span<const std::uint32_t> same, std::vector<Triangle>& triangles,
              const std::vector<std::uint32_t>& twin, WindingReport& report)
      : points_(points),
        same_(same),
        triangles_(triangles),
        twin_(twin),
        report_(report),
        state_(triangles.size(), State::unseen),
        open_(triangles.size(), 1) {}

  void run(const std::vector<char>& duplicate) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (state_[t] == State::unseen && !duplicate[t]) {
        walk(t);
        settle();
      }
    report_.contradictions /= 2;  // met from both sides
  }

  const std::vector<std::uint8_t>& open() const { return open_; }

 private:
  enum class State : char { kept, flipped, unseen };

  void walk(std::uint32_t start) {
    part_.assign(1, start);
    state_[start] = State::kept;
    closed_ = true;
    for (std::size_t i = 0; i < part_.size(); ++i)
      for (std::uint32_t side = 3 * part_[i]; side < 3 * part_[i] + 3; ++side) {
        if (twin_[side] == open_edge) closed_ = false;
        if (twin_[side] < open_edge) step_across(side, twin_[side]);
      }
  }

  void step_across(std::uint32_t side, std::uint32_t other) {
    const bool turned = opposed(same_, triangles_, side, other);
    const State wanted = (state_[side / 3] == State::flipped) != turned ? State::flipped : State::kept;
    State& state = state_[other / 3];
    if (state == State::unseen) {
      state = wanted;
      part_.push_back(other / 3);
    } else if (state != wanted) {
      ++report_.contradictions;
      closed_ = false;
    }
  }

  /// Decides which of its two windings the part just walked gets, and applies it.
  void settle() {
    const std::size_t flipped =
        std::count_if(part_.begin(), part_.end(), [&](auto t) { return state_[t] == State::flipped; });
    const bool majority_flipped = 2 * flipped > part_.size();
    bool turn = majority_flipped;
    if (const int volume = closed_ ? volume_sign() : 0; volume != 0) {
      turn = volume < 0;
      report_.closed_triangles += part_.size();
      if (turn != majority_flipped) report_.turned_triangles += part_.size();
      for (const std::uint32_t t : part_) open_[t] = 0;
    }
    report_.flipped += std::min(flipped, part_.size() - flipped);
    report_.turned_parts += turn != majority_flipped;
    for (const std::uint32_t t : part_)
      if ((state_[t] == State::flipped) != turn) std::swap(triangles_[t].b, triangles_[t].c);
  }

  /// Of the volume, measured from a point of the part so that a far origin costs no digits.
  int volume_sign() const {
    const Vec3d origin = points_[triangles_[part_[0]].a];
    double extent = 0;
    for (const std::uint32_t i : part_)
      for (int k = 0; k < 3; ++k) extent = std::fmax(extent, axis_distance(origin, points_[triangles_[i][k]]));
    WholeVolume sum;
    for (const std::uint32_t i : part_) {
      const Triangle& t = triangles_[i];
      sum.add(origin, extent, points_[t.a], points_[t.b], points_[t.c], state_[i] == State::flipped);
    }
    return sum.sign();
  }

  std::span<const Vec3d> points_;
  std::span<const std::uint32_t> same_;
  std::vector<Triangle>& triangles_;
  const std::vector<std::uint32_t>& twin_;
  WindingReport& report_;
  std::vector<State> state_;
  std::vector<std::uint8_t> open_;
  std::vector<std::uint32_t> part_;
  bool closed_ = true;
};

}  // namespace

std::uint64_t position_hash(const Vec3d& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) {
    h ^= std::bit_cast<std::uint64_t>(p[axis] + 0.0);  // -0 becomes +0
    h *= 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  return h;
}

std::vector<std::uint32_t> first_at_position(std::span<const Vec3d> points) {
  std::vector<std::uint32_t> same(points.size());
  const std::size_t mask = std::bit_ceil(2 * points.size() + 2) - 1;
  std::vector<std::uint32_t> table(mask + 1, no_twin);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t slot = position_hash(points[i]) & mask;
    while (table[slot] != no_twin && !(points[table[slot]] == points[i])) slot = (slot + 1) & mask;
    if (table[slot] == no_twin || !is_finite(points[i])) {
      same[i] = std::uint32_t(i);
      if (is_finite(points[i])) table[slot] = std::uint32_t(i);
    } else {
      same[i] = table[slot];
    }
  }
  return same;
}

void WholeVolume::add(const Vec3d& origin, double extent, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                      bool flipped) {
  if (!(extent > 0)) return;
  const Vec3d p = (a - origin) / extent, q = (b - origin) / extent, r = (c - origin) / extent;
  const auto whole = std::int64_t(std::llrint(dot(p, cross(q, r)) * 0x1p60));  // the product is below 5.2
  const std::int64_t added = flipped ? -whole : whole;
  high += added >> 32;
  low += added & 0xffffffff;
}

SidePairs pair_sides(std::span<const std::uint32_t> same, std::span<const Triangle> triangles) {
  const SideTable table = list_sides(same, triangles);
  SidePairs pairs;
  pairs.duplicate = find_duplicates(table, triangles.size());
  pairs.twin = find_twins(table, pairs.duplicate);
  return pairs;
}

WindingReport make_winding_consistent(std::span<const Vec3d> points, std::span<const std::uint32_t> same,
                                      std::vector<Triangle>& triangles, std::vector<std::uint8_t>* open) {
  WindingReport report;
  const SidePairs pairs = pair_sides(same, triangles);
  const std::vector<char>& duplicate = pairs.duplicate;
  Orientation orientation(points, same, triangles, pairs.twin, report);
  orientation.run(duplicate);
  if (open) open->clear();
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (duplicate[t]) continue;
    triangles[kept++] = triangles[t];
    if (open) open->push_back(orientation.open()[t]);
  }
  report.duplicates = triangles.size() - kept;
  triangles.resize(kept);
  return report;
}

}  // namespace nacre
