// Nacre: the mesh pipeline: its parts in their order. Backends instantiate it.
#pragma once

#include <algorithm>
#include <optional>

#include "compute/pipeline/mesh_distance.hpp"
#include "compute/pipeline/mesh_fields.hpp"
#include "compute/pipeline/mesh_improvement.hpp"
#include "compute/pipeline/mesh_probe.hpp"
#include "compute/pipeline/relaxation.hpp"
#include "compute/pipeline/shown_particles.hpp"

namespace nacre {

/// Above this share of unsettled stars, surfaces are sampled so coarsely that cells are quicker, and better.
constexpr double most_unsettled_stars = 0.08;

/// What is asked of triangles.
inline DefectRule triangles_asked(QualityLevel quality) {
  switch (quality) {
    case QualityLevel::draft: return worst_defects;
    case QualityLevel::standard: return mediocre;
    default: return not_fine;
  }
}

template <class Backend>
class MeshPipelineOf : public MeshPipeline {
 public:
  explicit MeshPipelineOf(Device& device) : exec_(device) {}

  void load(const MeshVolume& volume) override {
    auto stage = exec_.stage("materials");
    drop_particles();
    tell_("materials", 0, 0, 0);
    fields_.load(volume, at_quality(parameters), info_);
  }

  bool build_fields() override {
    if (!fields_.loaded()) throw Error("no volume loaded");
    const MeshParameters used = at_quality(parameters);
    if (!fields_.drop_outdated(used)) return false;
    drop_particles();
    require_room(used);
    fields_.build(used, tell_, info_);
    exec_.arena().give_back();
    return true;
  }

  void relax() override {
    require_fields();
    drop_particles();
    exec_.arena().rewind(fields_.end());
    const MeshParameters used = at_quality(parameters);
    const std::string why =
        used.particles > 0 ? "`particles` asks, with the junctions, for " : "the sizing field asks for about ";
    particles_.make(require_room_for(expected_particles(), std::int64_t(fields_.table().junctions.size()),
                                     exec_.arena().room_bytes(), exec_.device(), used, why));
    relaxation_.run(used, tell_, info_);
  }

  /// The first mesh after `relax` is made of what it left, and so are all others: improvement changes the particles.
  SurfaceMesh triangulate() override {
    if (!particles_.made()) throw Error("no particles");
    const MeshParameters used = at_quality(parameters);
    relaxation_.finish(used, info_);
    if (relaxed_)
      particles_.upload(*relaxed_);
    else
      relaxed_ = particles_.download();
    exec_.arena().give_back();  // for the triangulation, which is on the host
    const QualityLevel quality = quality_from_string(used.quality);
    const bool stars = triangles_from_string(used.triangles) == TriangleSource::stars;
    const ImprovementRule rule{.smooth = used.smooth,
                               .remesh = used.remesh,
                               .stars = stars,
                               .most_unsettled = quality == QualityLevel::draft ? 1 : most_unsettled_stars,
                               .aim = triangles_asked(quality),
                               .threads = exec_.device().threads(),
                               .stop = stop_,
                               .deviation = used.max_deviation,
                               .detail = deviation_detail(used)};
    ImprovedMesh made = MeshImprovement(particles_, fields_.table(), fields_.frame(), rule, tell_).run();
    info_.points_final = made.particles[0], info_.curves_final = made.particles[1];
    info_.surfaces_final = made.particles[2];
    info_.stars = made.stars;
    info_.deviation = made.deviation;
    info_.final = particles_.count();
    return std::move(made.mesh);
  }

  MeshParticles particles() const override {
    return particles_.made() ? describe_particles(particles_.download(), fields_.table(), fields_.frame())
                             : MeshParticles();
  }

  SurfaceDistance surface_distance(const SurfaceMesh& mesh) override {
    auto stage = exec_.stage("quality");
    const DistanceSamples samples = distance_samples(mesh);
    return summarise_distances(samples, distance_to_interfaces(exec_, fields_, samples.points, samples.interfaces));
  }

