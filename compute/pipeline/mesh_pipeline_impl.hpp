// Nacre: the mesh pipeline: order of the stages and who owns what. Backends instantiate it.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include "compute/embedding/build_interface_grid.hpp"
#include "compute/field/tighten.hpp"
#include "compute/meshing/defects.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/repair.hpp"
#include "compute/particles/seed.hpp"
#include "compute/particles/solver_state.hpp"
#include "compute/particles/tree_solver.hpp"
#include "compute/pipeline/mesh_kernels.hpp"
#include "compute/pipeline/volume_frame.hpp"

namespace nacre {

template <class Backend>
class MeshPipelineOf : public MeshPipeline {
 public:
  explicit MeshPipelineOf(Device& device) : exec_(device) {}

  void load(const MeshVolume& volume) override;
  void build_fields() override;
  void relax() override;
  SurfaceMesh triangulate() override;

  MeshParticles particles() const override;
  SurfaceDistance surface_distance(const SurfaceMesh& mesh) override;
  std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) override;
  std::vector<float> size_at(std::span<const Vec3d> points) override;

  const MeshInfo& info() const override { return info_; }
  StageTimers& timers() override { return exec_.timers(); }
  std::size_t peak_bytes() const override { return const_cast<Executor<Backend>&>(exec_).arena().peak_bytes(); }
  void watch(const std::atomic<bool>* stop) override { exec_.watch(stop_ = stop); }

 private:
  void tell(std::string_view stage, double fraction, int iteration = 0, double energy = 0) {
    if (progress) progress({stage, fraction, iteration, solver_ ? solver_->particles().count : 0, energy});
  }
  void relate_interfaces();
  void make_solver();
  void add_points();
  void seed_order(int order);
  void relax_order(int order, double from, double to);
  void relax_by_tree(int order, double from, double to);
  void relax_by_turns(int order, double from, double to);
  void note_iteration(int order, double energy, std::int64_t movers);
  void measure_energy();
  void polish();
  bool mend(int round, const SurfaceMesh& mesh, const MeshParticles& particles, std::span<const std::uint32_t> point_of,
            const LabelRepair& repair);
  void change_particles(std::span<const std::uint8_t> gone, std::span<const MeshDefects::NewPoint> born);
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
  const MeshVolume* volume_ = nullptr;
  MaterialBricks bricks_;
  DistanceField distance_;
  SizingField size_;
  InterfaceGrid grid_;
  std::vector<Junction> junctions_;  ///< surfaces and curves as in the grid, then points
  Array<Junction> junction_;
  Array<std::uint32_t> related_start_, related_;
  Array<std::uint8_t> order_;
  std::unique_ptr<TreeSolver> solver_;  ///< holds the particles, whichever solver moves them
  SolverState turns_;                   ///< of the serial and the red-black solver
  std::size_t volume_mark_ = 0, field_mark_ = 0;
  bool fields_ = false;
  std::chrono::steady_clock::time_point seeded_;
  const std::atomic<bool>* stop_ = nullptr;
};

template <class Backend>
void MeshPipelineOf<Backend>::load(const MeshVolume& volume) {
  auto stage = exec_.stage("materials");
  Arena& arena = exec_.arena();
  solver_.reset();
  fields_ = false;
  info_ = {};
  arena.rewind(0);
  volume_ = &volume;
  frame_ = VolumeFrame(volume);
  tell("materials", 0);
  const CubicKernel kernel = parameters.kernel == "b-spline" ? CubicKernel::b_spline : CubicKernel::catmull_rom;
  bricks_ = lay_out_bricks(exec_, volume.dims, frame_.relative_spacing(), kernel, volume.material);
  if (bricks_.bricks == 2)
    throw Error("one material only", "every voxel of the volume is of the same material",
                "choose others with --materials or --isovalue");
  if (volume.kind == MeshVolume::Kind::indicators) {
    fill_indicators(exec_, bricks_, volume.material, volume.values,
                    indicator_range(volume.dims, volume.material, volume.values));
  } else if (volume.kind == MeshVolume::Kind::scalar) {
    float scale = 0;
    for (const float v : volume.values.at(0)) scale = std::max(scale, std::fabs(v));
    fill_scalar(exec_, bricks_, volume.values[0], volume.levels, scale > 0 ? scale : 1);
  }
  info_.blocks = bricks_.blocks;
  volume_mark_ = arena.mark();
}

