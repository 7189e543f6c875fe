// Nacre: from a volume of materials to a conformal mesh. The other of the two public doors.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compute/device/device.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/material_array.hpp"
#include "compute/math/lanes.hpp"
#include "compute/math/vec.hpp"
#include "compute/meshing/star_counts.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// What can be turned. Ranges and help are in the knob table (engine/scene/settings/knobs.hpp). Lengths are in voxels:
/// edges of the volume's smallest voxel spacing.
struct MeshParameters {
  std::string solver = "tree";         ///< tree (ch. 4), redblack (sec. 3.2), serial (sec. 3.1)
  double tighten = 1.2;                ///< width of the smoothing of label boundaries; 0: keep the staircase
  double stairs = 32;                  ///< how far ends of treads are looked for, to read staircases as slopes; 0: not
  double epsilon = 0.5;                ///< sizing: share of the local feature size
  double delta = 0.4;                  ///< sizing: largest slope (Lipschitz constant)
  double min_size = 0.5;               ///< sizing: smallest distance of particles
  double max_size = 1.0;               ///< sizing: largest distance of particles
  std::string sizes;                   ///< sizing: largest distances in materials and regions: size_bounds.hpp
  bool curvature = false;              ///< sizing: bound by epsilon / largest curvature, too
  double max_deviation = 0;            ///< of triangles from their interface, sizes shrink to keep it; 0: no bound
  std::string projection = "fields";   ///< tree: back onto interfaces by the fields, or by closest points: embedding
  int subcells = 1;                    ///< closest-point cells per voxel and axis; twice as many for thin sheets
  std::string kernel = "catmull-rom";  ///< reconstruction of fields: catmull-rom or b-spline
  double theta = 0.5;                  ///< tree: a node smaller than theta times its distance counts as one particle
  int coarse_iterations = 40;          ///< tree: of a quarter of the particles, before; 0: none
  int iterations = 70;                 ///< at most, per junction order
  double stagnation = 0.000125;        ///< ends when the energy falls by less, (E_prev - E) / E
  double step = 1.2;                   ///< tree: share of the Newton step
  double momentum = 0.85;              ///< tree: heavy ball
  double ideal_energy = 0;             ///< of a particle; 0: that of a hexagonal lattice with spacing h (0.7108)
  double add_below = 0.65;             ///< split particles with less than this share of the ideal energy
  double delete_above = 1.75;          ///< delete particles with more
  bool by_density = true;              ///< serial, redblack: control by the estimated density; false: the thesis's rule
  int control_every = 10;              ///< iterations between two controls of the population
  int smooth = 2;                      ///< rounds of moving particles within the triangles around them
  int remesh = 12;                     ///< rounds of remeshing bad triangles after the first triangulation, at most
  std::string triangles = "auto";      ///< stars, or delaunay: facets of cells; auto: stars for a draft
  std::string quality = "standard";    ///< draft, standard, best: see at_quality
  std::string seeds = "auto";          ///< embedding, marching-cubes; auto: the former for tree, the latter for others
  int particles = 0;                   ///< seed so many on surfaces, add none (sec. 3.4.3); 0: as the sizing field says
  std::uint32_t seed = 1;
};

/// Wanted sizes on a grid of its own, placed in the world as a MeshVolume.
struct SizeImage {
  Int3 dims{};
  Vec3d spacing{1, 1, 1}, origin{};
  std::array<Vec3d, 3> axes{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
  std::vector<float> size;  ///< per voxel, the largest distance of particles there, world units; 0: no wish
};

/// A volume on the host. Voxel (i, j, k), x fastest, has its centre at origin + axes * (index * spacing).
struct MeshVolume {
  enum class Kind {
    labels,      ///< `material` alone: boundaries are binary and get tightened
    indicators,  ///< one function per material in `values`: the largest wins
    scalar,      ///< one function in `values`, cut at `levels`: material m lies between levels[m - 1] and levels[m]
  };

  Kind kind = Kind::labels;
  Int3 dims{};
  Vec3d spacing{1, 1, 1};  ///< > 0, world units
  Vec3d origin{};          ///< world position of voxel (0, 0, 0)'s centre
  std::array<Vec3d, 3> axes{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};  ///< unit, orthogonal; may be left-handed
  MaterialArray material;                  ///< per voxel: 0 is the outside, then 1 .. labels.size() - 1
  std::vector<std::vector<float>> values;  ///< no NaN; see Kind
  std::vector<float> levels;               ///< ascending
  std::vector<std::int64_t> labels;        ///< per material: its label in the file; [0]: the outside's
  std::vector<std::string> names;          ///< per material; may be empty
  std::optional<SizeImage> sizes;          ///< in place of `max_size` where it has wishes

