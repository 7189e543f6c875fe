// Nacre: changes the points around bad triangles, and undoes the change where it did not help.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/defects.hpp"
#include "compute/meshing/patches.hpp"

namespace nacre {

/// Follows points while some move, go and come. Points are numbered as they are given: those that stay keep their
/// order, new ones come behind. A mesh of them names them by `point_of`, ascending, and may leave some out.
class Attempt {
 public:
  /// What a mesh shows of its points, and its points of them.
  struct View {
    const SurfaceMesh& mesh;
    std::span<const std::uint32_t> point_of;                 ///< per point of the mesh
    std::span<const std::uint8_t> order;                     ///< per point of the mesh: of its junction
    std::span<const std::array<std::uint32_t, 2>> touching;  ///< points of the mesh where it touches itself
  };
  /// One of the points before the attempt, or of those now.
  struct Source {
    bool before;
    std::uint32_t point;
  };

  /// Of `points` points, whose mesh is bad at its points `bad` (marks). Triangles are judged by `rule`.
  Attempt(std::size_t points, const View& before, std::span<const std::uint8_t> bad, const DefectRule& rule);

  /// Some of the points now have gone, others have come, so that there are `points`.
  void change(std::span<const std::uint8_t> gone, std::size_t points);
  /// Compares each patch with what it was before; once after each change, by the mesh of the points now.
  void judge(const View& now);
  /// Marks the points of the mesh last judged that are in patches with triangles below the rule, before and still: to
  /// go on with. Empty where there are none.
  std::vector<std::uint8_t> open(const View& now) const;
  /// The points with those patches put back that are no better than before, in order; empty where all are better.
  std::vector<Source> taken_back() const;

 private:
  bool worse(std::uint32_t patch) const { return patch != none && !(fitness_[patch] > fitness_before_[patch]); }

  DefectRule rule_;
  std::vector<std::uint32_t> patch_before_, now_of_;  ///< per point before; the latter `none` where it has gone
  std::vector<std::uint32_t> patch_;                  ///< per point now
  std::vector<double> fitness_before_, fitness_;      ///< per patch
};

}  // namespace nacre
