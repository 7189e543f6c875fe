// Nacre: particles seeded and moved to rest, curves before surfaces, by the solver that was asked for.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include "compute/particles/control.hpp"
#include "compute/particles/field_surface.hpp"
#include "compute/particles/redblack.hpp"
#include "compute/particles/serial.hpp"
#include "compute/pipeline/mesh_choices.hpp"
#include "compute/pipeline/particle_rules.hpp"
#include "compute/pipeline/particle_store.hpp"
#include "compute/pipeline/seeding.hpp"
#include "compute/pipeline/stage_progress.hpp"

namespace nacre {

/// Seeds and moves the particles of a store. Results are recorded in a MeshInfo and reported stage by stage.
template <class Backend>
class Relaxation {
 public:
  Relaxation(Executor<Backend>& exec, const MeshFields<Backend>& fields, ParticleStore<Backend>& particles)
      : exec_(exec), fields_(fields), particles_(particles) {}

  /// From an empty store with room enough. After an interruption the particles are as they were then.
  void run(const MeshParameters& parameters, const TellStage& tell, MeshInfo& info);
  /// After an interruption: seeds the interfaces that have no particles yet, so that there can be a mesh.
  void finish(const MeshParameters& parameters, MeshInfo& info);

 private:
  /// One run's.
  struct Run {
    const MeshParameters& parameters;
    MeshChoices choices;
    const TellStage& tell;
    MeshInfo& info;
  };
  /// What the particles of one order are moved in: its share of the whole command, and when they were seeded.
  struct Phase {
    int order;
    double from, to;
    std::chrono::steady_clock::time_point begin;
  };

  void seed(const MeshParameters& parameters, int order, MeshInfo& info);
  void relax_order(const Run& run, Phase phase);
  void relax_by_tree(const Run& run, const Phase& phase);
  void relax_in_turns(const Run& run, const Phase& phase);
  void note_iteration(const Run& run, const Phase& phase, int iteration, double energy, std::int64_t movers);
  void spread_seeds(const MeshParameters& parameters);
  double measure_energy();
  void project();

  Executor<Backend>& exec_;
  const MeshFields<Backend>& fields_;
  ParticleStore<Backend>& particles_;
  SolverState turns_;        ///< of the serial and the red-black solver
  int seeded_order_ = 0;     ///< 1: curves have particles, 2: surfaces, too
  bool unfinished_ = false;  ///< moving them was interrupted
};

template <class Backend>
void Relaxation<Backend>::run(const MeshParameters& parameters, const TellStage& tell, MeshInfo& info) {
  const Run run{parameters, MeshChoices(parameters), tell, info};
  info.energy.clear();
  info.count.clear();
  info.seconds.clear();
  info.iterations = 0;
  info.seeded = info.seeded_on_surfaces = 0;
  if (run.choices.solver != Solver::tree) turns_ = make_solver_state(exec_, particles_.set());
  put_points(fields_, particles_.set(), particles_.solver().velocity());
  seeded_order_ = 0;
  unfinished_ = true;
  relax_order(run, {1, 0.18, 0.22, {}});
  relax_order(run, {2, 0.22, 0.85, {}});
  info.final_energy = run.choices.quality == QualityLevel::draft ? 0 : measure_energy();
  project();
}

template <class Backend>
void Relaxation<Backend>::finish(const MeshParameters& parameters, MeshInfo& info) {
  if (!unfinished_) return;
  if (seeded_order_ < 1) seed(parameters, 1, info);
  if (seeded_order_ < 2) seed(parameters, 2, info), spread_seeds(parameters);
  project();
}

template <class Backend>
void Relaxation<Backend>::project() {
  auto stage = exec_.stage("relax");
  particles_.project();
  unfinished_ = false;
}

/// Puts the seeds of an order behind the particles of lower ones, which stay where they are from now on.
template <class Backend>
void Relaxation<Backend>::seed(const MeshParameters& parameters, int order, MeshInfo& info) {
  auto stage = exec_.stage("seed");
  ParticleSet& set = particles_.set();
  set.fixed = set.count;
  const std::int64_t seeds = seed_order(exec_, fields_, parameters, order, set, particles_.solver().velocity());
  seeded_order_ = order;
  info.seeded += seeds;
  if (order == 2) info.seeded_on_surfaces = seeds;
}

/// A few steps of seeds that had no time to settle, so that they leave the rims to the particles there.
template <class Backend>
void Relaxation<Backend>::spread_seeds(const MeshParameters& parameters) {
  auto stage = exec_.stage("relax");
  TreeSolver& solver = particles_.solver();
  TreeRule rule = tree_rule(parameters);
  rule.momentum = 0.6f;
  const std::int64_t movers = solver.movers(exec_, fields_.related(), 2);
  for (int k = 0; k < 16; ++k) {
    if (k % 4 == 0) solver.rebuild(exec_);
    solver.iterate(exec_, fields_.embedded_projector(), fields_.related(), 2, rule, movers);
  }
}

/// The mean of the surfaces. Each solver knows the energy while it moves particles; this one can be compared.
template <class Backend>
double Relaxation<Backend>::measure_energy() {
  auto stage = exec_.stage("relax");
  TreeSolver& solver = particles_.solver();
  solver.rebuild(exec_);
  return solver.forces(exec_, fields_.related(), 2, 0, solver.movers(exec_, fields_.related(), 2));
}

/// Seeds the particles of an order and moves them.
template <class Backend>
void Relaxation<Backend>::relax_order(const Run& run, Phase phase) {
  seed(run.parameters, phase.order, run.info);
  if (particles_.set().count == particles_.set().fixed) return;
  phase.begin = std::chrono::steady_clock::now();
  if (run.choices.solver == Solver::tree)
    relax_by_tree(run, phase);
  else
    relax_in_turns(run, phase);
}

template <class Backend>
void Relaxation<Backend>::note_iteration(const Run& run, const Phase& phase, int iteration, double energy,
                                         std::int64_t movers) {
  if (phase.order == 2) {
    run.info.energy.push_back(energy);
    run.info.count.push_back(movers);
    run.info.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - phase.begin).count());
    ++run.info.iterations;
  }
  const double done = (phase.to - phase.from) * iteration / run.parameters.iterations;
  run.tell("relax", phase.from + done, iteration, energy);
}

