// Nacre: makes triangles of the particles, and changes particles until the triangles are good.
//
// Each operation has one name:
// - to smooth: particles move within the rings of triangles around them;
// - to remesh: particles that spoil triangles are removed, and missing ones are added;
// - an attempt: what is around bad triangles is cut out, its particles are changed and triangulated anew; the outcome
//   is taken where its triangles are better (better_parts.hpp);
// - to project: particles are brought onto their interfaces, on the fields themselves;
// - to edit: edges of bad triangles are flipped or contracted (edge_edits.hpp); particles stay where they are;
// - to polish: edits and smoothing at bad triangles in turn; nothing is triangulated again;
// - to repair: labels of Delaunay cells are changed (repair.hpp); particles are not;
// - to improve: all of this together. (improve_cells.hpp improves tetrahedra, which have nothing to do with it.)
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "compute/meshing/better_parts.hpp"
#include "compute/meshing/defects.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/repair.hpp"
#include "compute/meshing/star_counts.hpp"
#include "compute/meshing/star_device.hpp"
#include "compute/meshing/star_patches.hpp"
#include "compute/meshing/surface_mesh.hpp"
#include "compute/pipeline/deviation_refinement.hpp"
#include "compute/pipeline/kept_nearest.hpp"
#include "compute/pipeline/movable_particles.hpp"
#include "compute/pipeline/stage_progress.hpp"

namespace nacre {

/// How many rounds of improvement there may be, and on how many threads.
struct ImprovementRule {
  int smooth = 2;                           ///< rounds of smoothing all particles
  int remesh = 12;                          ///< rounds of remeshing, at most; each attempt counts as one
  bool stars = false;                       ///< triangles from stars, where these are sound, and polished
  double most_unsettled = 1;                ///< share of the stars: with more, cells are used from the start
  DefectRule aim = worst_defects;           ///< goes on until no triangle is bad by this
  int threads = 0;                          ///< of the Delaunay triangulation; 0: all
  const std::atomic<bool>* stop = nullptr;  ///< throws Interrupted soon after it is set
  double deviation = 0;                     ///< largest of triangles from their interface, voxels; 0: any
  double detail = 0.25;                     ///< no particle is added nearer to others than 0.7 of this, voxels
};

/// A mesh and how many of its particles are at points, on curves, on surfaces.
struct ImprovedMesh {
  SurfaceMesh mesh;
  std::array<std::int64_t, 3> particles{};
  StarUse stars;
  DeviationInfo deviation;
};

/// Triangulates particles and changes them until the triangles are good, or get no better. First the clear defects are
/// remeshed, then all particles are smoothed, and the mesh is polished; then there are attempts at what is still bad,
/// which leave all else as it is. Where the deviation is bounded, particles are added in the triangles above the bound,
/// in turn with further attempts.
class MeshImprovement {
 public:
  /// All arguments must outlive the object.
  MeshImprovement(MovableParticles& particles, const JunctionTable& table, const VolumeFrame& frame,
                  const ImprovementRule& rule, const TellStage& tell);

  /// Leaves the particles that the mesh was made of. Throws Error where there are too few particles to triangulate.
  ImprovedMesh run();

 private:
  /// A mesh of the particles as they are.
  struct Triangulated {
    SurfaceMesh mesh;
    std::vector<std::uint32_t> point_of;                 ///< the particle at each of its points, ascending
    std::vector<std::array<std::uint32_t, 2>> touching;  ///< where it touches itself: two of its points, or one twice
    std::vector<std::uint8_t> order;                     ///< per point: of the junction that the mesh has there
    std::vector<float> size;                             ///< per point, world units
    std::vector<std::uint8_t> settled;                   ///< per point: has all its triangles; empty: all points have
    double fitness = 0;  ///< see nacre::fitness; below 0: the number of positions where it touches itself

    JudgedMesh judged() const { return {mesh, order, touching}; }
  };

  /// The mesh that is the best so far, and its particles.
  struct Kept {
    Triangulated made;
    HostParticles particles;
    std::int64_t mediocre = 0;                             ///< of its points, at triangles that could be better
    bool acceptable = false;                               ///< as it is, nothing is to be tried with cells
    std::int64_t flips = 0, contractions = 0, splits = 0;  ///< of edges
    DeviationRefinement further;                           ///< what would bring it nearer to its interfaces
    MeshDeviation deviation;
  };

