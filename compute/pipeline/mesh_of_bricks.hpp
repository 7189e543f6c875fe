// Nacre: the triangles that a process needs for its bricks, from processes that have the surface in shares.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compute/device/among_all.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// What lies in the own bricks of a process and in its halo. Triangles are in the order of the whole surface. A point
/// that several processes have in their shares is here once for each of them.
class MeshOfBricks {
 public:
  /// `share`: of FlowMesh::shared; `begin`, `depth`: of OctreeShare; `radius`: of the band, in cells. Collective.
  MeshOfBricks(Ranks& ranks, const FlowMesh& share, const FlowDomain& domain, int levels,
               std::span<const std::uint64_t> begin, int depth);

  FlowMesh mesh() const { return {points_, triangles_, corner_normals_}; }
  std::span<const std::uint32_t> numbers() const { return numbers_; }  ///< of the triangles in the whole surface
  std::uint64_t bytes() const;
  std::size_t share_points() const { return share_points_; }

  /// What belongs to the points of the shares, for those that are here. Collective.
  template <class Value>
  void take(std::span<const Value> share, std::span<Value> here) const {
    ForEachRank<Value> send = for_each_rank<Value>(ranks_);
    for (std::size_t q = 0; q < send.size(); ++q) {
      send[q].reserve(lent_[q].size());
      for (const std::uint32_t p : lent_[q]) send[q].push_back(share[p]);
    }
    Value* to = here.data();
    for (const std::vector<Value>& from : exchange_items(ranks_, send)) to = std::copy(from.begin(), from.end(), to);
  }

  /// Values to colour by: those of the share become those that are here, at least one; if no process has any, none.
  /// Collective.
  void take_scalar(std::vector<float>& values) const {
    if (sum_of_all(&ranks_, values.size()) == 0) return;
    std::vector<float> here(std::max<std::size_t>(1, points_.size()));
    take(std::span<const float>(values), std::span<float>(here));
    values = std::move(here);
  }

 private:
  Ranks& ranks_;
  std::size_t share_points_;
  std::vector<Vec3d> points_;  ///< world; of each process in turn
  std::vector<Triangle> triangles_;
  std::vector<Vec3f> corner_normals_;
  std::vector<std::uint32_t> numbers_;
  ForEachRank<std::uint32_t> lent_;  ///< points of the share that others have here
};

}  // namespace nacre
