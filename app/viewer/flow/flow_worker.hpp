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

#include "app/viewer/flow/flow_lines.hpp"
#include "app/viewer/flow/flow_rerun.hpp"
#include "app/viewer/flow/flow_results.hpp"
#include "app/viewer/scene/worker.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "engine/render/geometry.hpp"
#include "engine/render/sparse_texture.hpp"
#include "engine/run/dye_run.hpp"
#include "engine/run/flow_probes.hpp"
#include "engine/run/focus.hpp"
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
  std::vector<SurfacePoint> positions;
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

/// What there is to see at one time of the data, beside the texture. As an event: a flow is about to be started, and
/// this is of its first frame.
struct FlowMoment {
  double time = 0;
  std::vector<float> scalar;                          ///< one per point; empty: not coloured
  std::shared_ptr<const std::vector<Vec3f>> vectors;  ///< one per point
  std::shared_ptr<const MovedSurface> shape;          ///< null: it does not move
  std::shared_ptr<const FlowLines> lines;             ///< null: none are wanted
  std::shared_ptr<const std::vector<DyeMix>> dyes;    ///< one per point; null: there are none

  std::size_t bytes() const {
    return (dyes ? dyes->size() * sizeof(DyeMix) : 0) + scalar.size() * sizeof(float) +
           (vectors ? vectors->size() * sizeof(Vec3f) : 0) + (shape ? shape->bytes() : 0) +
           (lines ? lines->bytes() : 0);
  }
};

/// Lines and marks of the time that is shown; null: they are off.
struct FlowLinesFound {
  std::shared_ptr<const FlowLines> lines;
};

/// Dyes at the newest step; null: there are none any more.
struct FlowDyed {
  std::shared_ptr<const std::vector<DyeMix>> mixes;
};

/// What is at the points of the knob `probe` through the times of the data.
struct FlowProbed {
  std::vector<FlowProbe> probes;
};

/// The first values can be asked for.
struct FlowStarted {
  FlowSpan span;
  int skipped = 0;  ///< steps before its first, as `begin_at` says
};

/// The values are in the memory that `step` was given.
struct FlowStepped {
  FlowMoment moment;
  double seconds = 0;  ///< that it took
  int number = 0;      ///< steps since the start
  bool focus = false;  ///< the focus is at that step, too, in the memory given for it
};

/// A request for a focus is answered. With a part: it is embedded, warmed up, and one step behind the texture of the
/// whole. Without one there is none for that view, or it was interrupted.
struct FlowFocused {
  int request = 0;
  int number = 0;  ///< larger than that of all before
  std::shared_ptr<const SurfacePart> part;
  SurfaceGeometry geometry;
  FlowLookup lookup;
  std::vector<std::uint32_t> rimmed;  ///< of a grid: its texels with_rims
  bool ends_former = false;           ///< the focus before it, if there was one, takes no steps any more
  std::string remark;                 ///< for the user; empty: none
};

/// The values of that focus at the newest step are in the memory that was given for them; or, if not `written`, will
/// never be.
struct FlowFocusFilled {
  int number = 0;
  bool written = false;
};

/// Shown values at the requested positions.
struct FlowSampled {
  Vec3d position;
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

using FlowEvent = std::variant<FlowOffer, SurfaceRead, FlowData, FlowArrows, FlowLinesFound, FlowEmbedded, FlowBoxed,
                               FlowMoment, FlowStarted, FlowDyed, FlowProbed, FlowStepped, FlowFocused, FlowFocusFilled,
                               FlowSampled, FlowWritten, FlowInterrupted, FlowFailed>;

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
  /// Makes the next step and writes what is to be shown to `memory` of the device (null: the pipeline's own). The same
  /// for the focus of number `focus` and its memory.
  void step(float* memory, float* focus_memory = nullptr, int focus = 0);

  /// Takes other knobs over: at once where a step takes them, else it does again what depends on them, and interrupts
  /// what does. Returns the stages that the change concerns.
  FlowRerun set_settings(const Settings& settings);
  /// Interrupts a stage that goes on, and does nothing more until `resume` or other knobs. A step is finished.
  void cancel();
  void resume();
  bool cancelled() const;
  bool busy() const;  ///< with something, or about to be

  /// Requests the shown value at a position on the surface; FlowSampled answers. Only the last request counts.
  void sample(const Vec3d& position);
  /// Asks for the boxes of an embedding in `memory` of the device; FlowBoxed answers. Memory for one that has been
  /// followed by another is not touched.
  void show_boxes(std::uint64_t* memory, int embedding);
  /// Asks for a focus that serves this view. Where the one that is there does not, another is made between two steps,
  /// `width` times as wide as the view, with a budget of cells (`focus_on`). Each request has one answer, FlowFocused,
  /// also where another request or one of the next two calls puts an end to it.
  void focus(const FlowView& view, double budget, double width, int request);
  void stop_focus();  ///< no other focus is wanted
  void drop_focus();  ///< nor the one that there is
  /// Asks for the values of the focus of that number at the newest step, in `memory` of the device; FlowFocusFilled
  /// answers.
  void fill_focus(float* memory, int number);
  /// Writes the values as `nacre flow --out` does, after what goes on; ends with FlowWritten.
  void write(const std::filesystem::path& file, const std::string& origin);