  /// A mesh with all that is around some of its points, cut out of another.
  struct Cut {
    Kept piece;                           ///< points and triangles in the order of the whole
    std::vector<std::uint32_t> point;     ///< per point: its number in the whole
    std::vector<std::uint32_t> triangle;  ///< ... per triangle
    std::vector<std::uint8_t> bad;        ///< per point: what was cut out for
    std::vector<std::uint8_t> on_rim;     ///< per point: not all of its triangles are here
  };
  /// What an attempt does to the particles around bad points, before cells triangulate them anew.
  struct AttemptKind {
    int turns;    ///< of smoothing; 0: none
    bool shakes;  ///< smoothing begins from random positions
    bool remeshes;
    bool splits;    ///< ... the sides of curves, where that helps
    int rings = 1;  ///< of neighbours that move with them
  };

  Kept whole();
  Kept as_made(Triangulated made);
  void settle(Kept& best);
  void settle_unacceptable(Kept& best);
  bool attempt(Kept& best, const DefectRule& rule, std::size_t turns);
  bool attempt_at(Kept& best, std::span<const std::uint32_t> bad, const AttemptKind& kind);
  static Cut cut_out(const Kept& best, std::span<const std::uint32_t> bad, double reach);
  std::optional<Kept> attempted(const Cut& cut, const AttemptKind& kind);
  bool take_better(Kept& best, const Cut& cut, const Kept& now);
  static std::uint32_t put(Kept& best, const Kept& now, std::uint32_t v, std::uint32_t number);
  void drop_unused(Kept& best) const;
  std::optional<Triangulated> triangulate_again(const Triangulated& made, std::span<const std::uint8_t> gone,
                                                std::span<const std::uint8_t> loose);
  std::vector<std::uint8_t> judge(Kept& kept) const;
  DefectRule polish_rule() const;
  void refine(Kept& best);
  void polish(Kept& best);
  Kept polished(const Triangulated& made);
  std::int64_t edit(Kept& kept, std::vector<std::uint8_t>& fixed);
  std::int64_t split(Kept& kept, std::vector<std::uint8_t>& fixed);
  bool stars() const { return rule_.stars && star_use_.fallbacks == 0; }
  void drop_crowded(std::size_t first);
  void add_where_far(Triangulated& made, const DeviationRefinement& further, bool smooths);
  static std::vector<std::uint8_t> bad_points(const Triangulated& made, const DefectRule& rule);
  static double fitness_of(const Triangulated& made);
  static bool better_shaped(const Kept& a, const Kept& b);
  static bool better(const Kept& a, const Kept& b);
  void measure(Kept& kept);

  bool needs_patches() const;
  bool remeshes_first() const;
  Triangulated triangulate(bool patches = true);
  void finish(Triangulated& made, const HostParticles& particles) const;
  bool triangulate_by_stars(const HostParticles& particles, std::span<const Vec3d> points, bool patches,
                            Triangulated& made);
  static void take_without_patches(std::span<const Vec3d> points, StarMesh stars, Triangulated& made);
  static void take_triangles(std::span<const Vec3d> points, StarMesh stars,
                             std::vector<std::array<std::uint32_t, 2>> touching, Triangulated& made);
  static void add_pinched(Triangulated& made);
  void triangulate_by_cells(std::span<const Vec3d> points, Triangulated& made);
  bool improve(Triangulated& made);
  std::int64_t smooth(Triangulated& made, std::span<const std::uint8_t> moving, const SmoothingRule& rule = {});
  std::vector<std::uint8_t> remesh(const Triangulated& made, const DefectRule& rule,
                                   std::span<const std::uint8_t> there = {});
  double fraction() const;

  MovableParticles& particles_;
  const JunctionTable& table_;
  const VolumeFrame& frame_;
  ImprovementRule rule_;
  const TellStage& tell_;
  Delaunay delaunay_;  ///< of all particles,
  std::unique_ptr<StarDevice> star_device_;
  PatchCells patch_cells_;  ///< and of those where stars do not settle
  StarUse star_use_;
  int smoothed_ = 0, remeshed_ = 0;  ///< rounds so far
  std::uint32_t tried_ = 0;          ///< attempts so far
  DeviationInfo deviation_;
  KeptNearest on_junctions_;                      ///< where the deviation is measured
  std::unordered_set<std::uint64_t> refined_at_;  ///< hashes of the points that were added for it
};

}  // namespace nacre
