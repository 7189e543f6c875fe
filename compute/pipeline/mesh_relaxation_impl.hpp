// Nacre: the part of the mesh pipeline that moves particles: seeds, the three solvers, population.
#pragma once

#include <algorithm>
#include <cmath>

#include "compute/particles/control.hpp"
#include "compute/particles/field_surface.hpp"
#include "compute/particles/marching_cubes_seeds.hpp"
#include "compute/particles/redblack.hpp"
#include "compute/particles/serial.hpp"
#include "compute/pipeline/mesh_pipeline_impl.hpp"

namespace nacre {

template <class Backend>
PopulationRule MeshPipelineOf<Backend>::population_rule(int order) const {
  PopulationRule rule;
  const double hexagonal = parameters.ideal_energy > 0 ? parameters.ideal_energy : hexagonal_energy;
  rule.ideal_energy = float(order == 2 ? hexagonal : hexagonal * row_energy / hexagonal_energy);
  rule.add_below = float(order == 2 ? parameters.add_below : std::max(parameters.add_below, 0.75));
  rule.delete_above = float(order == 2 ? parameters.delete_above : std::max(parameters.delete_above, 3.5));
  rule.certain_above = order == 2 ? 4.0f : 8.0f;
  rule.by_density = parameters.by_density;
  rule.may_add = parameters.particles == 0;
  rule.seed = parameters.seed;
  return rule;
}

/// Crowded places relax to fewer, holes fill: half as many again has always been enough.
inline double particle_room(double expected) { return 1.6 * expected + 20000; }

/// How many particles there will be about, with the junctions, which have theirs as ever where the number of those on
/// surfaces is given.
template <class Backend>
double MeshPipelineOf<Backend>::particles_to_expect() {
  if (parameters.particles == 0) return info_.expected_particles;
  return parameters.particles + info_.points + expected_particles(exec_, embedding_seeds(1));
}

template <class Backend>
std::int64_t MeshPipelineOf<Backend>::particle_capacity() {
  require_fields();
  return std::int64_t(particle_room(particles_to_expect()));
}

/// How many particles the solver shall have room for. Throws Error where the memory is too small for that; `why` goes
/// before their number.
template <class Backend>
double MeshPipelineOf<Backend>::require_room_for(double particles, const std::string& why) {
  const std::size_t free = exec_.arena().free_bytes();
  const double capacity = particle_room(particles);
  const double turns = parameters.solver == "tree" ? 0 : 2 * sizeof(Float4) + 3 * sizeof(float);  // SolverState
  const double bytes =
      capacity * (2 * (sizeof(Float4) * 3 + 4) + 12 + 20 + 40 + 2 * double(sizeof(TreeNode)) / 3 + turns);
  if (capacity > 4e9 || bytes > double(free))
    throw Error("too many particles for the memory",
                why + std::to_string(std::int64_t(particles)) + ", which take " +
                    std::to_string(std::int64_t(bytes / (1 << 20))) + " MiB; " + std::to_string(free >> 20) +
                    " MiB are free",
                parameters.particles > 0 ? "lower --particles" : "raise --max-size and --min-size, or --epsilon");
  return capacity;
}

template <class Backend>
void MeshPipelineOf<Backend>::make_solver() {
  drop_particles();
  exec_.arena().rewind(mark_[field_stages]);
  const double capacity =
      require_room_for(particles_to_expect(), parameters.particles > 0 ? "--particles asks, with the junctions, for "
                                                                       : "the sizing field asks for about ");
  auto solver = std::make_unique<TreeSolver>(exec_, std::int64_t(capacity), std::int64_t(junctions_.size()),
                                             float(frame_.extent()));
  solver->particles().count = 0;
  if (parameters.solver != "tree") turns_ = make_solver_state(exec_, solver->particles());
  solver_ = std::move(solver);
}

template <class Backend>
void MeshPipelineOf<Backend>::add_points() {
  const std::size_t n = grid_.points.size();
  if (n == 0) return;
  std::vector<std::uint32_t> interface;
  for (const Junction& j : grid_.point_junction)
    for (std::size_t k = grid_.junctions.size(); k < junctions_.size(); ++k)
      if (junctions_[k] == j) interface.push_back(std::uint32_t(k));
  const std::vector<Float4> zero(n, Float4{0, 0, 0, 0});
  ParticleSet& set = solver_->particles();
  set.place.upload(grid_.points);
  set.direction.upload(zero);
  set.interface.upload(interface);
  solver_->velocity().upload(zero);
  set.count = std::int64_t(n);
}

template <class Backend>
void MeshPipelineOf<Backend>::relax() {
  require_fields();
  make_solver();
  info_.energy.clear();
  info_.count.clear();
  info_.seconds.clear();
  info_.iterations = 0;
  info_.seeded = info_.seeded_on_surfaces = 0;
  add_points();
  seeded_order_ = 0;
  unfinished_ = true;
  relax_order(1, 0.18, 0.22);
  relax_order(2, 0.22, 0.85);
  measure_energy();
  auto stage = exec_.stage("relax");
  polish();
  unfinished_ = false;
}

/// What has been done before an interruption can be triangulated if every interface has its particles.
template <class Backend>
void MeshPipelineOf<Backend>::finish_relaxing() {
  if (!unfinished_) return;
  if (seeded_order_ < 1) seed_order(1);
  if (seeded_order_ < 2) seed_order(2), spread_seeds();
  auto stage = exec_.stage("relax");
  polish();
  unfinished_ = false;
}

/// A few steps of seeds that had no time to settle, so that they leave the rims to the particles there.
template <class Backend>
void MeshPipelineOf<Backend>::spread_seeds() {
  auto stage = exec_.stage("relax");
  const RelatedView related = this->related();
  TreeRule rule = tree_rule();
  rule.momentum = 0.6f;
  const std::int64_t movers = solver_->movers(exec_, related, 2);
  for (int k = 0; k < 16; ++k) {
    if (k % 4 == 0) solver_->rebuild(exec_);
    solver_->iterate(exec_, embedded_ground(), related, 2, rule, movers);
  }
}

/// Each solver knows the energy while it moves particles; this one can be compared.
template <class Backend>
void MeshPipelineOf<Backend>::measure_energy() {
  auto stage = exec_.stage("relax");
  solver_->rebuild(exec_);
  const RelatedView related = this->related();
  info_.final_energy = solver_->forces(exec_, related, 2, 0, solver_->movers(exec_, related, 2));
}

/// Brings the particles from number `first` on onto the fields; new ones get their size; those that have strayed from
/// their interface are taken out.
template <class Backend>
void MeshPipelineOf<Backend>::polish(std::int64_t first) {
  const ParticleSet& set = solver_->particles();
  const std::int64_t count = set.count - first;
  Arena::Scope scope(exec_.arena());
  Array<std::uint8_t> lost = exec_.arena().template temporary<std::uint8_t>(count);
  exec_.for_each(count,
                 detail::PolishParticle{bricks_.view(), size_.view(), junction_.data(), set.interface.data() + first,
                                        set.place.data() + first, set.direction.data() + first, lost.data()});
  std::vector<std::uint8_t> gone = lost.download();
  gone.insert(gone.begin(), std::size_t(first), 0);
  if (std::find(gone.begin(), gone.end(), 1) != gone.end()) change_particles(gone, {});
}

template <class Backend>
HostParticles MeshPipelineOf<Backend>::download_particles() const {
  const ParticleSet& set = solver_->particles();
  const std::size_t n = std::size_t(set.count);
  return {set.place.download(0, n), set.direction.download(0, n), set.interface.download(0, n)};
}

/// Instead of those that there are; all rest.
template <class Backend>
void MeshPipelineOf<Backend>::upload_particles(const HostParticles& particles) {
  ParticleSet& set = solver_->particles();
  const std::size_t n = particles.place.size();
  set.count = std::int64_t(n);
  set.place.upload(particles.place);
  set.direction.upload(particles.direction);
  set.interface.upload(particles.interface);
  solver_->velocity().upload(std::vector<Float4>(n, Float4{0, 0, 0, 0}));
}

/// Takes particles out and puts new ones in, of size 0, behind those that stay; all then rest. How many stay.
template <class Backend>
std::int64_t MeshPipelineOf<Backend>::change_particles(std::span<const std::uint8_t> gone,
                                                       std::span<const MeshDefects::NewPoint> born) {
  HostParticles all = download_particles();
  auto& [place, direction, interface] = all;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < place.size(); ++i)
    if (!gone[i]) place[kept] = place[i], direction[kept] = direction[i], interface[kept++] = interface[i];
  place.resize(kept), direction.resize(kept), interface.resize(kept);
  for (const MeshDefects::NewPoint& p : born) {
    const auto k = std::find(junctions_.begin(), junctions_.end(), Junction(p.materials[0], p.materials[1]));
    if (k == junctions_.end() || place.size() == std::size_t(solver_->particles().capacity())) continue;
    const Vec3d at = frame_.to_voxels(p.place);
    place.push_back({float(at.x), float(at.y), float(at.z), 0});
    direction.push_back({0, 0, 0, 0});
    interface.push_back(std::uint32_t(k - junctions_.begin()));
  }
  upload_particles(all);
  return std::int64_t(kept);
}

