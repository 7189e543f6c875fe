// Nacre: winds the triangles of a surface alike that several processes have in shares.
//
// Within a share, triangles are joined across their edges. What is left are its parts, which the edges to other shares
// join further: each part takes the lowest triangle that it hears of across an edge as its first one (hooking), then
// looks up what that has taken (pointer jumping), until no edge lies between two parts. This takes about log2 of the
// number of shares that a part winds through. Shiloach and Vishkin 1982, with the winding as a parity of each link.
#include "engine/scene/surface/winding_of_shares.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "compute/device/among_all.hpp"

namespace nacre {
namespace {

/// The first triangle of a part, as far as that is known.
struct Label {
  std::uint32_t rank = 0, number = 0;
  std::uint32_t flipped = 0;  ///< 1: wound otherwise than that one
  bool same_part(const Label& other) const { return rank == other.rank && number == other.number; }
  bool before(const Label& other) const { return rank != other.rank ? rank < other.rank : number < other.number; }
};

/// Across an edge to a triangle of another process.
struct Link {
  std::uint32_t triangle, rank, number, turned;
};

class Joined {
 public:
  Joined(Ranks& ranks, const SharedTriangles& mesh)
      : ranks_(ranks), mesh_(mesh), pairs_(pair_sides(mesh.same, mesh.triangles)), parent_(mesh.numbers) {
    for (std::uint32_t t = 0; t < parent_.size(); ++t) parent_[t] = {t, 0};
  }

  SharedWinding run() {
    SharedWinding winding;
    join_within();
    join_across();
    winding.report.contradictions = std::size_t(sum_of_all(&ranks_, within_ + across_));
    if (winding.report.contradictions > 0) return winding;
    settle(winding);
    return winding;
  }

 private:
  struct Parent {
    std::uint32_t number, flipped;
  };

  std::uint32_t self() const { return std::uint32_t(ranks_.rank()); }
  std::uint32_t number_of(std::size_t t) const { return mesh_.owner[t].number; }

  Parent root_of(std::uint32_t number) {
    std::uint32_t root = number, flipped = 0;
    while (parent_[root].number != root) flipped ^= parent_[root].flipped, root = parent_[root].number;
    for (std::uint32_t at = number, left = flipped; at != root;) {  // all on the way point at it from now on
      const Parent next = parent_[at];
      parent_[at] = {root, left};
      left ^= next.flipped;
      at = next.number;
    }
    return {root, flipped};
  }

  template <class Visit>
  void each_own(const Visit& visit) const {
    for (std::size_t t = mesh_.first; t < mesh_.first + mesh_.count; ++t)
      if (!pairs_.duplicate[t]) visit(std::uint32_t(t));
  }

  void join_within() {
    each_own([&](std::uint32_t t) {
      for (std::uint32_t side = 3 * t; side < 3 * t + 3; ++side) {
        const std::uint32_t twin = pairs_.twin[side];
        if (twin >= SidePairs::open_edge) continue;
        const Lent& other = mesh_.owner[twin / 3];
        const std::uint32_t turned = opposed(mesh_.same, mesh_.triangles, side, twin) ? 1 : 0;
        if (other.rank != self()) {
          links_.push_back({number_of(t), other.rank, other.number, turned});
          continue;
        }
        const Parent a = root_of(number_of(t)), b = root_of(other.number);
        const std::uint32_t flipped = a.flipped ^ b.flipped ^ turned;
        if (a.number == b.number)
          within_ += flipped;
        else
          parent_[std::max(a.number, b.number)] = {std::min(a.number, b.number), flipped};
      }
    });
    each_own([&](std::uint32_t t) {
      const std::uint32_t root = root_of(number_of(t)).number;
      if (root == number_of(t)) labels_[root] = {self(), root, 0};
    });
  }

  Label label_of(std::uint32_t number) {
    const Parent root = root_of(number);
    Label label = labels_.at(root.number);
    label.flipped ^= root.flipped;
    return label;
  }

  /// What a triangle across a link should be, relative to the first one of this part.
  struct Hint {
    std::uint32_t number;
    Label label;
  };

