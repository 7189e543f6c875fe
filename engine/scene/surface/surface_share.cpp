// Nacre: a surface that several processes have in shares.
#include "engine/scene/surface/surface_share.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "compute/device/among_all.hpp"
#include "compute/device/byte_hash.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/sheets.hpp"
#include "engine/scene/surface/winding.hpp"
#include "engine/scene/surface/winding_of_shares.hpp"

namespace nacre {
namespace {

/// A triangle on its way to a process whose share it touches.
struct SentTriangle {
  std::uint32_t number;  ///< in the share that it is from
  std::uint64_t id[3];
  Vec3d corner[3];
};

struct Neighbour {
  std::uint32_t position, rank;
};

/// Which positions of a share are also in others. Each position is known by the process that its hash names.
std::vector<Neighbour> find_neighbours(Ranks& ranks, std::span<const Vec3d> points,
                                       std::span<const std::uint32_t> same) {
  const auto count = static_cast<std::uint64_t>(ranks.count());
  ForEachRank<Vec3d> send = for_each_rank<Vec3d>(ranks);
  ForEachRank<std::uint32_t> sent = for_each_rank<std::uint32_t>(ranks);
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (same[p] != p) continue;
    const auto q = std::size_t(position_hash(points[p]) % count);
    send[q].push_back(points[p]);
    sent[q].push_back(p);
  }
  std::vector<Vec3d> all;
  std::vector<Neighbour> from;  // number in what a process sent, and which
  const ForEachRank<Vec3d> received = exchange_items(ranks, send);
  for (std::uint32_t q = 0; q < received.size(); ++q)
    for (std::uint32_t k = 0; k < received[q].size(); ++k) {
      all.push_back(received[q][k]);
      from.push_back({k, q});
    }
  const std::vector<std::uint32_t> first = first_at_position(all);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;  // all but the first at a position
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (first[i] != i) shared.emplace_back(first[i], i);
  std::sort(shared.begin(), shared.end());
  ForEachRank<Neighbour> answers = for_each_rank<Neighbour>(ranks);
  std::vector<std::uint32_t> together;
  for (std::size_t k = 0; k < shared.size();) {
    together.assign(1, shared[k].first);
    for (const std::uint32_t at = shared[k].first; k < shared.size() && shared[k].first == at; ++k)
      together.push_back(shared[k].second);
    for (const std::uint32_t i : together)
      for (const std::uint32_t j : together)
        if (i != j) answers[from[i].rank].push_back({from[i].position, from[j].rank});
  }
  std::vector<Neighbour> neighbours;
  const ForEachRank<Neighbour> answered = exchange_items(ranks, answers);
  for (std::size_t q = 0; q < answered.size(); ++q)
    for (const Neighbour& each : answered[q]) neighbours.push_back({sent[q][each.position], each.rank});
  std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.position != b.position ? a.position < b.position : a.rank < b.rank;
  });
  return neighbours;
}

/// The steps of `prepare`, with what touches the share around it.
class SharePreparation {
 public:
  SharePreparation(Ranks& ranks, const Surface& share, std::span<const std::uint64_t> point_id)
      : ranks_(ranks), own_(share), id_(point_id) {}

  PreparedShare run(double crease_degrees, std::vector<std::string>* warnings) {
    require_triangles(own_.triangles.size(), "the file lists none");
    lend();
    borrow();
    keep([&](std::size_t t) {
      const Triangle& c = triangles_[t];
      return same_[c.a] != same_[c.b] && same_[c.b] != same_[c.c] && same_[c.c] != same_[c.a];
    });
    std::uint64_t flat = own_.triangles.size() - count_;
    if (has_second_sheets()) {
      result_.whole_needed = "it may have two sheets in one place";
      return std::move(result_);
    }
    WindingReport winding;
    if (!wind(winding)) {
      result_.whole_needed = "it is one-sided";
      return std::move(result_);
    }
    const std::size_t before = count_;
    keep([&](std::size_t t) { return !has_no_area(result_.surface.points, triangles_[t]); });
    flat += before - count_;
    tell_repairs(winding, std::size_t(sum_of_all(&ranks_, flat)), warnings);
    finish(crease_degrees);
    return std::move(result_);
  }

