// Nacre: what the parts of `nacre bench` share, and the list of them.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/bench/flow_runs.hpp"
#include "app/bench/mesh_runs.hpp"
#include "app/bench/results.hpp"
#include "app/common.hpp"

namespace nacre {

/// How large the data of the tables are. Tiny is for tests: its figures mean nothing.
enum class BenchScale { whole, small, tiny };

/// One run of the command: what it works with, and its results so far.
class Bench {
 public:
  Bench(Device& on, const CommonOptions& options, BenchScale size)
      : device(on), scale(size), small(size != BenchScale::whole), meshes(on), flows(on), common_(options) {
    meshes.repeats = flows.repeats = 3;
  }

  Device& device;
  const BenchScale scale;
  const bool small;             ///< or tiny
  std::filesystem::path plots;  ///< where pictures go; empty: nowhere
  MeshRuns meshes;              ///< several tables use the same runs
  FlowRuns flows;
  std::vector<std::string> outputs;

  const std::deque<BenchTable>& tables() const { return tables_; }

  /// Of a phantom: its own, or `small_one`, or two thirds of that.
  int detail(int small_one) const { return pick(0, small_one, small_one * 2 / 3); }
  /// The one for this run's scale.
  int pick(int whole, int small_one, int tiny_one) const {
    return scale == BenchScale::whole ? whole : scale == BenchScale::small ? small_one : tiny_one;
  }

  /// Begins a table and prints what stands above its rows; `differs`: from the thesis, beside the hardware.
  BenchTable& begin(std::string name, std::string title, std::vector<std::string> differs);
  /// Says what is measured next, lets `work` fill in the row, and prints it at once. Where the memory does not suffice,
  /// the row is left out with a warning; other errors end the command. Throws Interrupted after Ctrl-C.
  void row(BenchTable& table, const std::string& name, const std::string& input,
           const std::function<void(BenchRow&)>& work);
  void leave_out(BenchTable& table, const std::string& name, const std::string& input, const std::string& why);
  /// Ends the table that was begun last.
  void end();

 private:
  void print_last_row(BenchTable& table);

  const CommonOptions& common_;
  std::deque<BenchTable> tables_;  // a deque: references to its tables stay valid
  double begun_ = 0;
};

/// A table or side result by its name.
struct BenchPart {
  std::string name;
  void (*run)(Bench& bench);
};

/// All of them, in the order in which they run: those that look at the same data stand side by side.
const std::vector<BenchPart>& bench_parts();

void bench_quality(Bench& bench);           ///< Table 3.1
void bench_solvers(Bench& bench);           ///< Table 3.2
void bench_synthetic(Bench& bench);         ///< Table 3.3
void bench_sizing(Bench& bench);            ///< Table 3.4
void bench_material_quality(Bench& bench);  ///< Table 4.1
void bench_material_solvers(Bench& bench);  ///< Table 4.2
void bench_material_stages(Bench& bench);   ///< Table 4.3
void bench_grid_flow(Bench& bench);         ///< Table 5.1
void bench_octree_flow(Bench& bench);       ///< Table 6.1
void bench_neighbour_index(Bench& bench);   ///< Table 6.2
void bench_arena(Bench& bench);             ///< sec. 5.3
void bench_gathering(Bench& bench);         ///< sec. 3.3.3
void bench_grid_octree(Bench& bench);       ///< sec. 6.3.2
void bench_methods(Bench& bench);           ///< sec. 6.3.1, with pictures
void bench_transport(Bench& bench);         ///< docs/method/topology.md, transport.md

}  // namespace nacre
