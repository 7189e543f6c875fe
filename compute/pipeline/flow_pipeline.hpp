// Nacre: unsteady flow on a surface, from triangles and vectors to a moving texture. One of the two public doors.
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
#include "compute/device/executor.hpp"
#include "compute/device/ranks.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/math/vec.hpp"
#include "compute/pipeline/kept_arrays.hpp"
#include "compute/raycast/camera.hpp"

namespace nacre {

/// What flow runs on: the closest-point grid of chapter 5, or the octree of chapter 6.
enum class EmbeddingKind { grid, octree };

/// An octree of bricks of 8^3 cells that are found by bit masks, or one whose leaves are cells, as in sec. 6.1.
enum class OctreeKind { brick, thesis };

/// What is drawn on the surface: streaks of particles (chapter 5), or a pattern of reaction and diffusion along the
/// vectors (docs/method/reaction-diffusion.md).
enum class FlowTexture { streaks, spots, stripes };

/// Settings of a flow run. Ranges and help texts are in the knob table (engine/scene/settings/knobs.hpp).
struct FlowParameters {
  EmbeddingKind method = EmbeddingKind::grid;
  OctreeKind octree = OctreeKind::brick;
  FlowTexture texture = FlowTexture::streaks;
  double pattern_spacing = 24;   ///< texture cells from spot to spot, or stripe to stripe, across the vectors
  double pattern_stretch = 2.2;  ///< how much longer a pattern is along the vectors than across, where they are fast
  bool neighbour_index = false;  ///< store every cell's neighbours, in the octree of cells (sec. 6.1.4)
  int resolution = 1024;         ///< texture cells along the longest side; of an octree: cells of its domain per axis
  int refine = 4;                ///< texture cells per closest-point cell and axis (R)
  int subcells = 4;              ///< closest-point cells per coarse cell and axis
  double radius = 0;       ///< band around the surface, in closest-point cells; 0: the least that the stencils need
  int ttl = 4;             ///< steps that a particle lives in the mean
  double step_cells = 8;   ///< texture cells that the 98th percentile speed moves in a step
  double speed_power = 1;  ///< displacement ~ speed^power: 1 true speeds, 0 all alike
  int steps = 20;          ///< steps from the first to the last time
  int warmup = -1;         ///< steps before the first, at the first time; -1: ttl
  int first_step = 0;      ///< `start` goes to the beginning of this step: a part of a run
  int lead_in = 256;       ///< steps from noise to `first_step`, at most
  double sharpen = 0.05;   ///< strength of the Laplacian between steps
  double jitter = 0.4;     ///< share of fresh noise between steps
  double equalise = 0.5;   ///< share of local contrast against that of the whole texture
  int streaks = 27;        ///< cells that shown streaks are drawn along the flow, each way; 0: what particles leave
  double contrast = 0.55;  ///< shown standard deviation
  std::uint32_t seed = 1;
};

/// The surface that flow is shown on, in host memory that outlives `embed`.
struct FlowMesh {
  std::span<const Vec3d> points;          ///< world coordinates
  std::span<const Triangle> triangles;    ///< none degenerate, indices in range
  std::span<const Vec3f> corner_normals;  ///< 3 per triangle, unit
  /// Per triangle: 1 for those of a second sheet, which lie where others do and face the other way; empty: none.
  std::span<const std::uint8_t> second_sheet{};
  bool moves = false;    ///< FlowMethod::move will be called: memory for other shapes
  bool shared = false;   ///< the triangles are a share of those of all processes, in whose order they follow each other
  double cell_size = 0;  ///< edge of a texture cell, world units; 0: by `resolution`
};

/// Where the points of an embedded mesh are at a moment.
struct FlowShape {
  std::span<const Vec3d> points;          ///< world coordinates
  std::span<const Vec3f> corner_normals;  ///< 3 per triangle, unit
  std::span<const Vec3f> vectors;         ///< one per point, world units per second: what FlowValues has
};

/// How a texture comes to the surface that is embedded next.
enum class FlowCarry {
  material,      ///< the same triangles in another shape: every material point keeps its value
  closest_point  ///< another surface: a point takes the value of the closest point of the one before
};

/// Vectors over time, world units per second.
struct FlowVectors {
  std::function<void(double time, std::span<Vec3f> vectors)> at;  ///< fills one vector per point
  double start = 0, end = 0;                                      ///< time of the data; equal: steady
  double reference_speed = 1;  ///< tangential speed, 98th percentile over space and time
};

/// What the embedding became, for the report.
struct EmbeddingInfo {
  std::string kind = "grid";        ///< grid, brick octree, source octree
  Int3 dimensions{};                ///< texture cells of the surface's bounding box
  Int3 closest_point_dimensions{};  ///< the same in closest-point cells
  std::uint64_t cells = 0;          ///< texture cells stored
  std::uint64_t surface_cells = 0;
  std::uint64_t closest_point_cells = 0;
  std::uint64_t bytes = 0;
  std::uint64_t dense_bytes = 0;  ///< the same payload for every texture cell of the box
  std::uint64_t flow_bytes = 0;   ///< on an octree: values, deposits and vectors of its cells, made by `start`
  double cell_size = 0;           ///< edge of a texture cell, world units
  /// Of this process, where several share the octree; the numbers above are those of all. The mesh is what is near its
  /// bricks, where the surface came in shares.
  std::uint64_t own_bricks = 0, own_surface_cells = 0, halo_bricks = 0, mesh_triangles = 0, mesh_bytes = 0;
};

/// One value per surface cell and what belongs to it; world coordinates.
struct FlowValues {
  std::vector<Vec3d> centre;
  std::vector<float> value;
  std::vector<Vec3f> velocity, normal;  ///< tangential vector at the time of the frame; unit normal
  std::vector<Vec3d> closest_point;

