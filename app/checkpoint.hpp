// Nacre: `nacre flow --checkpoint`: a run that was stopped goes on where it was.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/flow_results.hpp"
#include "compute/device/ranks.hpp"
#include "engine/picture/video.hpp"
#include "engine/scene/surface/flow_motion.hpp"
#include "engine/system/checkpoint_file.hpp"

namespace nacre {

/// The checkpoint of a run: the file that it finds, and those that it writes. On several processes all make the same
/// calls, and the first one has the file. Without --checkpoint it does nothing.
class Checkpoint {
 public:
  /// Looks for the file. Throws Error where there is one that cannot be used.
  Checkpoint(const FlowOptions& options, Ranks* ranks);

  bool continues() const { return continues_; }
  /// Which of the run's steps have to be made still.
  FrameRange steps_left(const FrameRange& steps) const;

  /// Throws Error that says in what the run of the file differs from that of `origin`.
  void require_same(const Origin& origin);
  /// The memory that decides on resolution and close-up: what was free when the run began.
  std::size_t available(std::size_t now);

  /// Starts the flow, or goes on with it. From here to `end_steps`, Ctrl-C is heeded after each step only.
  void start(FlowPipeline& pipeline, FlowMotion& motion, const FlowVectors& vectors);
  /// After each step: writes the state if that is due. If the user has asked to stop, writes it and throws Interrupted.
  void after_step();
  void end_steps() { held_.reset(); }
  /// The run is complete: removes the file.
  void remove();
  nlohmann::json report() const;

 private:
  bool wanted() const { return !options_.checkpoint.empty(); }
  void write();

  const FlowOptions& options_;
  Ranks* ranks_;
  bool continues_ = false;
  std::optional<CheckpointReader> file_;  ///< on the first process, until it is read
  nlohmann::json found_, run_;            ///< what the file says; this run's origin
  std::size_t available_ = 0;
  FlowPipeline* pipeline_ = nullptr;
  FlowMotion* motion_ = nullptr;
  std::optional<HeldInterrupts> held_;
  double last_write_ = 0, write_seconds_ = 0;
  int writes_ = 0;
};

}  // namespace nacre