  std::vector<Vec3d> onto_junctions(std::span<const Vec3d> points, std::span<const Junction> junctions,
                                    bool within) override {
    require_fields();
    return nacre::onto_junctions(exec_, fields_, points, junctions, within);
  }

  std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) override {
    require_fields();
    return nacre::material_at(exec_, fields_, points);
  }

  std::vector<float> field_at(MeshField field, std::span<const Vec3d> points) override {
    require_fields();
    return nacre::field_at(exec_, fields_, field, points);
  }

  std::int64_t particle_capacity() const override {
    require_fields();
    return std::int64_t(nacre::particle_capacity(expected_particles()));
  }

  ShownCounts show_particles(const ShownParticles& memory) override {
    if (!particles_.made()) return {};
    auto stage = exec_.stage("show");
    return nacre::show_particles(exec_, particles_.set(), fields_.order(), memory);
  }

  std::int64_t show_boxes(ShownBox* memory, std::int64_t capacity) override {
    if (particles_.count() == 0) return 0;
    auto stage = exec_.stage("show");
    const bool has_tree = particles_.solver().tree().bounded_nodes() > 0;
    return has_tree || solver_from_string(parameters.solver) == Solver::tree
               ? show_tree(exec_, particles_.solver(), memory, capacity)
               : show_bins(exec_, particles_.set(), memory, capacity);
  }

  VoxelFrame voxel_frame() const override { return fields_.frame().voxel_frame(); }
  const MeshInfo& info() const override { return info_; }
  StageTimers& timers() override { return exec_.timers(); }
  std::size_t peak_bytes() const override { return const_cast<Executor<Backend>&>(exec_).arena().peak_bytes(); }
  void watch(const std::atomic<bool>* stop) override { exec_.watch(stop_ = stop); }

 private:
  void require_fields() const {
    if (!fields_.built()) throw Error("no fields built");
  }

  void drop_particles() {
    particles_.drop();
    relaxed_.reset();
  }

  /// As the sizing field says; or so many on the surfaces, and on the junctions as ever.
  double expected_particles() const {
    return parameters.particles > 0 ? parameters.particles + fields_.expected(0) + fields_.expected(1)
                                    : info_.expected_particles;
  }

  /// Refuses sizes that would need more particles than memory before the fields are made, as far as voxels show: a
  /// plane of particles as far apart as `max_size` and `sizes` allow is the least that there can be. The fields are
  /// checked again in `relax`.
  void require_room(const MeshParameters& used) {
    double h = std::max(parameters.min_size, parameters.max_size);
    for (const SizeBound& bound : fields_.bounds(parameters)) h = std::max(h, double(bound.size));
    if (fields_.wishes()) h = std::max(h, double(fields_.wishes()->most));
    if (parameters.particles == 0)
      require_room_for(fields_.area().least * 1.1547 / (h * h), 0, exec_.arena().room_bytes(), exec_.device(),
                       parameters, "the boundaries ask for at least ");
    const VolumeFacts facts = fields_.facts(used);
    info_.estimated_peak_bytes =
        require_memory(facts, used, exec_.arena().room_bytes(), exec_.arena().peak_bytes(), exec_.device());
  }

  Executor<Backend> exec_;
  MeshInfo info_;
  MeshFields<Backend> fields_{exec_};
  ParticleStore<Backend> particles_{exec_, fields_};
  Relaxation<Backend> relaxation_{exec_, fields_, particles_};
  std::optional<HostParticles> relaxed_;  ///< as they were before the first mesh was made
  const std::atomic<bool>* stop_ = nullptr;
  const TellStage tell_ = [this](std::string_view stage, double fraction, int iteration, double energy) {
    if (progress) progress({stage, fraction, iteration, particles_.count(), energy});
  };
};

}  // namespace nacre