 private:
  void require_triangles(std::uint64_t own, const char* why) {
    if (sum_of_all(&ranks_, own) == 0)
      throw Error("the surface has no triangles", why, "give a file with polygons or a volume mesh");
  }

  /// Sends the triangles that touch a position of another share there.
  void lend() {
    const std::vector<std::uint32_t> same = first_at_position(own_.points);
    const std::vector<Neighbour> neighbours = find_neighbours(ranks_, own_.points, same);
    std::vector<std::uint32_t> begin(own_.points.size() + 1, 0);
    for (const Neighbour& each : neighbours) ++begin[each.position + 1];
    for (std::size_t p = 0; p < own_.points.size(); ++p) begin[p + 1] += begin[p];
    lent_ = for_each_rank<std::uint32_t>(ranks_);
    sent_ = for_each_rank<SentTriangle>(ranks_);
    for (std::uint32_t t = 0; t < own_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t p = same[own_.triangles[t][k]];
        for (std::uint32_t i = begin[p]; i < begin[p + 1]; ++i) {
          std::vector<std::uint32_t>& to = lent_[neighbours[i].rank];
          if (!to.empty() && to.back() == t) continue;
          to.push_back(t);
          SentTriangle& sent = sent_[neighbours[i].rank].emplace_back();
          sent.number = t;
          for (int c = 0; c < 3; ++c) {
            sent.id[c] = id_[own_.triangles[t][c]];
            sent.corner[c] = own_.points[own_.triangles[t][c]];
          }
        }
      }
  }

  /// Takes the triangles that touch the share among its own, in the order of the whole.
  void borrow() {
    const ForEachRank<SentTriangle> borrowed = exchange_items(ranks_, sent_);
    std::vector<std::pair<std::uint64_t, Vec3d>> others;  // points that are not in the share
    const auto is_own = [&](std::uint64_t id) { return std::binary_search(id_.begin(), id_.end(), id); };
    for (const std::vector<SentTriangle>& from : borrowed) {
      std::vector<std::uint32_t>& numbers = borrowed_.emplace_back();
      for (const SentTriangle& t : from) {
        numbers.push_back(t.number);
        for (int k = 0; k < 3; ++k)
          if (!is_own(t.id[k])) others.emplace_back(t.id[k], t.corner[k]);
      }
    }
    const auto by_id = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(others.begin(), others.end(), by_id);
    others.erase(
        std::unique(others.begin(), others.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
        others.end());
    std::vector<Vec3d>& points = result_.surface.points;
    points = own_.points;
    for (const auto& [id, point] : others) points.push_back(point);
    Share& share = result_.share;
    share.ranks = &ranks_;
    share.points = own_.points.size();
    share.counted.assign(points.size(), 0);
    std::fill_n(share.counted.begin(), own_.points.size(), std::uint8_t(1));
    const auto number = [&](std::uint64_t id) {
      const auto own = std::lower_bound(id_.begin(), id_.end(), id);
      if (own != id_.end() && *own == id) return std::uint32_t(own - id_.begin());
      const auto other = std::lower_bound(others.begin(), others.end(), std::pair(id, Vec3d()), by_id);
      return std::uint32_t(own_.points.size() + std::size_t(other - others.begin()));
    };
    for (std::uint32_t q = 0; q < borrowed.size(); ++q) {
      if (int(q) == ranks_.rank()) {
        first_ = triangles_.size();
        count_ = own_.triangles.size();
        triangles_.insert(triangles_.end(), own_.triangles.begin(), own_.triangles.end());
        for (std::uint32_t t = 0; t < own_.triangles.size(); ++t) owner_.push_back({q, t});
      }
      for (const SentTriangle& t : borrowed[q]) {
        triangles_.push_back({number(t.id[0]), number(t.id[1]), number(t.id[2])});
        owner_.push_back({q, t.number});
        if (int(q) > ranks_.rank()) continue;
        for (const std::uint32_t p : {triangles_.back().a, triangles_.back().b, triangles_.back().c})
          share.counted[p] = 0;  // a process before this one has it
      }
    }
    same_ = first_at_position(points);
    share.peak_bytes = bytes_of(own_) + bytes_for(points.size(), triangles_.size());
    share.halo_bytes = bytes_for(points.size() - own_.points.size(), triangles_.size() - own_.triangles.size());
    std::uint64_t counted = 0;
    for (const std::uint8_t each : share.counted) counted += each;
    share.all_points = sum_of_all(&ranks_, counted);
  }

  static std::uint64_t bytes_of(const Surface& surface) {
    std::uint64_t bytes = surface.points.size() * sizeof(Vec3d) + surface.triangles.size() * sizeof(Triangle);
    for (const PointArray& array : surface.arrays) bytes += array.values.size() * sizeof(float);
    return bytes;
  }

  /// While winding is made consistent, which takes most: what is kept, and all sides of all triangles by their points.
  static std::uint64_t bytes_for(std::size_t points, std::size_t triangles) {
    constexpr std::size_t side = 12 + sizeof(std::uint32_t);  // with its twin
    return points * (sizeof(Vec3d) + 1 + 4 + sizeof(std::size_t)) +
           triangles * (sizeof(Triangle) + sizeof(Lent) + 3 * side + 1 + 5 * sizeof(std::uint32_t));
  }

  /// Drops the triangles for which `wanted(t)` is false.
  template <class Wanted>
  void keep(const Wanted& wanted) {
    std::size_t kept = 0, first = 0, count = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (t == first_) first = kept;
      if (!wanted(t)) continue;
      if (t >= first_ && t < first_ + count_) ++count;
      owner_[kept] = owner_[t];
      triangles_[kept++] = triangles_[t];
    }
    if (first_ >= triangles_.size()) first = kept;
    triangles_.resize(kept);
    owner_.resize(kept);
    first_ = first;
    count_ = count;
  }

