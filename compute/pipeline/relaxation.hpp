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
  /// Which particles there are of an order: those that were seeded, a quarter of them, or as many again from that.
  enum class Level { seeded, coarse, refined };
  /// What the particles of one order are moved in, and its share of the whole command.
  struct Phase {
    int order;
    double from, to;
    Level level = Level::seeded;
  };

  void seed(const MeshParameters& parameters, int order, MeshInfo& info);
  void relax_coarse_first(const Run& run);
  bool thin(int order);
  void refine();
  void relax_order(const Run& run, const Phase& phase);
  void relax_by_tree(const Run& run, const Phase& phase);
  void relax_in_turns(const Run& run, const Phase& phase);
  void note_iteration(const Run& run, const Phase& phase, int iteration, double energy, std::int64_t movers);
  void spread_seeds(const MeshParameters& parameters);
  double measure_energy();
  void project();

  Executor<Backend>& exec_;
  const MeshFields<Backend>& fields_;
  ParticleStore<Backend>& particles_;
  SolverState turns_;           ///< of the serial and the red-black solver
  int seeded_order_ = 0;        ///< 1: curves have particles, 2: surfaces, too
  std::int64_t seeds_[3] = {};  ///< per order: as many particles as there are to be
  bool coarse_ = false;         ///< some interfaces have a quarter of them
  double crowded_out_ = 0;      ///< share of the quarter on surfaces that had no room
  std::chrono::steady_clock::time_point surfaces_begin_;
  bool unfinished_ = false;  ///< moving them was interrupted
};

template <class Backend>
void Relaxation<Backend>::run(const MeshParameters& parameters, const TellStage& tell, MeshInfo& info) {
  const Run run{parameters, MeshChoices(parameters), tell, info};
  info.energy.clear();
  info.count.clear();
  info.seconds.clear();
  info.iterations = info.coarse_iterations = 0;
  info.seeded = info.seeded_on_surfaces = 0;
  if (run.choices.solver != Solver::tree) turns_ = make_solver_state(exec_, particles_.set());
  put_points(fields_, particles_.set(), particles_.solver().velocity());
  seeded_order_ = 0;
  unfinished_ = true;
  coarse_ = false;
  crowded_out_ = 0;
  if (run.choices.solver == Solver::tree && parameters.coarse_iterations > 0 && parameters.particles == 0) {
    relax_coarse_first(run);
  } else {
    seed(parameters, 1, info), relax_order(run, {1, 0.18, 0.22});
    seed(parameters, 2, info), relax_order(run, {2, 0.22, 0.85});
  }
  info.final_energy = run.choices.quality == QualityLevel::draft ? 0 : measure_energy();
  project();
}

template <class Backend>
void Relaxation<Backend>::finish(const MeshParameters& parameters, MeshInfo& info) {
  if (!unfinished_) return;
  if (seeded_order_ < 1) seed(parameters, 1, info);
  const bool unsettled = seeded_order_ < 2 || coarse_;
  if (seeded_order_ < 2) seed(parameters, 2, info);
  if (coarse_) refine();
  if (unsettled) spread_seeds(parameters);
  project();
}

/// A quarter of the particles settle, then all of them from these: long waves of their density, which take the most
/// iterations, are even when the many begin.
template <class Backend>
void Relaxation<Backend>::relax_coarse_first(const Run& run) {
  particles_.solver().reset_spacing(exec_);
  seed(run.parameters, 1, run.info);
  if (thin(1)) relax_order(run, {1, 0.18, 0.2, Level::coarse});
  seed(run.parameters, 2, run.info);
  if (thin(2)) relax_order(run, {2, 0.2, 0.35, Level::coarse});
  const Level level = coarse_ ? Level::refined : Level::seeded;
  if (coarse_) refine();
  relax_order(run, {1, 0.35, 0.37, level});
  relax_order(run, {2, 0.37, 0.85, level});
}

