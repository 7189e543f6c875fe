// Nacre: what the parts of `nacre bench` share, and the list of them.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/bench/flow_runs.hpp"
#include "app/bench/mesh_runs.hpp"
#include "app/bench/results.hpp"
#include "app/common.hpp"

namespace nacre {

/// One run of the command.
struct Bench {
  Bench(Device& on, const CommonOptions& words, bool small_one)
      : device(on), common(words), small(small_one), meshes(on), flows(on) {
    meshes.repeats = flows.repeats = 3;
  }

  Device& device;
  const CommonOptions& common;
  bool small;
  std::filesystem::path plots;  ///< where pictures go; empty: nowhere
  MeshRuns meshes;              ///< several tables look at the same runs
  FlowRuns flows;
  std::vector<std::string> outputs;

  /// Says what comes now, then fills a row in. `work` runs what it needs before it adds the row. Where the memory does
  /// not do, the row is left out, aloud; other errors end the command. Throws Interrupted after Ctrl-C.
  void row(BenchTable& table, const std::string& name, const std::string& input, const std::function<void()>& work);
  void leave_out(BenchTable& table, const std::string& name, const std::string& input, const std::string& why);
};

/// A table or side result by its name.
struct BenchPart {
  std::string name;
  BenchTable (*run)(Bench& bench);
};

/// All of them, in the order in which they run: those that look at the same data stand side by side.
const std::vector<BenchPart>& bench_parts();

BenchTable bench_quality(Bench& bench);           ///< Table 3.1
BenchTable bench_solvers(Bench& bench);           ///< Table 3.2
BenchTable bench_synthetic(Bench& bench);         ///< Table 3.3
BenchTable bench_sizing(Bench& bench);            ///< Table 3.4
BenchTable bench_material_quality(Bench& bench);  ///< Table 4.1
BenchTable bench_material_solvers(Bench& bench);  ///< Table 4.2
BenchTable bench_material_stages(Bench& bench);   ///< Table 4.3
BenchTable bench_grid_flow(Bench& bench);         ///< Table 5.1
BenchTable bench_octree_flow(Bench& bench);       ///< Table 6.1
BenchTable bench_neighbour_index(Bench& bench);   ///< Table 6.2
BenchTable bench_arena(Bench& bench);             ///< sec. 5.3
BenchTable bench_gathering(Bench& bench);         ///< sec. 3.3.3
BenchTable bench_grid_octree(Bench& bench);       ///< sec. 6.3.2
BenchTable bench_methods(Bench& bench);           ///< sec. 6.3.1, with pictures

}  // namespace nacre