/// Ch. 3 begins from marching cubes, ch. 4 from the embedding; so do curves, which marching cubes do not have.
template <class Backend>
bool MeshPipelineOf<Backend>::by_marching_cubes() const {
  return parameters.seeds == "auto" ? parameters.solver != "tree" : parameters.seeds == "marching-cubes";
}

/// Puts the seeds of an order behind the particles of lower ones, which stay where they are from now on.
template <class Backend>
void MeshPipelineOf<Backend>::seed_order(int order) {
  auto stage = exec_.stage("seed");
  ParticleSet& set = solver_->particles();
  set.fixed = set.count;
  Arena::Scope scope(exec_.arena());
  const auto put = [&](const auto& source) {
    double scale = 1;
    if (order == 2 && parameters.particles > 0)
      scale = parameters.particles / std::max(1.0, expected_particles(exec_, source));
    return seed_particles(exec_, source, scale, parameters.seed, set, solver_->velocity());
  };
  const std::int64_t seeds = order == 2 && by_marching_cubes()
                                 ? put(marching_cubes(exec_, bricks_, size_, grid_.junction))
                                 : put(embedding_seeds(order));
  seeded_order_ = order;
  info_.seeded += seeds;
  if (order == 2) info_.seeded_on_surfaces = seeds;
}