template <class Backend>
void MeshPipelineOf<Backend>::build_fields() {
  if (!volume_) throw Error("no volume loaded");
  Arena& arena = exec_.arena();
  solver_.reset();
  fields_ = false;
  arena.rewind(volume_mark_);
  if (volume_->kind == MeshVolume::Kind::labels) {
    auto stage = exec_.stage("tighten");
    tell("tighten", 0.02);
    const TightenResult result = tighten(exec_, bricks_, parameters.tighten);
    info_.constrained_voxels = result.held;
  }
  const SizingRule rule{float(parameters.epsilon), float(parameters.delta), float(parameters.min_size),
                        float(std::max(parameters.min_size, parameters.max_size)), parameters.curvature};
  {
    auto stage = exec_.stage("distance");
    tell("distance", 0.05);
    distance_ = distance_field(exec_, bricks_, 0.5f * rule.min_size, std::min(rule.reach() + 2, 64.0f));
  }
  {
    auto stage = exec_.stage("sizing");
    tell("sizing", 0.08);
    size_ = sizing_field(exec_, distance_, rule);
  }
  {
    auto stage = exec_.stage("embed");
    tell("embed", 0.12);
    // Cells of half the smallest distance of particles suffice for the stencils.
    grid_ =
        embed_interfaces(exec_, bricks_, distance_, size_, std::min(double(parameters.subcells), 2.0 / size_.small));
  }
  relate_interfaces();
  info_.smallest_size = size_.smallest;
  info_.largest_size = size_.largest;
  info_.field_bytes = bricks_.bytes() + distance_.bytes() + std::int64_t(size_.h.bytes());
  info_.embedding_bytes = grid_.bytes();
  info_.embedding_cells = grid_.cells();
  info_.surfaces = info_.curves = 0;
  for (const Junction& j : grid_.junctions) ++(j.order() == 2 ? info_.surfaces : info_.curves);
  info_.points = int(grid_.points.size());
  info_.crowded_points = grid_.crowded_points;
  info_.expected_particles = info_.points;
  for (const int order : {1, 2}) info_.expected_particles += expected_particles(exec_, grid_, order_.data(), order);
  field_mark_ = arena.mark();
  fields_ = true;
}