  void join_across() {
    for (;;) {
      ForEachRank<Hint> hints = for_each_rank<Hint>(ranks_);
      for (const Link& link : links_) {
        Label label = label_of(link.triangle);
        label.flipped ^= link.turned;
        hints[link.rank].push_back({link.number, label});
      }
      ForEachRank<Hint> wishes = for_each_rank<Hint>(ranks_);
      std::uint64_t wanted = 0;
      for (const std::vector<Hint>& from : exchange_items(ranks_, hints))
        for (const Hint& hint : from) {
          const Label own = label_of(hint.number);
          if (own.same_part(hint.label)) {
            across_ += own.flipped ^ hint.label.flipped;
          } else if (hint.label.before(own)) {
            Hint wish{own.number, hint.label};
            wish.label.flipped ^= own.flipped;
            wishes[own.rank].push_back(wish);
            ++wanted;
          }
        }
      if (sum_of_all(&ranks_, wanted) == 0) return;
      across_ = 0;  // they are found again
      for (const std::vector<Hint>& from : exchange_items(ranks_, wishes))
        for (const Hint& wish : from) {
          Label& label = labels_.at(wish.number);
          if (wish.label.before(label)) label = wish.label;
        }
      while (jump()) {
      }
    }
  }

  /// Each part takes what the first triangle that it has taken has taken. Returns whether a process found another one.
  bool jump() {
    ForEachRank<std::uint32_t> ask = for_each_rank<std::uint32_t>(ranks_);
    ForEachRank<Label*> asking(ask.size());
    for (auto& [root, label] : labels_) {
      if (label.rank == self() && label.number == root) continue;
      ask[label.rank].push_back(label.number);
      asking[label.rank].push_back(&label);
    }
    ForEachRank<Label> answers = for_each_rank<Label>(ranks_);
    const ForEachRank<std::uint32_t> asked = exchange_items(ranks_, ask);
    for (std::size_t q = 0; q < asked.size(); ++q)
      for (const std::uint32_t number : asked[q]) answers[q].push_back(labels_.at(number));
    const ForEachRank<Label> answered = exchange_items(ranks_, answers);
    std::uint64_t changed = 0;
    for (std::size_t q = 0; q < answered.size(); ++q)
      for (std::size_t k = 0; k < answered[q].size(); ++k) {
        Label& label = *asking[q][k];
        if (label.same_part(answered[q][k])) continue;
        const std::uint32_t flipped = label.flipped;
        label = answered[q][k];
        label.flipped ^= flipped;
        ++changed;
      }
    return sum_of_all(&ranks_, changed) > 0;
  }

  /// What is known of a part, of a share of it or of all.
  struct Part {
    std::uint32_t number = 0;  ///< of its first triangle
    std::uint32_t open = 0;
    std::uint64_t size = 0, flipped = 0;
    double extent = 0;
    WholeVolume volume;
    Vec3d origin;
  };

  /// Gives the owner of each part's first triangle what all processes know of it; `add(sum, part)`. `finish(sum)` at
  /// the owner; what it leaves there comes back.
  template <class Add, class Finish>
  void reduce(std::vector<Part>& parts, const Add& add, const Finish& finish) {
    ForEachRank<Part> send = for_each_rank<Part>(ranks_);
    ForEachRank<std::size_t> place(send.size());
    for (std::size_t k = 0; k < parts.size(); ++k) {
      send[ranks_of_parts_[k]].push_back(parts[k]);
      place[ranks_of_parts_[k]].push_back(k);
    }
    std::unordered_map<std::uint32_t, Part> sums;
    const ForEachRank<Part> received = exchange_items(ranks_, send);
    for (const std::vector<Part>& from : received)
      for (const Part& part : from) {
        const auto [sum, is_new] = sums.try_emplace(part.number, part);
        if (!is_new) add(sum->second, part);
      }
    for (auto& [number, sum] : sums) finish(sum);
    for (std::size_t q = 0; q < received.size(); ++q)
      for (const Part& part : received[q]) send[q].push_back(sums.at(part.number));
    const ForEachRank<Part> back = exchange_items(ranks_, send);
    for (std::size_t q = 0; q < back.size(); ++q)
      for (std::size_t k = 0; k < back[q].size(); ++k) parts[place[q][k]] = back[q][k];
  }