  FlowValues() = default;
  explicit FlowValues(std::size_t n) : centre(n), value(n), velocity(n), normal(n), closest_point(n) {}
};

/// The arrays of the embedding that lead from a point of the surface to its shown value, on the host, for a renderer
/// that looks values up by itself.
struct FlowLookup {
  enum class Kind {
    grid,    ///< RefinedGridView says how
    octree,  ///< BrickOctreeView
    thesis   ///< ThesisOctreeView
  };
  Kind kind = Kind::grid;
  std::uint64_t values = 0;  ///< how many are shown
  std::uint64_t means = 0;   ///< of each block (grid) or brick (octree) of cells, after the values; 0: none
  Vec3d sheet_shift{};       ///< world; values of a second sheet's points are found so far away from them
  Vec3d origin{};            ///< world
  double cell_size = 1;      ///< of the grid: of a closest-point cell; of an octree: of a texture cell; world units

  // The grid.
  Int3 bricks{};
  int subcells = 0, refine = 0;
  std::vector<std::uint32_t> brick_index, block, texel;

  // The octree over bricks of 8^3 texture cells.
  int levels = 0;                          ///< of inner nodes; 8 << levels cells per axis, of either octree
  std::vector<std::uint32_t> node;         ///< per inner node: first child, and 8 bits for the children there are
  std::vector<std::uint32_t> level_start;  ///< first node of each level
  std::vector<std::uint32_t> layer;        ///< per brick and z: 64 bits for surface cells (8 y + x), the first's number

  // The thesis octree, whose leaves are cells.
  std::vector<std::uint32_t> child;  ///< 8 per node, the root last: numbers of nodes, of cells in the lowest; all ones
};

/// The boxes that the embedding consists of: the nodes of an octree, the bricks of a grid. They are cubes, level after
/// level from the largest, those of a level half as wide as those of the one before.
struct FlowBoxes {
  Vec3d origin{};                          ///< of the first cube, world
  double width = 0;                        ///< edge of the smallest, world units
  std::vector<std::uint64_t> level_start;  ///< number of the first of each level, and how many there are