  int materials() const { return int(labels.size()); }
  std::size_t voxels() const { return std::size_t(dims.x) * dims.y * dims.z; }
};

/// What became of the bound `max_deviation`: distances in voxels of the middles and the edges' middles of flat
/// triangles from the interfaces that they stand for. All zero where there is no bound.
struct DeviationInfo {
  double first_max = 0;          ///< the largest, of the mesh of the sizing field
  double max = 0, mean = 0;      ///< of the mesh in the end
  std::int64_t first_above = 0;  ///< triangles above the bound, of the mesh of the sizing field
  int rounds = 0;                ///< of refining
  std::int64_t inserted = 0;     ///< particles that refining has put in
  /// Triangles above the bound in the end: those whose edges are too short to be divided, those at junctions, others.
  std::int64_t above_detail = 0, above_junctions = 0, above_others = 0;
  std::vector<Vec3d> places;  ///< the middles of the worst of these, world; at most 100
  std::int64_t above() const { return above_detail + above_junctions + above_others; }
};

/// What became of the fields and particles, for the report.
struct MeshInfo {
  Int3 blocks{};          ///< of 8^3 voxels
  int crowded_cells = 0;  ///< of 4^3 cells of the embedding, those where more materials meet than can be distinguished
  double estimated_peak_bytes = 0;  ///< before the fields are made: of the process on the CPU, else of the device
  std::int64_t field_bytes = 0, embedding_bytes = 0, embedding_cells = 0;
  int surfaces = 0, curves = 0;  ///< interfaces of two materials, junction curves of three
  int points = 0;                ///< junction points of four materials
  int crowded_points = 0;        ///< of these, where more than four materials meet
  /// Materials that meet (0xffff: none) on each surface and curve, ascending, then at each kind of junction point.
  std::vector<std::array<std::uint16_t, 4>> junctions;
  std::int64_t thinned_voxels = 0;      ///< of labels, whose material gave way where too many meet (thin_materials)
  std::int64_t constrained_voxels = 0;  ///< where tightening was held back to keep a voxel on its side
  std::int64_t ridge_voxels = 0;        ///< of a signed distance, where a ridge near the interface was taken out
  double smallest_size = 0, largest_size = 0;  ///< of the sizing field on the interfaces, voxels
  double expected_particles = 0;               ///< from area and sizing field
  std::int64_t seeded = 0, final = 0;
  std::int64_t seeded_on_surfaces = 0;  ///< of `seeded`; the others are on curves and at points
  std::int64_t points_final = 0, curves_final = 0, surfaces_final = 0;  ///< of `final`, by junction order
  int iterations = 0;                                                   ///< of the surfaces
  int coarse_iterations = 0;                                            ///< of these, with a quarter of the particles
  std::vector<double> energy;       ///< mean energy per particle, per iteration of the surfaces
  std::vector<std::int64_t> count;  ///< particles on surfaces, per iteration
  std::vector<double> seconds;      ///< at its end, since the surfaces were seeded, per iteration
  StarUse stars;                    ///< of the improvement, where `triangles` is stars
  DeviationInfo deviation;          ///< where `max_deviation` is set
  double final_energy = 0;          ///< mean on surfaces, by the tree with theta 0, alike for all solvers; 0: a draft
};

/// Where the particles are, world coordinates.
struct MeshParticles {
  std::vector<Vec3d> points;
  std::vector<float> size;  ///< h, world units
  std::vector<float> energy;
  std::vector<Vec3f> normal;        ///< of its surface; the tangent on a curve; zero on a junction point
  std::vector<std::uint8_t> order;  ///< 0 on junction points, 1 on curves, 2 on surfaces
  std::vector<std::array<std::uint16_t, 4>> materials;  ///< that meet there; unused ones are 0xffff
};

/// Mean and largest distance, in voxels, of vertices and facet centres from the interface that they stand for.
struct SurfaceDistance {
  double vertex_mean = 0, vertex_max = 0, facet_mean = 0, facet_max = 0;
};

/// Told after every iteration: stage name, how far the whole command is (0..1), iteration, particles and mean energy.
struct MeshProgress {
  std::string_view stage;
  double fraction = 0;
  int iteration = 0;
  std::int64_t particles = 0;
  double energy = 0;
};
using MeshProgressCallback = std::function<void(const MeshProgress&)>;

/// Where a renderer wants particles: memory of the pipeline's device, room for `capacity` of them in both arrays.
struct ShownParticles {
  Float4* position = nullptr;   ///< x, y, z in voxels; h, voxels
  Float4* direction = nullptr;  ///< unit: normal of a surface, tangent of a curve, zero at a point; energy
  std::int64_t capacity = 0;
};

/// How many there are. They lie behind each other in this order.
struct ShownCounts {
  std::int64_t points = 0, curves = 0, surfaces = 0;
  std::int64_t total() const { return points + curves + surfaces; }
};

/// A box of what particles are sorted into: two corners, voxels.
struct ShownBox {
  Vec3f low, high;
};

/// From voxels, the coordinates of what is shown, to the world: origin + x axes[0] + y axes[1] + z axes[2]. The axes
/// are at right angles and of one length, that of a voxel, so that directions turn with them; they may be left-handed.
struct VoxelFrame {
  Vec3d origin;
  std::array<Vec3d, 3> axes;
  Vec3d to_world(const Vec3d& p) const { return origin + axes[0] * p.x + axes[1] * p.y + axes[2] * p.z; }
};

/// What can be asked for at points of the world.
enum class MeshField {
  material,  ///< its number; 0, the outside, beyond the volume
  distance,  ///< from the nearest interface, world units, unsigned; infinity where it is farther off than was looked
  size,      ///< the sizing field, world units
};

/// load, build_fields, relax, triangulate, in this order; `parameters` may be changed between calls and are read by the
/// step that they belong to. A step may be repeated without those before it, and gives what a fresh pipeline would.
/// Throws Error for bad input and too little memory, Interrupted when the watched flag is set. After an Interrupted any
/// step up to the interrupted one may be called again (after that from `load`: `load`); after one from `relax`,
/// `watch(nullptr)` and `triangulate` give the mesh of the particles so far.
///
/// All calls belong to one thread, also those that look; those marked so may be made within `progress`.
class MeshPipeline {
 public:
  virtual ~MeshPipeline() = default;

