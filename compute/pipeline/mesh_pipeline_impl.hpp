// Nacre: the mesh pipeline: order of the stages and who owns what. Backends instantiate it.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "compute/embedding/build_interface_grid.hpp"
#include "compute/meshing/defects.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/repair.hpp"
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
  static constexpr int further_rounds = 4;  ///< of mending, for what falls short of the least that is asked of a mesh

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
  void make_solver();
  void add_points();
  void seed_order(int order);
  void relax_order(int order, double from, double to);
  void relax_by_tree(int order, double from, double to);
  void relax_by_turns(int order, double from, double to);
  void note_iteration(int order, double energy, std::int64_t movers);
  void measure_energy();
  void polish(std::int64_t first = 0);
  double mend_fraction(int round) const { return 0.86 + 0.08 * round / (parameters.mend + further_rounds); }
  void begin_unmended();
  bool mend(int round, const SurfaceMesh& mesh, const MeshParticles& particles, std::span<const std::uint32_t> point_of,
            const LabelRepair& repair);
  void close_up(int round);
  HostParticles download_particles() const;
  void upload_particles(const HostParticles& particles);
  std::int64_t change_particles(std::span<const std::uint8_t> gone, std::span<const MeshDefects::NewPoint> born);
  RelatedView related() const { return {related_start_.data(), related_.data(), order_.data()}; }
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
  SolverState turns_;                     ///< of the serial and the red-black solver
  std::optional<HostParticles> relaxed_;  ///< as they were before the first mending
  FieldRecipe recipe_;
  int built_ = 0;                            ///< so many stages of the fields are as `recipe_` says
  std::size_t mark_[field_stages + 1] = {};  ///< the arena's head before each of them, and behind the last
  std::chrono::steady_clock::time_point seeded_;
  const std::atomic<bool>* stop_ = nullptr;
};

template <class Backend>
SurfaceMesh MeshPipelineOf<Backend>::triangulate() {
  if (!solver_) throw Error("no particles");
  begin_unmended();
  SurfaceMesh mesh;
  Delaunay delaunay(exec_.device().threads());
  for (int round = 0;; ++round) {
    tell("triangulate", mend_fraction(round));
    const MeshParticles particles = this->particles();
    std::vector<std::uint32_t> point_of;
    LabelRepair repair;
    {
      auto stage = exec_.stage("triangulate");
      const DelaunayCells cells = delaunay.cells(particles.points, stop_);
      std::vector<std::uint16_t> label = material_at(cells.circumcentres);
      repair = repair_labels(particles.points, cells, label);
      mesh = extract_interfaces(particles.points, cells, label, &point_of);
    }
    if (parameters.mend == 0 || !mend(round, mesh, particles, point_of, repair)) break;
  }
  const MeshParticles particles = this->particles();
  info_.final = std::int64_t(particles.points.size());
  info_.points_final = std::count(particles.order.begin(), particles.order.end(), 0);
  info_.curves_final = std::count(particles.order.begin(), particles.order.end(), 1);
  info_.surfaces_final = std::count(particles.order.begin(), particles.order.end(), 2);
  return mesh;
}

/// The first mesh after `relax` is made of what it left, and so are all others: mending has changed the particles since.
template <class Backend>
void MeshPipelineOf<Backend>::begin_unmended() {
  if (relaxed_)
    upload_particles(*relaxed_);
  else
    relaxed_ = download_particles();
}

}  // namespace nacre
