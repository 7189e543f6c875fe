// Nacre: runs of the mesh pipeline on built-in volumes, each done once for all tables.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// What fields are made of. The rest are the thesis's constants.
struct MeshJob {
  std::string sample;
  int detail = 0;  ///< voxels along the longest side; 0: the sample's own
  double epsilon = 0.5, delta = 0.4, min_size = 0.5;

  bool operator<(const MeshJob& o) const {
    return std::tie(sample, detail, epsilon, delta, min_size) <
           std::tie(o.sample, o.detail, o.epsilon, o.delta, o.min_size);
  }
};

/// How particles move.
struct MeshSolve {
  std::string solver;    ///< tree, redblack, serial; "own": the tree with Nacre's own settings, remeshing included
  int particles = 0;     ///< seed this many on surfaces and add none; 0: as the sizing field says
  bool quality = false;  ///< triangulate, and measure the triangles

  bool operator<(const MeshSolve& o) const {
    return std::tie(solver, particles, quality) < std::tie(o.solver, o.particles, o.quality);
  }
};

/// Seconds of the fields' stages.
struct FieldSeconds {
  Int3 dims{};
  int materials = 0;  ///< without the outside
  double distance = 0, sizing = 0, embed = 0;
};

struct MeshRun {
  std::int64_t seeded = 0, final = 0;
  int iterations = 0;
  double seconds = 0;  ///< for seed, relax and population
  double relax = 0;    ///< of these, relax
  double moves = 0;    ///< particles moved, summed over iterations (of the surfaces)
  double extract = 0;  ///< triangulate, and remesh where it was asked for
  double mean_ratio = 0, smallest_ratio = 0;
};

/// Iterations of every solver: the same work for each.
inline constexpr int bench_iterations = 50;

class MeshRuns {
 public:
  explicit MeshRuns(Device& device) : device_(device) {}

  /// Short runs are repeated up to this often, and the fastest counts.
  int repeats = 1;
  /// The user's knobs, over the thesis's constants and Nacre's own; a job or a solve overrides them.
  std::function<void(Settings&)> turn;

  /// Throws Error where the memory does not suffice, and Interrupted. The serial solver runs on the CPU whatever the
  /// device is.
  const FieldSeconds& fields(const MeshJob& job);
  const MeshRun& run(const MeshJob& job, const MeshSolve& solve);
  /// The particles of `run`, which is done again; lengths in voxels.
  MeshParticles particles(const MeshJob& job, const MeshSolve& solve);
  /// Frees the memory of the fields; results stay.
  void release();

 private:
  Device& device_of(const MeshSolve& solve);
  void open(const MeshJob& job, bool own_settings, Device& device);
  MeshParameters parameters(const MeshJob& job, bool own_settings) const;
  void place_particles(const MeshSolve& solve);
  MeshRun run_once(const MeshSolve& solve);

  Device& device_;
  std::unique_ptr<Device> cpu_;  // where `device_` is none
  MeshJob job_;
  Device* opened_on_ = nullptr;
  bool own_settings_ = false;
  std::unique_ptr<MeshVolume> volume_;
  std::unique_ptr<MeshPipeline> pipeline_;
  std::map<MeshJob, FieldSeconds> fields_;
  std::map<std::pair<MeshJob, MeshSolve>, MeshRun> runs_;
};

}  // namespace nacre
