// Nacre: the particles on the device, between the solvers that move them and the host that changes them for the mesh.
#pragma once

#include <algorithm>
#include <memory>

#include "compute/meshing/device_stars.hpp"
#include "compute/particles/ring_smoothing.hpp"
#include "compute/particles/tree_solver.hpp"
#include "compute/pipeline/mesh_fields.hpp"
#include "compute/pipeline/mesh_probe.hpp"
#include "compute/pipeline/movable_particles.hpp"

namespace nacre {

namespace detail {

/// Puts the particles onto the fields themselves after the last move, and marks those that have no interface nearby.
struct ProjectParticle {
  MaterialBricksView field;
  SizingFieldView size;
  const Junction* junction;
  const std::uint32_t* interface;
  Float4* position;
  Float4* direction;
  std::uint8_t* lost;
  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 at = position[i];
    const Junction j = junction[interface[i]];
    lost[i] = 0;
    if (j.order() == 0) return;
    JunctionPoint on;
    lost[i] = 1;
    if (!project(field, j, {at.x, at.y, at.z}, 0.7f, on)) return;
    if (junction_margin(field, j, on.p, on.steepness) < -0.02f) return;
    lost[i] = 0;
    position[i] = {on.p.x, on.p.y, on.p.z, at.w > 0 ? at.w : size(on.p)};
    direction[i] = {on.direction.x, on.direction.y, on.direction.z, direction[i].w};
  }
};

}  // namespace detail

/// The particles of a mesh. They are held by a tree solver, whichever solver moves them, in permanent memory.
template <class Backend>
class ParticleStore : public MovableParticles {
 public:
  ParticleStore(Executor<Backend>& exec, const MeshFields<Backend>& fields) : exec_(exec), fields_(fields) {}

  /// Room for `capacity` particles; there are none yet.
  void make(std::int64_t capacity) {
    solver_ = std::make_unique<TreeSolver>(exec_, capacity, std::int64_t(fields_.table().junctions.size()),
                                           float(fields_.frame().extent()));
    solver_->particles().count = 0;
  }
  void drop() { solver_.reset(); }
  bool made() const { return solver_ != nullptr; }

  TreeSolver& solver() { return *solver_; }
  const TreeSolver& solver() const { return *solver_; }
  ParticleSet& set() { return solver_->particles(); }
  std::int64_t count() const override { return solver_ ? solver_->particles().count : 0; }

  HostParticles download() const override;
  void upload(const HostParticles& particles) override;
  std::vector<std::uint32_t> replace(std::span<const std::uint8_t> gone,
                                     std::span<const MeshDefects::NewPoint> born) override;
  void smooth(const TriangleRings& rings, const SmoothingRule& rule, const std::function<void(int)>& turned) override;
  std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) override {
    return nacre::material_at(exec_, fields_, points);
  }
  std::vector<JunctionGradients> junction_gradients(std::span<const Vec3f> points,
                                                    std::span<const Junction> junctions) override {
    return nacre::junction_gradients(exec_, fields_, points, junctions);
  }
  std::vector<Vec3d> onto_junctions(std::span<const Vec3d> points, std::span<const Junction> junctions,
                                    bool within) override {
    return nacre::onto_junctions(exec_, fields_, points, junctions, within);
  }
  std::unique_ptr<StarDevice> star_device() override { return std::make_unique<DeviceStars<Backend>>(exec_); }
  void in_stage(std::string_view name, const std::function<void()>& work) override {
    auto stage = exec_.stage(name);
    work();
  }

  /// Brings the particles from number `first` on onto the fields. New ones get their size; those that have strayed from
  /// their interface are taken out: the marks returned, one for each from `first` on.
  std::vector<std::uint8_t> project(std::size_t first = 0);
  /// All particles at rest.
  void rest() { solver_->velocity().upload(std::vector<Float4>(std::size_t(count()), Float4{0, 0, 0, 0})); }

 private:
  /// As `replace`, but the new particles stay where they are put.
  std::vector<std::uint32_t> change(std::span<const std::uint8_t> gone, std::span<const MeshDefects::NewPoint> born);

  Executor<Backend>& exec_;
  const MeshFields<Backend>& fields_;
  std::unique_ptr<TreeSolver> solver_;
};