  MeshParameters parameters;
  MeshProgressCallback progress;

  /// Stage materials. The volume is not needed after it.
  virtual void load(const MeshVolume& volume) = 0;
  /// Stages tighten, distance, sizing, embed: those that `parameters` concern since they ran last, and those behind
  /// them. False where none had to run; else the particles are dropped.
  virtual bool build_fields() = 0;
  virtual void relax() = 0;               ///< stages seed, relax, population
  virtual SurfaceMesh triangulate() = 0;  ///< stages triangulate, smooth, remesh; world coordinates

  /// How many particles the next `relax` makes room for: there are never more to be shown. Needs the fields. It is
  /// `relax` that throws Error where they do not fit into the memory.
  virtual std::int64_t particle_capacity() const = 0;
  virtual MeshParticles particles() const = 0;
  virtual SurfaceDistance surface_distance(const SurfaceMesh& mesh) = 0;  ///< stage quality
  /// Where points of the world come to lie on the junctions of two, three or four materials (ascending; the others
  /// 0xffff): on the interface that vertices lie on. Not finite where there is none within 6 voxels; with `within`,
  /// also where the interface ends before that at its rim. Needs the fields.
  virtual std::vector<Vec3d> onto_junctions(std::span<const Vec3d> points, std::span<const Junction> junctions,
                                            bool within) = 0;
  /// Material at points of the world (the outside beyond the volume). Needs the fields; also within `progress` of
  /// `relax`.
  virtual std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) = 0;
  /// A field at points of the world, as MeshField says; distance and size are NaN beyond the volume and the 8 voxels of
  /// outside around it. Needs the fields; also within `progress` of `relax`.
  virtual std::vector<float> field_at(MeshField field, std::span<const Vec3d> points) = 0;

  /// Stage show. A kernel writes the particles as they are now into `memory`; nothing where they do not fit, which the
  /// counts say. None before `relax`; also within `progress` of `relax` and `triangulate`, where points and curves are
  /// alone at first.
  virtual ShownCounts show_particles(const ShownParticles& memory) = 0;
  /// The same for the boxes around particles: the nodes of the tree that was built last, level by level from the roots;
  /// while the serial or the red-black solver runs, which know no tree, their bins that hold moving particles. Returns
  /// how many there are.
  virtual std::int64_t show_boxes(ShownBox* memory, std::int64_t capacity) = 0;
  virtual VoxelFrame voxel_frame() const = 0;  ///< of the volume that was loaded

  virtual const MeshInfo& info() const = 0;
  virtual StageTimers& timers() = 0;
  virtual std::size_t peak_bytes() const = 0;  ///< of the arena
  virtual void watch(const std::atomic<bool>* stop) = 0;
};

std::unique_ptr<MeshPipeline> make_mesh_pipeline(Device& device);

}  // namespace nacre
