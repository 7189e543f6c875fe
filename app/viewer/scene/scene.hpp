// Nacre: what the loop of the viewer shows: a flow or a mesh. It belongs to the thread of the context and never waits
// for compute, which is a worker's on a thread of its own. Panels are elsewhere: a scene knows no Dear ImGui.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/scene/changed_knobs.hpp"
#include "app/viewer/scene/transport.hpp"
#include "compute/device/device.hpp"
#include "compute/device/stage_timers.hpp"
#include "engine/picture/image.hpp"
#include "engine/render/view.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// What is under the cursor: lines of "name: value" for people.
struct ProbeResult {
  Vec3d position;  ///< world
  std::vector<std::string> lines;
};

/// The values at the ends of a colour legend.
struct LegendRange {
  double low = 0, high = 1;
  bool log = false;
};

/// Where the work stands.
struct SceneProgress {
  std::string stage;     ///< "embedding"; empty: nothing long is going on
  double fraction = -1;  ///< 0..1; below 0: not known
};

/// What has been done so far, for panels and reports.
struct SceneTotals {
  int steps = 0;                   ///< of the flow, or iterations, since the start
  std::uint64_t copied_bytes = 0;  ///< of results between compute and render
  StageTimers timers;
  std::size_t peak_bytes = 0;  ///< of the device
};

class SliceViews;

class Scene {
 public:
  virtual ~Scene() = default;

  /// Takes the worker's events, and requests what is due at time `now` (seconds). Never waits.
  virtual void advance(double now) = 0;
  /// The same for replays: waits until there is one more thing to show: a step of the flow, an iteration of the
  /// particles. Returns at once where the work is done and nothing more will come. False where `patience` (seconds) was
  /// over before that: the same frame is still to be made. Throws Error where a stage fails.
  virtual bool advance_and_wait(const std::atomic<bool>& stop, double patience) = 0;
  /// Waits for frames from now on, as SceneOptions::lockstep.
  virtual void set_lockstep(bool) {}
  /// `ahead`: by how many steps a flow is ahead of one that it is compared with. It waits while that is above 0, and
  /// makes steps, also while paused, while it is below. Empty: it is compared with none.
  virtual void keep_together(std::function<int()>) {}

  /// Takes over `settings`, in which these knobs have changed. What they do not concern goes on; what they do begins
  /// again from there.
  virtual void set_settings(const Settings& settings, const ChangedKnobs& changed) = 0;
  /// Ends what goes on; what there is stays. Other knobs, or `resume`, begin again.
  virtual void cancel() = 0;
  virtual void resume() = 0;
  /// It was cancelled, or has failed: nothing goes on until `resume` or other knobs.
  virtual bool halted() const = 0;
  /// Why the device does not compute any more, whatever is asked of it; empty: it does. The scene is of no more use.
  virtual std::string lost_device() const { return {}; }

  virtual void draw(const View& view) = 0;
  /// What lies over the picture and belongs to it: legend and time; transparent elsewhere. Changes with
  /// `overlay_version`.
  virtual Image overlay(int width, int height) = 0;
  virtual std::uint64_t overlay_version() const = 0;
  /// Changes with everything that is drawn or reported, except progress and time.
  virtual std::uint64_t version() const = 0;

  /// Takes over into the session what the data have decided and the user had left open. False: nothing.
  virtual bool settle_knobs(Session&) { return false; }
  /// What a ray meets first; none: nothing. `along` is unit.
  virtual std::optional<ProbeResult> probe(const Vec3d& from, const Vec3d& along) = 0;

  /// Writes the result as the headless command would, in the format of the extension, with its origin. Waits for the
  /// worker. Throws Error.
  virtual void write_result(const std::filesystem::path& file, const std::string& origin) = 0;
  /// The same without waiting. `take_written` then returns the outcome once: an empty line, or the error.
  virtual void begin_write(const std::filesystem::path& file, const std::string& origin) = 0;
  virtual std::optional<std::string> take_written() = 0;
  /// Extensions that `write_result` takes, e.g. ".vtp".
  virtual std::vector<std::string> result_formats() const = 0;

  virtual const std::vector<Vec3d>& corners() const = 0;  ///< of the data, world; empty: nothing read yet
  /// What a camera has to be fitted to: corners of all that is drawn now. Changes with `seen_version`.
  virtual const std::vector<Vec3d>& seen() const { return corners(); }
  virtual std::uint64_t seen_version() const = 0;
  virtual bool has_legend() const = 0;  ///< a colour legend lies over the picture, or soon will
  /// The legend of the colours that the knob `color_range` is for; none: there is no such legend.
  virtual std::optional<LegendRange> legend_range() const { return {}; }
  virtual bool complete() const = 0;  ///< shows what it is for: the texture; particles or triangles
  virtual bool settled() const = 0;   ///< nothing more will come unless something is changed (a mesh that is done)
  /// Slices of its volume, for the layout; null: it has none (yet).
  virtual SliceViews* slices() { return nullptr; }
  virtual bool is_flow() const { return false; }   ///< knobs of what flows mean something
  virtual std::string unit() const { return {}; }  ///< of lengths; empty: the data do not say
  virtual std::string title() const = 0;
  virtual std::string state() const = 0;  ///< a line: "time 0.2, step 12"; "12,345 particles, energy 0.71"
  virtual SceneProgress progress() const = 0;
  /// Its time or iteration, and the range of these that it can show.
  virtual Transport transport() const { return {}; }
  virtual const std::string& failure() const = 0;  ///< what went wrong last; empty: nothing
  virtual const std::vector<std::string>& warnings() const = 0;
  virtual std::string remark() const = 0;  ///< once for the user, such as that memory is copied; empty: none

  virtual SceneTotals totals() const = 0;
  virtual const Device& device() const = 0;
  /// Ends the worker; nothing may be asked for after this but what is const.
  virtual void finish() = 0;
};

/// `loop`: a flow begins again after its last time; else it stands still there, as headless runs do. `lockstep`: a
/// replay's worker shows every iteration and waits for each to be taken, so that frames do not depend on speed.
struct SceneOptions {
  std::function<std::unique_ptr<Device>()> open_device;
  bool loop = true, lockstep = false;
  bool low_priority = false;                ///< compute takes the time that drawing leaves
  const std::atomic<bool>* stop = nullptr;  ///< ends what waits for compute; may be null
};

/// Throws Error where a result of these formats (extensions) cannot be written to a file of that name.
void require_format(const std::vector<std::string>& formats, const std::filesystem::path& file);

/// The formats of an input's result: those of its scene.
std::vector<std::string> result_formats(const SessionInput& input);

/// Is the input a volume, to be meshed? Else it is a surface with a flow.
bool is_mesh_input(const SessionInput& input);

}  // namespace nacre