  /// Decides which of its two windings each part gets, as Orientation::settle does.
  void settle(SharedWinding& winding) {
    std::unordered_map<std::uint64_t, std::uint32_t> place;
    std::vector<Part> parts;
    std::vector<std::uint32_t> part_of(mesh_.numbers, 0), first_local(mesh_.numbers, 0);
    std::vector<std::uint8_t> flipped(mesh_.numbers, 0);
    each_own([&](std::uint32_t t) {
      const Label label = label_of(number_of(t));
      const std::uint64_t key = std::uint64_t(label.rank) << 32 | label.number;
      const auto [found, is_new] = place.try_emplace(key, std::uint32_t(parts.size()));
      if (is_new) {
        parts.emplace_back().number = label.number;
        ranks_of_parts_.push_back(label.rank);
      }
      part_of[number_of(t)] = found->second;
      first_local[number_of(t)] = t;
      flipped[number_of(t)] = std::uint8_t(label.flipped);
      Part& part = parts[found->second];
      ++part.size;
      part.flipped += label.flipped;
      for (std::uint32_t side = 3 * t; side < 3 * t + 3; ++side)
        if (pairs_.twin[side] == SidePairs::open_edge) part.open = 1;
    });
    reduce(
        parts,
        [](Part& sum, const Part& part) { sum.size += part.size, sum.flipped += part.flipped, sum.open |= part.open; },
        [&](Part& sum) { sum.origin = mesh_.points[mesh_.triangles[first_local[sum.number]].a]; });
    each_own([&](std::uint32_t t) {
      Part& part = parts[part_of[number_of(t)]];
      if (part.open) return;
      for (int k = 0; k < 3; ++k)
        part.extent = std::fmax(part.extent, axis_distance(part.origin, mesh_.points[mesh_.triangles[t][k]]));
    });
    reduce(
        parts, [](Part& sum, const Part& part) { sum.extent = std::fmax(sum.extent, part.extent); }, [](Part&) {});
    each_own([&](std::uint32_t t) {
      Part& part = parts[part_of[number_of(t)]];
      const Triangle& c = mesh_.triangles[t];
      if (!part.open)
        part.volume.add(part.origin, part.extent, mesh_.points[c.a], mesh_.points[c.b], mesh_.points[c.c],
                        flipped[number_of(t)] != 0);
    });
    WindingReport& report = winding.report;
    const auto turns = [](const Part& part) {
      const int sign = part.volume.sign();
      return !part.open && sign != 0 ? sign < 0 : 2 * part.flipped > part.size;
    };
    reduce(
        parts, [](Part& sum, const Part& part) { sum.volume.add(part.volume); },
        [&](Part& sum) {
          report.flipped += std::size_t(std::min(sum.flipped, sum.size - sum.flipped));
          report.turned_parts += turns(sum) != (2 * sum.flipped > sum.size);
        });
    winding.of_own.assign(mesh_.numbers, Winding::kept);
    for (std::size_t t = mesh_.first; t < mesh_.first + mesh_.count; ++t) {
      const std::uint32_t number = number_of(t);
      report.duplicates += pairs_.duplicate[t] != 0;
      winding.of_own[number] = pairs_.duplicate[t]                                       ? Winding::duplicate
                               : (flipped[number] != 0) != turns(parts[part_of[number]]) ? Winding::turned
                                                                                         : Winding::kept;
    }
    for (std::size_t* count : {&report.duplicates, &report.flipped, &report.turned_parts})
      *count = std::size_t(sum_of_all(&ranks_, *count));
  }

  Ranks& ranks_;
  const SharedTriangles& mesh_;
  const SidePairs pairs_;
  std::vector<Parent> parent_;                       ///< by number; a tree for each part of the share
  std::unordered_map<std::uint32_t, Label> labels_;  ///< of the roots of these trees
  std::vector<Link> links_;
  std::vector<std::uint32_t> ranks_of_parts_;
  std::uint64_t within_ = 0, across_ = 0;  ///< contradictions
};

}  // namespace

SharedWinding wind_shares(Ranks& ranks, const SharedTriangles& mesh) { return Joined(ranks, mesh).run(); }

}  // namespace nacre
