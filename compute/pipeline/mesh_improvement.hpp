// Nacre: makes triangles of the particles, and changes particles until the triangles are good.
//
// Each operation has one name:
// - to smooth: particles move within the rings of triangles around them;
// - to remesh: particles that spoil triangles are removed, and missing ones are added;
// - an attempt: smoothing or remeshing at bad triangles only, undone where the triangles are no better afterwards;
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

#include "compute/meshing/attempt.hpp"
#include "compute/meshing/defects.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/repair.hpp"
#include "compute/meshing/star_counts.hpp"
#include "compute/meshing/star_finder.hpp"
#include "compute/meshing/star_patches.hpp"
#include "compute/meshing/surface_mesh.hpp"
#include "compute/pipeline/kept_nearest.hpp"
#include "compute/pipeline/mesh_deviation.hpp"
#include "compute/pipeline/movable_particles.hpp"
#include "compute/pipeline/stage_progress.hpp"

namespace nacre {

/// How many rounds of improvement there may be, and on how many threads.
struct ImprovementRule {
  int smooth = 2;                           ///< rounds of smoothing all particles
  int remesh = 12;                          ///< rounds of remeshing, at most; each attempt counts as one
  bool stars = false;                       ///< triangles from stars, where these are sound, and polished
  double most_unsettled = 1;                ///< share of the stars: with more, cells are used from the start
  bool thorough = false;                    ///< goes on until no triangle is below wanted_ratio, not worst_defects
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
/// remeshed, then all particles are smoothed, then there are attempts at what is still bad. The best mesh after
/// smoothing is kept. With `rule.stars`, each of these is polished, and no more is done once one is as good as is
/// asked; without, all triangles are facets of Delaunay cells. Where the deviation is bounded, particles are added in
/// the triangles above the bound, in turn with further attempts.
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
    double fitness = 0;  ///< see nacre::fitness; below 0: the number of positions where it touches itself

    Attempt::View view() const { return {mesh, point_of, order, touching}; }
  };

  /// The mesh that is the best so far, and its particles.
  struct Kept {
    Triangulated made;
    HostParticles particles;
    std::int64_t mediocre = 0;                             ///< of its points, at triangles below wanted_ratio
    bool acceptable = false;                               ///< as it is, nothing is to be tried with cells
    std::int64_t flips = 0, contractions = 0, splits = 0;  ///< of edges
    DeviationRefinement further;                           ///< what would bring it nearer to its interfaces
    MeshDeviation deviation;
  };

  void settle(std::optional<Kept>& best);
  void refine(Kept& best);
  Kept polished(const Triangulated& made);
  std::int64_t edit(Kept& kept, std::vector<std::uint8_t>& fixed);
  std::int64_t split(Kept& kept, std::vector<std::uint8_t>& fixed);
  bool is_good(const Kept& kept) const;
  bool nearer_to_good(const Kept& a, const Kept& b) const;
  static bool is_acceptable(const Triangulated& made);
  void patch(Kept& best);
  void patch_at_unacceptable(const Triangulated& made);
  bool stars() const { return rule_.stars && star_use_.fallbacks == 0; }
  bool polishes() const { return rule_.stars && rule_.deviation == 0; }
  void forget_tried(DeviationRefinement& further);
  bool add_where_far(Triangulated& made, const DeviationRefinement& further, bool smooths);
  static std::vector<std::uint8_t> bad_points(const Triangulated& made, double ratio = wanted_ratio);
  static double fitness_of(const Triangulated& made);
  static bool better_shaped(const Kept& a, const Kept& b);
  static bool better(const Kept& a, const Kept& b);
  void measure(Kept& kept);

  Triangulated triangulate();
  bool triangulate_by_stars(const HostParticles& particles, std::span<const Vec3d> points, Triangulated& made);
  void triangulate_by_cells(std::span<const Vec3d> points, Triangulated& made);
  bool improve(Triangulated& made);
  bool begin_attempt(Triangulated& made, std::span<const std::uint8_t> bad);
  bool continue_attempt(Triangulated& made);
  bool take_back_attempt();
  std::int64_t smooth(Triangulated& made, std::span<const std::uint8_t> moving, const SmoothingRule& rule = {});
  bool remesh(const Triangulated& made, const DefectRule& rule, std::span<const std::uint8_t> there = {});
  double fraction() const;

  MovableParticles& particles_;
  const JunctionTable& table_;
  const VolumeFrame& frame_;
  ImprovementRule rule_;
  const TellStage& tell_;
  Delaunay delaunay_;  ///< of all particles,
  std::unique_ptr<StarDevice> star_device_;
  StarFinder star_finder_;
  PatchCells patch_cells_;  ///< and of those where stars do not settle
  StarUse star_use_;
  int smoothed_ = 0, remeshed_ = 0;  ///< rounds so far
  static constexpr std::int64_t most_bad = std::int64_t(1) << 40;
  std::int64_t bad_ = most_bad;     ///< points at bad triangles when the last attempt began
  int in_vain_ = 0;                 ///< polished meshes in a row that were no better
  std::uint32_t tried_ = 0;         ///< kinds of attempts so far
  std::optional<Attempt> attempt_;  ///< the one in progress,
  HostParticles before_;            ///< what was there before it,
  int further_ = 0;                 ///< and its rounds after the first
  DeviationInfo deviation_;
  KeptNearest on_junctions_;                      ///< where the deviation is measured
  std::unordered_set<std::uint64_t> refined_at_;  ///< hashes of the points that were added for it
};

}  // namespace nacre