  bool has_second_sheets() {
    const std::uint64_t arrays = sum_of_all(&ranks_, own_.arrays.size());
    if (arrays == 0) return false;
    return sum_of_all(&ranks_, find_second_sheets(result_.surface.points, same_, triangles_).suspected) > 0;
  }

  /// False where that cannot be done.
  bool wind(WindingReport& report) {
    const SharedTriangles mesh{
        result_.surface.points, same_, triangles_, owner_, first_, count_, std::uint32_t(own_.triangles.size())};
    const SharedWinding winding = wind_shares(ranks_, mesh);
    report = winding.report;
    if (report.contradictions > 0) return false;
    // Whoever has borrowed a triangle hears what has become of it.
    ForEachRank<Winding> send = for_each_rank<Winding>(ranks_);
    for (std::size_t q = 0; q < lent_.size(); ++q)
      for (const std::uint32_t t : lent_[q]) send[q].push_back(winding.of_own[t]);
    const ForEachRank<Winding> told = exchange_items(ranks_, send);
    std::vector<Winding> of(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto [rank, number] = owner_[t];
      const std::vector<std::uint32_t>& from = borrowed_[rank];
      of[t] = int(rank) == ranks_.rank()
                  ? winding.of_own[number]
                  : told[rank][std::size_t(std::lower_bound(from.begin(), from.end(), number) - from.begin())];
      if (of[t] == Winding::turned) std::swap(triangles_[t].b, triangles_[t].c);
    }
    keep([&](std::size_t t) { return of[t] != Winding::duplicate; });
    return true;
  }