/// All at once (ch. 4): control of the number until nothing changes, then the rest of the iterations to settle.
template <class Backend>
void Relaxation<Backend>::relax_by_tree(const Run& run, const Phase& phase) {
  TreeSolver& solver = particles_.solver();
  const MeshParameters& parameters = run.parameters;
  const RelatedView related = fields_.related();
  const EmbeddedProjector projector = fields_.embedded_projector();
  const int order = phase.order;
  std::int64_t movers = solver.movers(exec_, related, order);
  const TreeRule rule = tree_rule(parameters);
  PopulationRule population = population_rule(parameters, order);
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
      if (!sorted || k % 5 == 0) solver.rebuild(exec_);
      sorted = true;
      energy = control ? solver.forces(exec_, related, order, rule.theta, movers)
                       : solver.iterate(exec_, projector, related, order, rule, movers);
    }
    if (control) {
      auto stage = exec_.stage("population");
      const IterationResult changed =
          solver.control(exec_, projector, related, order, rule.theta, population, movers, k);
      movers = solver.movers(exec_, related, order);
      controls = changed.added + changed.deleted > 0;
      sorted = false;
      continue;
    }
    note_iteration(run, phase, k + 1, energy, movers);
    const bool settled = !controls || k > last_control;
    if (settled && k % every == every - 1 && before > 0 && std::fabs(before - energy) < parameters.stagnation * energy)
      break;
    before = energy;
  }
}

/// One after the other, in turns (ch. 3): serial or red-black, on the fields themselves.
template <class Backend>
void Relaxation<Backend>::relax_in_turns(const Run& run, const Phase& phase) {
  ParticleSet& set = particles_.set();
  const MeshParameters& parameters = run.parameters;
  SolverParameters rule;
  rule.population = population_rule(parameters, phase.order);
  forget(exec_, turns_, rule);
  const Array<Junction>& table = fields_.junctions();
  const FieldSurface<SizingFieldView> surface{fields_.bricks().view(), fields_.size().view(), table.data()};
  const int iterations = parameters.iterations, every = std::max(1, parameters.control_every);
  const int last_control = every == 1 ? iterations : iterations - 2 * every;
  double before = 0;
  for (int k = 0; k < iterations; ++k) {
    IterationResult turn;
    {
      auto stage = exec_.stage("relax");
      turn = run.choices.solver == Solver::serial ? serial_iteration(exec_, set, turns_, table, surface, rule)
                                                  : redblack_iteration(exec_, set, turns_, table, surface, rule);
    }
    note_iteration(run, phase, k + 1, turn.energy, set.count - set.fixed);
    bool changed = false;
    if ((k + 1) % every == 0 && k < last_control) {
      auto stage = exec_.stage("population");
      const IterationResult population = control_population(exec_, set, turns_, table, surface, rule);
      changed = 200 * (population.added + population.deleted) > set.count - set.fixed;
    }
    if (!changed && before > 0 && std::fabs(before - turn.energy) < parameters.stagnation * turn.energy) break;
    before = turn.energy;
  }
  particles_.rest();
}

}  // namespace nacre
