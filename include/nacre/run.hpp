// Nacre: where a run computes, and how it talks with its caller.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace nacre {

class Processes;

/// How far a run is.
struct RunProgress {
  std::string stage;           ///< for example "distance", "relax", "triangulate", "step"
  double fraction = 0;         ///< of the whole job, 0..1
  int iteration = 0;           ///< of the particles; 0 elsewhere
  std::int64_t particles = 0;  ///< so far; 0 where there are none
  double energy = 0;           ///< mean of the particles; 0 where there are none
};

/// Where a run computes, and how it talks with its caller. All members may be left as they are. The callbacks are
/// called by the thread that runs the job (`progress`, `warn`), and must not call the run that calls them.
struct RunOptions {
  std::string device = "auto";  ///< "cpu"; "cuda" or "cuda:N"; "auto": a GPU where one can be used
  int threads = 0;              ///< of the CPU; 0: all. Results do not depend on it
  std::function<void(const RunProgress&)> progress;
  std::function<void(const std::string& sentence)> warn;  ///< what was assumed or dropped
  const std::atomic<bool>* stop = nullptr;                ///< once it is true, the run throws Interrupted soon
  /// Those that make one flow run together (processes.hpp); they must outlive it. Null: this process is alone, as it
  /// has to be for a mesh.
  Processes* processes = nullptr;
};

}  // namespace nacre