/// Seeds the particles of an order and moves them by the solver that was asked for.
template <class Backend>
void MeshPipelineOf<Backend>::relax_order(int order, double from, double to) {
  seed_order(order);
  if (solver_->particles().count == solver_->particles().fixed) return;
  seeded_ = std::chrono::steady_clock::now();
  if (parameters.solver == "tree")
    relax_by_tree(order, from, to);
  else
    relax_by_turns(order, from, to);
}

template <class Backend>
void MeshPipelineOf<Backend>::note_iteration(int order, double energy, std::int64_t movers) {
  if (order != 2) return;
  info_.energy.push_back(energy);
  info_.count.push_back(movers);
  info_.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - seeded_).count());
  ++info_.iterations;
}

/// All at once (ch. 4): control of the number until nothing changes, then the rest of the iterations to settle.
template <class Backend>
void MeshPipelineOf<Backend>::relax_by_tree(int order, double from, double to) {
  const RelatedView related = this->related();
  std::int64_t movers = solver_->movers(exec_, related, order);
  const TreeRule rule = tree_rule();
  PopulationRule population = population_rule(order);
  if (parameters.particles == 0) population.target = movers;  // as many as the sizing field asked for
  const int iterations = parameters.iterations, every = std::max(1, parameters.control_every);
  const int last_control = iterations - 2 * every;
  bool controls = true, sorted = false;
  double before = 0;
  for (int k = 0; k < iterations; ++k) {
    const bool control = controls && k > 0 && k % every == 0 && k <= last_control;
    double energy = 0;
    {
      auto stage = exec_.stage("relax");
      if (!sorted || k % 5 == 0) solver_->rebuild(exec_);
      sorted = true;
      energy = control ? solver_->forces(exec_, related, order, rule.theta, movers)
                       : solver_->iterate(exec_, embedded_ground(), related, order, rule, movers);
    }
    if (control) {
      auto stage = exec_.stage("population");
      const IterationResult changed =
          solver_->control(exec_, embedded_ground(), related, order, rule.theta, population, movers, k);
      movers = solver_->movers(exec_, related, order);
      controls = changed.added + changed.deleted > 0;
      sorted = false;
      continue;
    }
    tell("relax", from + (to - from) * (k + 1) / iterations, k + 1, energy);
    note_iteration(order, energy, movers);
    const bool settled = !controls || k > last_control;
    if (settled && k % every == every - 1 && before > 0 && std::fabs(before - energy) < parameters.stagnation * energy)
      break;
    before = energy;
  }
}

/// One after the other, in turns (ch. 3): serial or red-black, on the fields themselves.
template <class Backend>
void MeshPipelineOf<Backend>::relax_by_turns(int order, double from, double to) {
  ParticleSet& set = solver_->particles();
  SolverParameters rule;
  rule.population = population_rule(order);
  forget(exec_, turns_, rule);
  const FieldSurface<SizingFieldView> surface{bricks_.view(), size_.view(), junction_.data()};
  const int iterations = parameters.iterations, every = std::max(1, parameters.control_every);
  const int last_control = every == 1 ? iterations : iterations - 2 * every;
  double before = 0;
  for (int k = 0; k < iterations; ++k) {
    IterationResult turn;
    {
      auto stage = exec_.stage("relax");
      turn = parameters.solver == "serial" ? serial_iteration(exec_, set, turns_, junction_, surface, rule)
                                           : redblack_iteration(exec_, set, turns_, junction_, surface, rule);
    }
    note_iteration(order, turn.energy, set.count - set.fixed);
    tell("relax", from + (to - from) * (k + 1) / iterations, k + 1, turn.energy);
    bool changed = false;
    if ((k + 1) % every == 0 && k < last_control) {
      auto stage = exec_.stage("population");
      const IterationResult population = control_population(exec_, set, turns_, junction_, surface, rule);
      changed = 200 * (population.added + population.deleted) > set.count - set.fixed;
    }
    if (!changed && before > 0 && std::fabs(before - turn.energy) < parameters.stagnation * turn.energy) break;
    before = turn.energy;
  }
  solver_->velocity().upload(std::vector<Float4>(std::size_t(set.count), Float4{0, 0, 0, 0}));
}

}  // namespace nacre