  std::uint64_t count() const { return level_start.empty() ? 0 : level_start.back(); }
};

struct RenderOptions {
  Camera camera;
  int width = 1024, height = 768;
  int samples = 2;  ///< per pixel and axis
  bool texture = true;
  std::span<const float> scalar;  ///< per point of the mesh; empty: gray
  double low = 0, high = 1;
  std::span<const std::array<float, 3>> colours;     ///< 256, sRGB
  std::optional<std::array<float, 3>> below, above;  ///< of values beyond the range, sRGB; none: the end of `colours`
  std::array<float, 3> no_number{0.5f, 0.5f, 0.5f};  ///< where the scalar is NaN, sRGB
  std::array<float, 3> background{1, 1, 1};          ///< sRGB
  bool transparent = false;
  BackFaces back_faces = BackFaces::shown;
};

/// An embedded surface and the texture on it: all that can be asked of it. Its implementations are GridFlow,
/// GridPattern and OctreeFlow; FlowMethodOn has what they share. Throws Error where it is asked for more than has been
/// started, and Interrupted when the watched flag is set.
class FlowMethod {
 public:
  virtual ~FlowMethod() = default;
  virtual void embed(const FlowMesh& mesh) = 0;  ///< stages embed, refine; FlowPipeline::embed calls it
  /// Noise and warm-up. `between`: called after each step of the warm-up, when `save` may be.
  virtual void start(const FlowVectors& vectors, const std::function<void()>& between = {}) = 0;
  virtual void step() = 0;          ///< stages velocity, advect, deposit, filter
  virtual double time() const = 0;  ///< of the frame that is shown
  virtual double time_of(
      int k) const = 0;               ///< of the data at the beginning of step `k`; it stands still in the warm-up
  virtual int next_step() const = 0;  ///< below FlowParameters::first_step: of the warm-up
  /// All that the next steps need of those before, piece by piece; the embedding and the vectors are not in it. On
  /// several processes the first one's `put` gets everything, the same bytes as on one.
  virtual void save(const PutBytes& put) = 0;
  /// Instead of `start`, on the same surface and with the same parameters: goes on before step `next`, where `save`
  /// gave what `take` gives. All that follows is the same to the byte.
  virtual void go_on(const FlowVectors& vectors, int next, const TakeBytes& take,
                     const std::function<void()>& between = {}) = 0;
  /// One value per surface cell (octree of cells: per cell), 0..1, contrast stretched.
  virtual std::vector<float> shown() const = 0;
  /// From the next step on, shown values also go to `memory` of the device, for whoever draws them: one float per value
  /// of `shown`; null: no longer, as after `start`. Nothing is read from there. The same for `means`: one float per
  /// mean of `lookup` (-1 where a block holds no surface cell).
  virtual void show_into(float* memory, float* means = nullptr) = 0;
  virtual FlowLookup lookup() const = 0;
  virtual FlowBoxes boxes() const = 0;
  /// Writes one Morton code per box, among cubes of its size, to `memory` of the device.
  virtual void show_boxes(std::uint64_t* memory) = 0;
  virtual FlowValues values() const = 0;
  /// From now on pictures, values and probes show the surface in this shape. The texture stays with the material, and
  /// the vectors of `start` remain those of the embedded shape. Needs FlowMesh::moves.
  virtual void move(const FlowShape& shape) = 0;
  /// Instead of `start`, what FlowPipeline::carry calls: goes on with the texture of `before`, a method of the same
  /// kind. Returns the share of the cells that found a value there; the others begin with noise.
  virtual double resume(const FlowVectors& vectors, const FlowMethod& before, FlowCarry how) = 0;
  /// RGBA bytes, row 0 at the top (stage render).
  virtual std::vector<std::uint8_t> render(const RenderOptions& options) = 0;
  /// Shown value at points of the surface (world coordinates); for probes and tests.
  virtual std::vector<float> sample_shown(std::span<const Vec3d> points) = 0;
  virtual const EmbeddingInfo& embedding() const = 0;
};

/// `embed` a surface, `start` its flow, then `step` and look as often as wanted. `parameters` may be changed between
/// calls: those of the embedding take effect at the next `embed`, ttl and seed at the next `start`, the others at once.
/// Throws Error for bad input and too little memory, and Interrupted when the watched flag is set.
class FlowPipeline {
 public:
  virtual ~FlowPipeline() = default;

  FlowParameters parameters;
  /// The processes that share the flow; null: this one alone. Only on the octree of bricks, on CPUs, and where the
  /// surface does not move. Each has the whole surface, or a share of it (FlowMesh::shared): then vectors and scalars
  /// are those of its points, and it gets from the others what lies near its bricks. All processes make the same
  /// calls; pictures are complete on the first; `values`, `shown` and `lookup` are those of its own bricks, and there
  /// is no `sample_shown`.
  Ranks* ranks = nullptr;

  virtual void embed(const FlowMesh& mesh) = 0;  ///< chooses the method; the surface and flow before it are gone
  /// Embeds another shape while a flow goes on, and carries its texture there (stages rebuild, carry); `vectors` are
  /// those of the new shape, over the same time. What resume says. Where it throws, the flow before goes on.
  virtual double carry(const FlowMesh& mesh, const FlowVectors& vectors, FlowCarry how) = 0;
  FlowMethod& flow();  ///< on the embedded surface; throws Error where there is none
  const FlowMethod& flow() const;

  virtual StageTimers& timers() = 0;
  virtual std::size_t peak_bytes() const = 0;  ///< of the arena
  /// `stop` is checked between and inside launches; `share` tells how much of `embed` (but of the thesis octree) or of
  /// `start` is done, 0..1.
  virtual void watch(const std::atomic<bool>* stop, std::atomic<float>* share = nullptr) = 0;

 protected:
  std::unique_ptr<FlowMethod> method_;
};

std::unique_ptr<FlowPipeline> make_flow_pipeline(Device& device);

/// Bytes that `embed` and `start` will need (on the grid, on an octree), from the area of the surface: within some tens
/// of percent.
double estimate_flow_bytes(const FlowMesh& mesh, const FlowParameters& parameters);
double estimate_octree_bytes(const FlowMesh& mesh, const FlowParameters& parameters);

/// How large a surface is, of all processes where it is shared: `sharers` are those, and it is collective.
struct MeshMeasure {
  Vec3d lower{1e300}, upper{-1e300};
  double area = 0, edges = 0;  ///< edges: the length of two of each triangle's
  std::uint64_t triangles = 0;
};
MeshMeasure measure_mesh(const FlowMesh& mesh, Ranks* sharers = nullptr);
double estimate_octree_bytes(const MeshMeasure& measure, const FlowMesh& mesh, const FlowParameters& parameters);

}  // namespace nacre