/// Which interfaces bound which, and the kinds of junction points as interfaces of their own.
template <class Backend>
void MeshPipelineOf<Backend>::relate_interfaces() {
  junctions_ = grid_.junctions;
  std::vector<Junction> points = grid_.point_junction;
  std::sort(points.begin(), points.end(), [](const Junction& a, const Junction& b) { return a.packed < b.packed; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  junctions_.insert(junctions_.end(), points.begin(), points.end());
  std::vector<std::uint32_t> start{0}, related;
  std::vector<std::uint8_t> order;
  for (std::size_t k = 0; k < junctions_.size(); ++k) {
    related.push_back(std::uint32_t(k));
    for (std::size_t l = 0; l < junctions_.size(); ++l)
      if (l != k && junctions_[l].order() < junctions_[k].order() && junctions_[l].bounds(junctions_[k]))
        related.push_back(std::uint32_t(l));
    start.push_back(std::uint32_t(related.size()));
    order.push_back(std::uint8_t(junctions_[k].order()));
  }
  Arena& arena = exec_.arena();
  junction_ = arena.permanent_copy<Junction>(junctions_);
  related_start_ = arena.permanent_copy<std::uint32_t>(start);
  related_ = arena.permanent_copy<std::uint32_t>(related);
  order_ = arena.permanent_copy<std::uint8_t>(order);
}

template <class Backend>
Array<Vec3f> MeshPipelineOf<Backend>::upload_points(std::span<const Vec3d> points) {
  std::vector<Vec3f> host(points.size());
  const float far = 1e6f;
  std::transform(points.begin(), points.end(), host.begin(), [&](const Vec3d& w) {
    const Vec3f p(frame_.to_voxels(w));
    return is_finite(p) ? max(min(p, Vec3f(far)), Vec3f(-far)) : Vec3f(-far);
  });
  Array<Vec3f> array = exec_.arena().template temporary<Vec3f>(host.size());
  array.upload(host);
  return array;
}

template <class Backend>
std::vector<std::uint16_t> MeshPipelineOf<Backend>::material_at(std::span<const Vec3d> points) {
  Arena::Scope scope(exec_.arena());
  const Array<Vec3f> place = upload_points(points);
  Array<std::uint16_t> material = exec_.arena().template temporary<std::uint16_t>(points.size());
  exec_.for_each(std::int64_t(points.size()), detail::MaterialAt{bricks_.view(), place.data(), material.data()});
  return material.download();
}

template <class Backend>
std::vector<float> MeshPipelineOf<Backend>::size_at(std::span<const Vec3d> points) {
  Arena::Scope scope(exec_.arena());
  const Array<Vec3f> place = upload_points(points);
  Array<float> h = exec_.arena().template temporary<float>(points.size());
  exec_.for_each(std::int64_t(points.size()), detail::SizeAt{size_.view(), place.data(), h.data()});
  std::vector<float> result = h.download();
  for (float& x : result) x *= float(frame_.unit);
  return result;
}

template <class Backend>
MeshParticles MeshPipelineOf<Backend>::particles() const {
  MeshParticles result;
  if (!solver_) return result;
  const ParticleSet& set = solver_->particles();
  const std::size_t n = std::size_t(set.count);
  const std::vector<Float4> place = set.place.download(0, n), direction = set.direction.download(0, n);
  const std::vector<std::uint32_t> interface = set.interface.download(0, n);
  for (std::size_t i = 0; i < n; ++i) {
    const Junction j = junctions_[interface[i]];
    result.points.push_back(frame_.to_world(Vec3d(place[i].x, place[i].y, place[i].z)));
    result.size.push_back(place[i].w * float(frame_.unit));
    result.energy.push_back(direction[i].w);
    result.normal.push_back(frame_.direction_to_world({direction[i].x, direction[i].y, direction[i].z}));
    result.order.push_back(std::uint8_t(j.order()));
    std::array<std::uint16_t, 4> materials;
    for (int k = 0; k < 4; ++k) materials[k] = std::uint16_t(j.material(k));
    result.materials.push_back(materials);
  }
  return result;
}

template <class Backend>
SurfaceMesh MeshPipelineOf<Backend>::triangulate() {
  if (!solver_) throw Error("no particles");
  SurfaceMesh mesh;
  for (int round = 0;; ++round) {
    tell("triangulate", 0.86);
    const MeshParticles particles = this->particles();
    std::vector<std::uint32_t> point_of;
    LabelRepair repair;
    {
      auto stage = exec_.stage("triangulate");
      const DelaunayCells cells = delaunay(particles.points, exec_.device().threads());
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

template <class Backend>
SurfaceDistance MeshPipelineOf<Backend>::surface_distance(const SurfaceMesh& mesh) {
  auto stage = exec_.stage("quality");
  std::vector<Vec3d> points;
  std::vector<Junction> junctions;
  std::vector<std::uint32_t> facet(mesh.points.size(), none);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) facet[mesh.triangles[t][k]] = std::uint32_t(t);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (facet[v] == none) continue;
    points.push_back(mesh.points[v]);
    junctions.emplace_back(mesh.materials[facet[v]][0], mesh.materials[facet[v]][1]);
  }
  const std::size_t vertices = points.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    points.push_back((mesh.points[c.a] + mesh.points[c.b] + mesh.points[c.c]) / 3.0);
    junctions.emplace_back(mesh.materials[t][0], mesh.materials[t][1]);
  }
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  const Array<Vec3f> place = upload_points(points);
  Array<Junction> junction = arena.template temporary<Junction>(junctions.size());
  junction.upload(junctions);
  Array<float> distance = arena.template temporary<float>(points.size());
  exec_.for_each(std::int64_t(points.size()),
                 detail::DistanceToInterface{bricks_.view(), place.data(), junction.data(), distance.data()});
  const std::vector<float> d = distance.download();
  SurfaceDistance result;
  const auto measure = [&](std::size_t first, std::size_t last, double& mean, double& largest) {
    std::size_t n = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (d[i] < 0) continue;
      mean += d[i];
      largest = std::max(largest, double(d[i]));
      ++n;
    }
    mean /= double(std::max<std::size_t>(n, 1));
  };
  measure(0, vertices, result.vertex_mean, result.vertex_max);
  measure(vertices, points.size(), result.facet_mean, result.facet_max);
  return result;
}

}  // namespace nacre
