// Nacre: the flow pipeline on a thread of its own, beside the frames. No OpenGL here.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/viewer/flow/flow_rerun.hpp"
#include "app/viewer/flow/flow_results.hpp"
#include "app/viewer/scene/worker.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "engine/render/geometry.hpp"
#include "engine/render/sparse_texture.hpp"
#include "engine/scene/session/session.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/flow_motion.hpp"
#include "engine/scene/surface/spread_points.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

// Events of the worker, in this order (FlowOffer and FlowData after SurfaceRead); after a change of knobs again what
// has been done again.

/// The surface is read.
struct SurfaceRead {
  std::string name;
  SurfaceGeometry geometry;
  std::vector<Vec3d> corners;  ///< points that triangles use
  std::shared_ptr<const TriangleTree> tree;
  double area = 0;
};

/// A surface that moves, at the time of a frame.
struct MovedSurface {
  SurfaceGeometry geometry;
  TriangleTree tree;

  std::size_t bytes() const {
    return geometry.vertices.size() * sizeof(SurfaceVertex) + geometry.triangles.size() * 4 * sizeof(Triangle) +
           tree.points().size_bytes() + tree.triangles().size_bytes() * 4;
  }
};

/// Where arrows stand; none: they are off.
struct FlowArrows {
  std::vector<SurfacePoint> places;
  std::vector<Vec3f> normals;
};

/// The embedding is there: these arrays find a surface cell.
struct FlowEmbedded {
  FlowLookup lookup;
  std::vector<std::uint32_t> rimmed;  ///< of a grid: its texels with_rims
  EmbeddingInfo info;
  FlowBoxes boxes;
  int number = 0;  ///< larger than that of all before
};

/// The boxes of that embedding are in the memory that was given for them.
struct FlowBoxed {
  int embedding = 0;
};

/// A flow is about to be started: what can be shown of its first frame before there is a texture.
struct FlowMoment {
  double time = 0;
  std::vector<float> scalar;
  std::shared_ptr<const std::vector<Vec3f>> vectors;
};

/// The first values can be asked for.
struct FlowStarted {
  FlowSpan span;
  int skipped = 0;  ///< steps before its first, as `begin_at` says
};

/// The values are in the memory that `step` was given.
struct FlowStepped {
  double time = 0, seconds = 0;  ///< of the data; that it took
  int number = 0;                ///< steps since the start
  std::vector<float> scalar;
  std::shared_ptr<const std::vector<Vec3f>> vectors;  ///< one per point, at that time
  std::shared_ptr<const MovedSurface> shape;          ///< at that time; null: it does not move
};

/// Shown values at the requested positions.
struct FlowSampled {
  Vec3d place;
  float value = 0;
};

/// What was asked to be written is written; else why not.
struct FlowWritten {
  std::string failure;
};

/// The running work was dropped, because knobs changed or for good: lent memory is no longer written to.
struct FlowInterrupted {};

/// A stage did not work; the worker waits for other knobs, or goes on as before where it can.
struct FlowFailed {
  std::string what;
};

using FlowEvent = std::variant<FlowOffer, SurfaceRead, FlowData, FlowArrows, FlowEmbedded, FlowBoxed, FlowMoment,
                               FlowStarted, FlowStepped, FlowSampled, FlowWritten, FlowInterrupted, FlowFailed>;

/// The lookup of a grid as the renderer takes it.
inline SparseLookup sparse_lookup(const FlowLookup& l) {
  return {l.bricks, l.subcells, l.refine, l.origin, l.cell_size, l.brick_index, l.block, l.texel};
}

/// Reads, embeds and starts by itself; then one step for each call of `step`. All calls come from one other thread, and
/// none waits for compute but `wait` and the destructor.
class FlowWorker : public Worker<FlowEvent> {
 public:
  /// `loop`: after the last time comes the first again, without end (the caller stops there where the knob `loop` says
  /// so); else it stands still there, as headless runs do.
  /// `low_priority`: see SceneOptions.
  FlowWorker(const Session& session, std::unique_ptr<Device> device, bool loop, bool low_priority = false);
  ~FlowWorker();