  std::string stage() const;               ///< what it does now, for the panel: "embedding"; empty: nothing
  double share() const { return share_; }  ///< how much of that is done, 0..1; below 0: not known

 private:
  struct FocusRequest {
    FlowView view;
    double budget;
    double width;  ///< how many times as wide as the view a new focus is
    int number;
  };

  /// A focus that takes its steps beside the texture of the whole.
  struct WorkerFocus {
    std::unique_ptr<FlowPipeline> pipeline;
    std::shared_ptr<SurfacePart> part;
    std::vector<HalfSpace> shown;
    double cell_size = 0;
    std::uint64_t values = 0;  ///< where its means begin behind its shown values; 0: there are none
    int number = 0, resolution = 0;
    int steps = 0;         ///< the step of the whole that it is at
    int steps_in_all = 0;  ///< of its own flow
  };

  // With the mutex held.
  std::optional<FlowStage> next() const;
  bool has_work() const;
  bool has_focus_work() const;
  void stop_focusing();

  void run();
  void run_errands(std::unique_lock<std::mutex>& lock);
  void run_focus(std::unique_lock<std::mutex>& lock);
  void perform(FlowStage stage, std::unique_lock<std::mutex>& lock);
  void undo(FlowStage stage, const std::string& failure);
  void drop_step();
  void make(FlowStage stage);
  void read();
  void choose();
  void tell_data(std::string reason, std::vector<std::string> warnings);
  void tell_data(VectorsInTime& vectors, const Range& time, std::string reason, std::vector<std::string> warnings);
  void place_arrows();
  std::shared_ptr<const FlowLines> lines_at(double time);
  void find_lines();
  void find_probes();
  FlowMoment moment_at(double time);
  void embed();
  void tell_embedded();
  std::shared_ptr<const MovedSurface> moved_surface(double time);
  FlowParameters parameters() const;
  void start();
  void change_dyes();
  void carry_dyes();
  std::shared_ptr<const std::vector<DyeMix>> dye_mixes() const;
  void choose_colours();
  void make_step();
  double flow_end() const;
  void make_focus(const FocusRequest& wanted, FlowFocused& answer);
  void note_focus_memory();
  bool step_focus(float* memory, int number);
  void answer_sample(const Vec3d& position);
  void write_boxes(std::uint64_t* memory, int embedding);
  void write_values(const ResultFile& wanted);
  double wrapped(double time) const;
  static std::vector<float> scalar(VectorsInTime& vectors, double time);
  static std::shared_ptr<const std::vector<Vec3f>> vectors_at(VectorsInTime& vectors, double time);

  std::atomic<float> share_{-1};  ///< written by the pipeline
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
  std::shared_ptr<const FlowLines> lines_;    ///< found last; null: they have to be found again
  std::shared_ptr<const FlowTracks> tracks_;  ///< the same of tracks
  std::unique_ptr<DyeRun> dyes_;              ///< null: there are none
  bool has_values_ = false;
  float* memory_ = nullptr;                ///< of the step that it makes
  std::pair<float*, int> focus_memory_{};  ///< the same of the focus, and its number
  std::unique_ptr<WorkerFocus> focus_;     ///< null: there is none
  int focuses_ = 0;                        ///< made so far
  int embeddings_ = 0;                     ///< begun so far
  int resolution_ = 0;                     ///< of the embedding
  std::uint64_t means_ = 0;                ///< where means of blocks begin behind the shown values; 0: there are none

  // Guarded by the mutex.
  FlowRerun due_;
  std::optional<FlowStage> doing_;
  std::optional<float*> step_;           ///< is to be made, into this memory
  std::pair<float*, int> focus_step_{};  ///< with it, the focus of that number
  std::optional<FocusRequest> focus_wanted_;
  std::vector<std::pair<float*, int>> focus_fills_;  ///< focuses to be written, and their numbers
  bool focusing_ = false, drops_focus_ = false;
  std::optional<Vec3d> sample_;
  std::optional<std::pair<std::uint64_t*, int>> boxes_;  ///< where to, and of which embedding
  std::optional<ResultFile> file_;
  bool started_ = false, failed_ = false, cancelled_ = false, working_ = false;
  Settings wanted_;
};

}  // namespace nacre
