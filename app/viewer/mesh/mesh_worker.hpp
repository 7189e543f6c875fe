// Nacre: the mesh pipeline on a thread of its own, beside the frames. No OpenGL here.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/viewer/mesh/kept_meshes.hpp"
#include "app/viewer/mesh/mesh_measures.hpp"
#include "app/viewer/mesh/mesh_preview.hpp"
#include "app/viewer/mesh/viewed_volume.hpp"
#include "app/viewer/scene/worker.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// What the worker does, in this order. A changed knob begins again with the first stage that it concerns.
enum class MeshStage : int { read, materials, fields, relax, triangulate, measure, done };

/// The first stage that has to run again when the settings change like this; done: none.
MeshStage mesh_restart(const Settings& before, const Settings& after);

// Events of the worker, in this order; after a change of knobs again from the first stage concerned.

/// The volume is no label map, and no iso-value was given: this one was chosen.
struct IsovalueProposed {
  std::string isovalue;
};

/// The volume is read, and its materials are known.
struct VolumeRead {
  std::shared_ptr<const ViewedVolume> volume;
  std::vector<Vec3d> corners;  ///< of what is not outside
  VoxelFrame frame;            ///< of particles and boxes
};

/// A quick surface of the materials, where the worker makes one.
struct PreviewMade {
  MeshPreview preview;
};

/// Particles are about to be seeded: so much memory holds them all. Memory lent before is no longer written to.
struct RelaxBegun {
  MeshInfo info;
  std::int64_t capacity = 0, box_capacity = 0;
  int lease = 0;  ///< to be given with the memory
};

/// An iteration was made, or (`step` false) what is there is shown once more.
struct MeshIterated {
  MeshProgress progress;  ///< its `stage` is a literal
  bool step = true;
  std::optional<ShownCounts> shown;  ///< the memory that was lent holds these particles; none: nothing was lent
  std::int64_t boxes = 0;            ///< and so many boxes
};

/// The triangles are there.
struct MeshTriangulated {
  std::shared_ptr<const SurfaceMesh> mesh;
  MeshDrawing drawing;
  TriangleTree rays;
  MeshInfo info;
  bool brought_back = false;  ///< an earlier result, whose particles are gone
};

/// And what they are like.
struct MeshMeasured {
  std::shared_ptr<const MeshMeasures> measures;
};

/// A slice that was asked for: row by row, as SlicePlane::positions; no number beyond the volume.
struct SliceFilled {
  int number = 0;  ///< of the request
  SlicePlane plane;
  MeshField field = MeshField::material;
  int columns = 0, rows = 0;
  std::vector<float> values;
};

/// What was asked to be written is written; else why not.
struct MeshWritten {
  std::string failure;
};

/// A stage failed; the worker waits for other knobs, or for resume().
struct MeshFailed {
  std::string what;
};

using MeshEvent = std::variant<IsovalueProposed, VolumeRead, PreviewMade, RelaxBegun, MeshIterated, MeshTriangulated,
                               MeshMeasured, SliceFilled, MeshWritten, MeshFailed>;

/// Memory of the device that the renderer does not read, to be filled with particles and boxes.
struct LentMemory {
  ShownParticles particles;
  ShownBox* boxes = nullptr;  ///< null: not wanted
  std::int64_t box_capacity = 0;
  int lease = 0;  ///< RelaxBegun's; memory of an older one is not touched
};

struct SliceRequest {
  int number = 0;  ///< larger than all before
  SlicePlane plane;
  MeshField field = MeshField::material;
};

/// Reads, meshes and measures by itself. All calls come from one other thread, and none waits for compute but `wait`
/// and the destructor.
class MeshWorker : public Worker<MeshEvent> {
 public:
  /// `lockstep`: each iteration, and the triangles, wait for a turn and for memory. `live`: what is told may depend on
  /// what went before: there are previews, and knobs that are as they were bring the mesh back that they had made.
  MeshWorker(const Session& session, std::unique_ptr<Device> device, bool lockstep, bool low_priority = false,
             bool live = false);
  ~MeshWorker();

  Device& device() { return *device_; }
  const Device& device() const { return *device_; }