/// Whether any interface of the order has enough particles for that.
template <class Backend>
bool Relaxation<Backend>::thin(int order) {
  auto stage = exec_.stage("relax");
  if (seeds_[order] == 0) return false;
  TreeSolver& solver = particles_.solver();
  solver.rebuild(exec_);
  const bool thinned = solver.thin(exec_, fields_.related(), order) > 0;
  coarse_ |= thinned;
  return thinned;
}

template <class Backend>
void Relaxation<Backend>::refine() {
  auto stage = exec_.stage("relax");
  TreeSolver& solver = particles_.solver();
  solver.rebuild(exec_);
  solver.refine(exec_, fields_.related(), fields_.embedded_projector());
  coarse_ = false;
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
  seeds_[order] = seeds;
  info.seeded += seeds;
  if (order == 2) info.seeded_on_surfaces = seeds, surfaces_begin_ = std::chrono::steady_clock::now();
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

/// Moves the particles of an order, if there are any.
template <class Backend>
void Relaxation<Backend>::relax_order(const Run& run, const Phase& phase) {
  if (seeds_[phase.order] == 0) return;
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
    run.info.seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - surfaces_begin_).count());
    ++run.info.iterations;
    if (phase.level == Level::coarse) ++run.info.coarse_iterations;
  }
  const int most = phase.level == Level::coarse ? run.parameters.coarse_iterations : run.parameters.iterations;
  const double done = (phase.to - phase.from) * iteration / most;
  run.tell("relax", std::min(phase.from + done, phase.to), iteration, energy);
}

/// All at once (ch. 4): control of the number until nothing changes, then the rest of the iterations to settle.
template <class Backend>
void Relaxation<Backend>::relax_by_tree(const Run& run, const Phase& phase) {
  TreeSolver& solver = particles_.solver();
  const MeshParameters& parameters = run.parameters;
  const RelatedView related = fields_.related();
  EmbeddedProjector projector = fields_.embedded_projector();
  const bool coarse = phase.level == Level::coarse;
  if (coarse) projector.spacing = solver.spacing();
  const int order = phase.order;
  std::int64_t movers = solver.movers(exec_, related, order);
  TreeRule rule = tree_rule(parameters);
  double stagnation = parameters.stagnation;
  if (phase.level != Level::seeded) {  // without the long waves of seeds, which are what so heavy a ball is for
    rule.step *= 1.25f, rule.momentum *= 15.0f / 17;  // 1.5 and 0.75 by default
    stagnation *= 2;
  }
  PopulationRule population = population_rule(parameters, order);
  // As many as the sizing field asked for.
  if (parameters.particles == 0) population.target = coarse ? movers : seeds_[order];
  const std::int64_t begun = movers;
  const int iterations = coarse ? parameters.coarse_iterations : parameters.iterations;
  // A quarter need more control, where they are squeezed in between rims; then the number is right, nearly.
  const bool refined = phase.level == Level::refined;
  int every = std::max(1, coarse || refined ? 3 * parameters.control_every / 5 : parameters.control_every);
  if (refined) every = std::clamp(iterations / 4, 1, every);  // in a draft, too
  int last_control = iterations - (coarse ? 1 : 2) * every;
  if (refined) {
    last_control = std::min(last_control, 2 * every);
    population.slack = 0.02;
    // Rims crowd out those beside them, in a strip that is half as wide now.
    if (order == 2) population.target = std::int64_t((1 - 0.5 * crowded_out_) * double(seeds_[order]));
  }
  bool controls = true, sorted = false;
  double before = 0;
  int resting = 0;  // iterations in a row
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
    const bool settled = !coarse && (!controls || k > last_control);
    const bool rests = settled && before > 0 && std::fabs(before - energy) < stagnation * energy;
    resting = rests ? resting + 1 : 0;  // energies go up and down a little
    if (resting == 3) break;
    before = energy;
  }
  if (coarse && order == 2) crowded_out_ = std::max(0.0, 1 - double(movers) / double(begun));
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