template <class Backend>
HostParticles ParticleStore<Backend>::download() const {
  const ParticleSet& set = solver_->particles();
  const std::size_t n = std::size_t(set.count);
  return {set.position.download(0, n), set.direction.download(0, n), set.interface.download(0, n)};
}

template <class Backend>
void ParticleStore<Backend>::upload(const HostParticles& particles) {
  ParticleSet& set = solver_->particles();
  set.count = std::int64_t(particles.count());
  set.position.upload(particles.position);
  set.direction.upload(particles.direction);
  set.interface.upload(particles.interface);
  rest();
}

template <class Backend>
std::vector<std::uint32_t> ParticleStore<Backend>::change(std::span<const std::uint8_t> gone,
                                                          std::span<const MeshDefects::NewPoint> born) {
  HostParticles particles = download();
  std::vector<std::uint32_t> taken = replace_particles(particles, gone, born, fields_.table(), fields_.frame(),
                                                       std::size_t(solver_->particles().capacity()));
  upload(particles);
  return taken;
}

template <class Backend>
std::vector<std::uint32_t> ParticleStore<Backend>::replace(std::span<const std::uint8_t> gone,
                                                           std::span<const MeshDefects::NewPoint> born) {
  std::vector<std::uint32_t> taken = change(gone, born);
  const std::vector<std::uint8_t> lost = project(std::size_t(count()) - taken.size());  // the others lie on the fields
  std::size_t k = 0;
  std::erase_if(taken, [&](std::uint32_t) { return lost[k++] != 0; });
  return taken;
}

template <class Backend>
std::vector<std::uint8_t> ParticleStore<Backend>::project(std::size_t first) {
  const ParticleSet& set = solver_->particles();
  const std::int64_t count = set.count - std::int64_t(first);
  Arena::Scope scope(exec_.arena());
  Array<std::uint8_t> lost = exec_.arena().template temporary<std::uint8_t>(count);
  exec_.for_each(count,
                 detail::ProjectParticle{fields_.bricks().view(), fields_.size().view(), fields_.junctions().data(),
                                         set.interface.data() + first, set.position.data() + first,
                                         set.direction.data() + first, lost.data()});
  const std::vector<std::uint8_t> lost_ones = lost.download();
  std::vector<std::uint8_t> gone(first, 0);
  gone.insert(gone.end(), lost_ones.begin(), lost_ones.end());
  if (std::find(gone.begin(), gone.end(), 1) != gone.end()) change(gone, {});
  return lost_ones;
}

template <class Backend>
void ParticleStore<Backend>::smooth(const TriangleRings& rings, const SmoothingRule& rule,
                                    const std::function<void(int)>& turned) {
  ParticleSet& set = solver_->particles();
  Arena::Scope scope(exec_.arena());
  detail::SmoothingScratch scratch(exec_.arena(), std::size_t(set.count), rings.edge.size());
  scratch.first.upload(rings.first);
  scratch.edge.upload(rings.edge);
  scratch.margin.fill_bytes(0);
  const auto step_from = [&](const Array<Float4>& from, std::uint32_t shake) {
    return detail::RingStep{scratch.first.data(),
                            scratch.edge.data(),
                            fields_.order(),
                            set.interface.data(),
                            from.data(),
                            set.direction.data(),
                            shake};
  };
  for (int k = 0; k < rule.turns; k += 2) {
    {
      auto stage = exec_.stage("smooth");
      exec_.for_each(set.count,
                     detail::SlideInRing{step_from(set.position, k == 0 ? rule.shake : 0), scratch.slid.data()});
      exec_.for_each(set.count, detail::SettleInRing<FieldProjector>{step_from(scratch.slid, 0),
                                                                     fields_.field_projector(), set.position.data(),
                                                                     set.direction.data(), scratch.margin.data()});
    }
    turned(k + 2);
  }
}

}  // namespace nacre