  /// `poll`, but waits for an event. None where the worker has nothing to do. Gives up when `stop` is set, or after
  /// `patience` seconds.
  std::optional<MeshEvent> wait(const std::atomic<bool>& stop, double patience = endless);

  void set_lockstep(bool lockstep);
  /// In lockstep: one more iteration may be reported; `all`: all that follow.
  void grant_turn(bool all = false);
  /// In lockstep: the iterations up to this one, counted from 1 since the particles were seeded, need no turn. Asking
  /// again changes nothing, so no iteration is made too many.
  void run_to(int iteration);
  /// Gives memory for the next iteration that is to be shown. It is filled before the MeshIterated with `shown`, once.
  void lend(const LentMemory& memory);

  /// Takes other knobs over: what they do not concern goes on, else it is interrupted.
  void set_settings(const Settings& settings);
  /// Interrupts what it does; what is done stays. `resume` begins the interrupted stage again.
  void cancel();
  void resume();

  /// Asks for a slice; only the newest request counts. It is filled again after each change of the fields.
  void ask_slice(const SliceRequest& request);
  void drop_slice();
  /// Is the slice that was asked for about to be filled?
  bool slice_comes() const;

  /// Writes the mesh as `nacre mesh --out` does, once it is there; ends with MeshWritten, unless it fails before.
  void write(const std::filesystem::path& file, const std::string& origin);

  bool busy() const;
  bool settled() const;  ///< all is done and reported
  bool halted() const;   ///< cancelled, or failed
  bool waits() const;    ///< in lockstep, for a turn

  MeshProgress progress() const;  ///< stage empty: nothing goes on

 private:
  enum class Task { none, bring_back, slice, write, stage, show };

  void run();
  Task due() const;
  bool find_kept(const Settings& before);
  bool slice_due() const { return slice_ && !slice_filled_ && fields_; }
  bool memory_due() const { return lent_ && lent_->lease == lease_; }
  void perform(Task task);
  void perform_stage();
  void make(MeshStage stage);
  std::optional<std::string> failure_of(const std::function<void()>& work);
  void read();
  void choose_materials();
  void preview();
  MeshVolume materials_of(MaterialSettings materials, MeshInput& input);
  void build_fields();
  void relax();
  void triangulate();
  void measure();
  void bring_back();
  void fill_slice();
  void write_result();
  void note_progress(const MeshProgress& progress);
  void show(const MeshProgress& progress, bool step);
  bool await_turn();

  const SessionInput input_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<MeshPipeline> pipeline_;
  const bool low_priority_, live_;

  // The worker's own.
  std::shared_ptr<const std::vector<Volume>> volumes_;
  std::shared_ptr<const ViewedVolume> viewed_;
  std::shared_ptr<const SurfaceMesh> mesh_;
  KeptMesh made_mesh_;  ///< of the stages done so far

  // Guarded by the mutex.
  Settings wanted_;
  KeptMeshes kept_{std::size_t(512) << 20};
  std::shared_ptr<const KeptMesh> back_;  ///< to be brought back
  /// What the pipeline has computed, where an earlier result is shown instead: with these knobs, and before this stage.
  struct Computed {
    Settings settings;
    MeshStage next;
  };
  std::optional<Computed> computed_;
  MeshStage next_ = MeshStage::read;     ///< all before it are done
  MeshStage restart_ = MeshStage::done;  ///< where to begin when the running work has been interrupted
  MeshStage doing_ = MeshStage::done;
  bool at_work_ = false, cancelled_ = false, failed_ = false;
  bool fields_ = false;   ///< can be asked
  bool unshown_ = false;  ///< the particles have changed since they were shown
  bool lockstep_;
  int turns_ = 0;
  int made_ = 0, run_to_ = 0;  ///< iterations since the particles were seeded
  bool waiting_ = false;
  bool all_turns_ = false;
  int lease_ = 0;
  std::optional<LentMemory> lent_;
  std::optional<SliceRequest> slice_;
  bool slice_filled_ = false;
  std::optional<ResultFile> file_;
  bool writing_ = false;
  MeshProgress progress_;
};

}  // namespace nacre