  Device& device() { return *device_; }
  const Device& device() const { return *device_; }

  /// `poll`, but waits for an event. None where the worker has nothing to do. Gives up when `stop` is set, or after
  /// `patience` seconds.
  std::optional<FlowEvent> wait(const std::atomic<bool>& stop, double patience = endless);

  /// May `step` be called? Not before FlowStarted, not before the last step's event, and not while knobs are taken
  /// over.
  bool ready() const;
  /// Makes the next step and writes what is to be shown to `memory` of the device (null: the pipeline's own).
  void step(float* memory);

  /// Takes other knobs over: at once where a step takes them, else it does again what depends on them, and interrupts
  /// what does. Returns the stages that the change concerns.
  FlowRerun set_settings(const Settings& settings);
  /// Interrupts a stage that goes on, and does nothing more until `resume` or other knobs. A step is finished.
  void cancel();
  void resume();
  bool cancelled() const;
  bool busy() const;  ///< with something, or about to be

  /// Requests the shown value at a position on the surface; FlowSampled answers. Only the last request counts.
  void sample(const Vec3d& place);
  /// Asks for the boxes of an embedding in `memory` of the device; FlowBoxed answers. Memory for one that has been
  /// followed by another is not touched.
  void show_boxes(std::uint64_t* memory, int embedding);
  /// Writes the values as `nacre flow --out` does, after what goes on; ends with FlowWritten.
  void write(const std::filesystem::path& file);

  std::string stage() const;  ///< what it does now, for the panel: "embedding"; empty: nothing

 private:
  // With the mutex held.
  std::optional<FlowStage> next() const;
  bool has_work() const;

  void run();
  void run_errands(std::unique_lock<std::mutex>& lock);
  void perform(FlowStage stage, std::unique_lock<std::mutex>& lock);
  void undo(FlowStage stage, const std::string& failure);
  void drop_step();
  void make(FlowStage stage);
  void read();
  void choose();
  void tell_data(std::string reason, std::vector<std::string> warnings);
  void tell_data(VectorsInTime& vectors, const Range& time, std::string reason, std::vector<std::string> warnings);
  void place_arrows();
  void embed();
  void tell_embedded();
  std::shared_ptr<const MovedSurface> moved_surface(double time);
  FlowParameters parameters() const;
  void start();
  void make_step();
  void answer_sample(const Vec3d& place);
  void write_boxes(std::uint64_t* memory, int embedding);
  void write_values(const std::filesystem::path& file);
  double wrapped(double time) const;
  static std::vector<float> scalar(VectorsInTime& vectors, double time);
  static std::shared_ptr<const std::vector<Vec3f>> vectors_at(VectorsInTime& vectors, double time);

  const SessionInput input_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<FlowPipeline> pipeline_;
  bool loop_, low_priority_;

  // The thread's own.
  Settings settings_;       ///< of what it does
  std::string read_patch_;  ///< of which `vectors_` are
  std::unique_ptr<VectorsInTime> vectors_;
  std::unique_ptr<FlowMotion> motion_;  ///< since the last embedding
  FlowSpan span_;
  int steps_made_ = 0, steps_in_all_ = 0;
  double shown_time_ = 0;
  bool has_values_ = false;
  float* memory_ = nullptr;  ///< of the step that it makes
  int embeddings_ = 0;       ///< begun so far
  int resolution_ = 0;       ///< of the embedding
  std::uint64_t means_ = 0;  ///< where means of blocks begin behind the shown values; 0: there are none

  // Guarded by the mutex.
  FlowRerun due_;
  std::optional<FlowStage> doing_;
  std::optional<float*> step_;  ///< is to be made, into this memory
  std::optional<Vec3d> sample_;
  std::optional<std::pair<std::uint64_t*, int>> boxes_;  ///< where to, and of which embedding
  std::optional<std::filesystem::path> file_;
  bool started_ = false, failed_ = false, cancelled_ = false, working_ = false;
  Settings wanted_;
};

}  // namespace nacre
