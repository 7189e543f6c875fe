// Nacre: the mesh pipeline: order of the stages and who owns what. Backends instantiate it.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "compute/embedding/build_interface_grid.hpp"
#include "compute/meshing/attempt.hpp"
#include "compute/meshing/defects.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/repair.hpp"
#include "compute/particles/embedding_seeds.hpp"
#include "compute/particles/ring_smoothing.hpp"
#include "compute/particles/solver_state.hpp"
#include "compute/particles/tree_solver.hpp"
#include "compute/pipeline/field_recipe.hpp"
#include "compute/pipeline/mesh_kernels.hpp"
#include "compute/pipeline/volume_frame.hpp"

namespace nacre {

/// Particles on the host, in the order of a ParticleSet.
struct HostParticles {
  std::vector<Float4> place, direction;
  std::vector<std::uint32_t> interface;
};

template <class Backend>
class MeshPipelineOf : public MeshPipeline {
 public:
  explicit MeshPipelineOf(Device& device) : exec_(device) {}

  void load(const MeshVolume& volume) override;
  bool build_fields() override;
  void relax() override;
  SurfaceMesh triangulate() override;

  std::int64_t particle_capacity() override;
  MeshParticles particles() const override;
  SurfaceDistance surface_distance(const SurfaceMesh& mesh) override;
  std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) override;
  std::vector<float> field_at(MeshField field, std::span<const Vec3d> points) override;
  ShownCounts show_particles(const ShownParticles& memory) override;
  std::int64_t show_boxes(ShownBox* memory, std::int64_t capacity) override;
  VoxelFrame voxel_frame() const override;

  const MeshInfo& info() const override { return info_; }
  StageTimers& timers() override { return exec_.timers(); }
  std::size_t peak_bytes() const override { return const_cast<Executor<Backend>&>(exec_).arena().peak_bytes(); }
  void watch(const std::atomic<bool>* stop) override { exec_.watch(stop_ = stop); }

 private:
  /// A mesh of the particles as they are.
  struct Triangulated {
    SurfaceMesh mesh;
    std::vector<std::uint32_t> point_of;  ///< the particle at each of its points, ascending
    LabelRepair repair;
    double fitness = 0;  ///< see there; below 0: it touches itself at so many places
  };
  struct PointFacts {
    std::vector<std::uint8_t> order;  ///< of the junction that the mesh has there
    std::vector<float> size;          ///< world units
  };
  /// What has been done for the triangles.
  struct MeshRounds {
    int smoothed = 0, mended = 0;
    std::int64_t bad = std::int64_t(1) << 40;  ///< points at bad triangles when they were last smoothed alone
    int attempts = 0;                          ///< at bad places alone
    std::optional<Attempt> attempt;            ///< the one that is under way,
    HostParticles before;                      ///< what was there before it,
    int further = 0;                           ///< and its rounds after the first
  };

  void tell(std::string_view stage, double fraction, int iteration = 0, double energy = 0) {
    if (progress) progress({stage, fraction, iteration, solver_ ? solver_->particles().count : 0, energy});
  }
  void require_fields() const {
    if (built_ < field_stages) throw Error("no fields built");
  }
  void drop_particles() {
    solver_.reset();
    relaxed_.reset();
  }
  FieldRecipe field_recipe() const;
  void require_room();
  void build_stage(FieldStage which);
  void relate_interfaces();
  void describe_fields();
  double require_room_for(double particles, const std::string& why);
  double particles_to_expect();
  void make_solver();
  void add_points();
  bool by_marching_cubes() const;
  void seed_order(int order);
  void relax_order(int order, double from, double to);
  void relax_by_tree(int order, double from, double to);
  void relax_by_turns(int order, double from, double to);
  void finish_relaxing();
  void note_iteration(int order, double energy, std::int64_t movers);
  void spread_seeds();
  void measure_energy();
  void polish(std::int64_t first = 0);
  void begin_unmended();
  Triangulated triangulate_once(Delaunay& delaunay);
  bool improve(MeshRounds& rounds, Triangulated& made);
  PointFacts point_facts(const Triangulated& made) const;
  double improve_fraction(const MeshRounds& rounds) const {
    return 0.85 + 0.09 * (rounds.smoothed + rounds.mended) / std::max(1, parameters.smooth + parameters.mend);
  }
  std::vector<std::array<std::uint32_t, 2>> touching_points(const Triangulated& made) const;
  bool attempt(MeshRounds& rounds, Triangulated& made, std::span<const std::uint8_t> bad);
  bool go_on(MeshRounds& rounds, Triangulated& made);
  bool take_back(MeshRounds& rounds);
  std::vector<std::uint8_t> bad_points(const Triangulated& made) const;
  std::int64_t smooth(const MeshRounds& rounds, Triangulated& made, std::span<const std::uint8_t> moving,
                      SmoothingRule rule = {});
  bool mend(const Triangulated& made, const DefectRule& rule, Attempt* attempt = nullptr,
            std::span<const std::uint8_t> there = {});
  std::vector<Vec3d> particle_places() const;
  HostParticles download_particles() const;
  void upload_particles(const HostParticles& particles);
  std::int64_t change_particles(std::span<const std::uint8_t> gone, std::span<const MeshDefects::NewPoint> born);
  RelatedView related() const { return {related_start_.data(), related_.data(), order_.data()}; }
  EmbeddingSeeds embedding_seeds(int order) const { return {grid_, order_.data(), order}; }
  FieldGround field_ground() const { return {bricks_.view(), junction_.data(), size_.view()}; }
  EmbeddedGround embedded_ground() const { return {grid_.view(), field_ground()}; }
  TreeRule tree_rule() const {
    return {float(parameters.theta), float(parameters.step), float(parameters.momentum), 0.3f};
  }
  PopulationRule population_rule(int order) const;
  Array<Vec3f> upload_points(std::span<const Vec3d> points);

  Executor<Backend> exec_;
  VolumeFrame frame_;
  MeshInfo info_;
  std::optional<MeshVolume::Kind> kind_;  ///< of the volume; none: none is loaded
  MaterialBricks bricks_;
  double least_area_ = 0;  ///< of all boundaries, squares of the smallest spacing
  DistanceField distance_;
  SizingField size_;
  InterfaceGrid grid_;
  std::vector<Junction> junctions_;  ///< surfaces and curves as in the grid, then points
  Array<Junction> junction_;
  Array<std::uint32_t> related_start_, related_;
  Array<std::uint8_t> order_;
  std::unique_ptr<TreeSolver> solver_;    ///< holds the particles, whichever solver moves them
  int seeded_order_ = 0;                  ///< 1: curves have particles, 2: surfaces, too
  bool unfinished_ = false;               ///< moving them was interrupted
  SolverState turns_;                     ///< of the serial and the red-black solver
  std::optional<HostParticles> relaxed_;  ///< as they were before the first mending
  FieldRecipe recipe_;
  int built_ = 0;                            ///< so many stages of the fields are as `recipe_` says
  std::size_t mark_[field_stages + 1] = {};  ///< the arena's head before each of them, and behind the last
  std::chrono::steady_clock::time_point seeded_;
  const std::atomic<bool>* stop_ = nullptr;
};

}  // namespace nacre