  void finish(double crease_degrees) {
    require_triangles(count_, "each one has no area, or points that are missing or not finite");
    PreparedSurface& surface = result_.surface;
    surface.triangles = std::move(triangles_);
    std::vector<Lent>().swap(owner_);
    update_normals(surface, same_, crease_degrees);
    Share& share = result_.share;
    share.first_triangle = first_;
    share.triangles = count_;
    share.all_triangles = sum_of_all(&ranks_, count_);
    share.kept_bytes =
        surface.points.size() * (sizeof(Vec3d) + 1) + surface.triangles.size() * (sizeof(Triangle) + 3 * sizeof(Vec3f));
  }

  Ranks& ranks_;
  const Surface& own_;
  std::span<const std::uint64_t> id_;
  PreparedShare result_;
  ForEachRank<std::uint32_t> lent_, borrowed_;  ///< numbers of triangles with their processes, ascending
  ForEachRank<SentTriangle> sent_;
  std::vector<Triangle> triangles_;
  std::vector<Lent> owner_;
  std::vector<std::uint32_t> same_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace

Surface cut_share(const Surface& whole, std::size_t first, std::size_t last, std::vector<std::uint32_t>& used) {
  std::vector<std::uint32_t> number(whole.points.size(), none);
  for (std::size_t t = first; t < last; ++t)
    for (int k = 0; k < 3; ++k) number[whole.triangles[t][k]] = 0;
  used.clear();
  Surface share;
  for (std::uint32_t p = 0; p < number.size(); ++p)
    if (number[p] == 0) {
      number[p] = std::uint32_t(used.size());
      used.push_back(p);
      share.points.push_back(whole.points[p]);
    }
  for (std::size_t t = first; t < last; ++t) {
    const Triangle& c = whole.triangles[t];
    share.triangles.push_back({number[c.a], number[c.b], number[c.c]});
  }
  for (const PointArray& array : whole.arrays) {
    PointArray& part = share.arrays.emplace_back(PointArray{array.name, array.components, {}});
    if (array.size() != whole.points.size()) continue;
    const auto n = static_cast<std::size_t>(array.components);
    part.values.reserve(used.size() * n);
    for (const std::uint32_t p : used)
      part.values.insert(part.values.end(), array.values.begin() + std::ptrdiff_t(p * n),
                         array.values.begin() + std::ptrdiff_t((p + 1) * n));
  }
  return share;
}

SharedSeries share_series(const SurfaceSeries& whole, Ranks& ranks) {
  const auto cut = [&ranks](const Surface& surface, std::vector<std::uint32_t>& used) {
    const std::uint64_t n = surface.triangles.size(), rank = std::uint64_t(ranks.rank());
    const auto begin = [&](std::uint64_t r) { return std::size_t(n * r / std::uint64_t(ranks.count())); };
    return cut_share(surface, begin(rank), begin(rank + 1), used);
  };
  const Surface first = whole.load(0);
  std::uint64_t hash = hash_of(hash_begin, std::span<const Vec3d>(first.points));
  hash = hash_of(hash, std::span<const Triangle>(first.triangles));
  require_same(ranks, hash);
  SharedSeries shared{whole, {}};
  std::vector<std::uint32_t> used;
  cut(first, used);
  shared.point_id.assign(used.begin(), used.end());
  shared.series.load = [load = whole.load, cut](std::size_t step) {
    std::vector<std::uint32_t> points;
    return cut(load(step), points);
  };
  return shared;
}

PreparedShare prepare_share(Ranks& ranks, const Surface& share, std::span<const std::uint64_t> point_id,
                            double crease_degrees, std::vector<std::string>* warnings) {
  return SharePreparation(ranks, share, point_id).run(crease_degrees, warnings);
}

void require_same(Ranks& ranks, std::uint64_t hash) {
  const std::vector<std::uint64_t> all = values_of_all(&ranks, hash);
  const auto different = std::size_t(all.size()) - std::size_t(std::count(all.begin(), all.end(), all[0]));
  if (different > 0)
    throw Error(std::to_string(different) + " of " + std::to_string(all.size()) +
                    " processes have another input than the first",
                "the files or the options differ", "give all of them the same");
}

}  // namespace nacre
