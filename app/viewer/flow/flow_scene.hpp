// Nacre: a flow as the viewer shows it: the worker's results, on the graphics device.
#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/flow/flow_lines_pass.hpp"
#include "app/viewer/flow/flow_worker.hpp"
#include "app/viewer/flow/kept_frames.hpp"
#include "app/viewer/scene/scene.hpp"
#include "engine/interop/shared_buffer.hpp"
#include "engine/picture/caption.hpp"
#include "engine/render/arrow_pass.hpp"
#include "engine/render/line_passes.hpp"
#include "engine/render/surface_pass.hpp"

namespace nacre {

class FlowScene : public Scene {
 public:
  FlowScene(const Session& session, std::unique_ptr<Device> device, bool loop, bool low_priority = false);
  ~FlowScene() override;
  FlowScene(const FlowScene&) = delete;
  FlowScene& operator=(const FlowScene&) = delete;

  void advance(double now) override;
  bool advance_and_wait(const std::atomic<bool>& stop, double patience = endless) override;
  void set_settings(const Settings& settings, const ChangedKnobs& changed) override;
  void cancel() override { worker_.cancel(); }
  bool halted() const override { return worker_.cancelled() || !failure_.empty(); }
  std::string lost_device() const override { return worker_.lost_device(); }
  void resume() override { looked_ = false, worker_.resume(); }
  void draw(const View& view) override;
  Image overlay(int width, int height) override;
  std::uint64_t version() const override { return version_; }
  std::uint64_t overlay_version() const override { return overlay_version_ + time_version_; }
  std::optional<ProbeResult> probe(const Vec3d& from, const Vec3d& along) override;
  void write_result(const std::filesystem::path& file, const std::string& origin) override;
  void begin_write(const std::filesystem::path& file, const std::string& origin) override;
  std::optional<std::string> take_written() override { return std::exchange(written_, {}); }
  std::vector<std::string> result_formats() const override { return {".vtp"}; }

  const std::vector<Vec3d>& corners() const override { return results_.corners; }
  std::uint64_t seen_version() const override { return surfaces_; }
  bool has_legend() const override;
  std::optional<LegendRange> legend_range() const override;
  bool is_flow() const override { return true; }
  bool complete() const override { return shown_ != nullptr; }
  bool settled() const override;
  std::string title() const override;
  std::string state() const override;
  SceneProgress progress() const override { return {worker_.stage(), worker_.share()}; }
  Transport transport() const override;
  const std::string& failure() const override { return failure_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  std::string remark() const override { return shown_ ? shown_->values.remark() : std::string(); }
  SceneTotals totals() const override;
  int steps() const { return results_.steps; }
  void set_lockstep(bool on) override { lockstep_ = on; }
  void keep_together(std::function<int()> ahead) override { ahead_ = std::move(ahead); }
  /// Ends the waiting of frames in lockstep; null: nothing does.
  void set_stop(const std::atomic<bool>* stop) { stop_ = stop; }
  bool focused() const;  ///< a close-up is shown with cells as fine as pixels, fully faded in
  /// Parts of the surface that have memory for a texture of their own: what is shown, and what comes and goes.
  std::size_t focuses() const {
    return leaving_focuses_.size() + bool(focus_) + bool(next_focus_) + bool(former_focus_);
  }
  std::uint64_t copied_bytes() const { return copied_ + (shown_ ? shown_->copied_bytes() : 0); }
  const FlowResults& results() const { return results_; }
  const Device& device() const override { return worker_.device(); }
  void finish() override { worker_.finish(); }

 private:
  /// A texture on the surface: how values are found, and the values; and the boxes that it lies in, where they are
  /// shown.
  struct Texture {
    SurfacePass pass;
    EmbeddingInfo info;
    FlowBoxes boxes;
    int number;  ///< of the embedding
    SharedBuffer values;
    std::unique_ptr<SharedBuffer> codes;  ///< of the boxes, once they have been asked for
    bool boxed = false;                   ///< they are there

    Texture(const FlowEmbedded& told, Device& device);
    std::uint64_t copied_bytes() const { return values.copied_bytes() + (codes ? codes->copied_bytes() : 0); }
  };

  /// The part of the surface that a close-up shows, drawn over the whole.
  struct FocusTexture {
    std::shared_ptr<const SurfacePart> part;
    SurfaceBuffers surface;
    SurfaceColours colours;
    SurfacePass pass;
    SharedBuffer values;
    int number;
    double pixel = 0;      ///< edge of the pixels that it was made for, world units
    double shown_at = 0;   ///< since when; it is faded in from there
    bool in_step = false;  ///< it is lent to the worker for a step

    FocusTexture(FlowFocused& told, Device& device);
    double opacity(double now) const;
  };

  /// Frames that were made with other knobs.
  struct KeptFlow {
    Settings settings;
    std::shared_ptr<Texture> texture;  ///< whose look-up they need
    KeptFrames frames;
    int position;  ///< that was seen
  };

  static SurfaceTexture surface_texture(const FlowLookup& lookup, const std::vector<std::uint32_t>& rimmed);
  static TextureLayout texture_layout(const FlowLookup& lookup);

  void take(FlowEvent& event);
  void take(SurfaceRead& told);
  void take(FlowOffer& told) { results_.offer = std::move(told); }
  void take(FlowData& told);
  void take(FlowArrows& told);
  void take(FlowLinesFound& told);
  void take(FlowEmbedded& told);
  void take(FlowBoxed& told);
  void take(FlowMoment& told);
  void take(FlowStarted& told);
  void take(FlowDyed& told);
  void take(FlowProbed& told) { results_.probes = std::move(told.probes); }
  void take(FlowStepped& told);
  void take(FlowFocused& told);
  void take(FlowFocusFilled& told);
  void take(FlowSampled& told) { sampled_ = told; }
  void take(FlowWritten& told) { written_ = std::move(told.failure); }
  void take(FlowInterrupted& told);
  void take(FlowFailed& told) { failure_ = std::move(told.what); }
  bool wants_step() const {
    const int ahead = ahead_ ? ahead_() : 0;
    return stale_ || ahead < 0 || (ahead == 0 && settings_.view.play && !ended());
  }

  // Focus, in flow_scene_focus.cpp.
  void watch_view(double now);
  void await_focus(const View& view);
  bool sees(const View& view);
  double pixel() const;
  bool cells_are_fine() const;
  bool focus_changes() const;
  void ask_focus(double width);
  void drop_focus();
  void release(std::unique_ptr<FocusTexture>& texture);
  void warn_once(const std::string& sentence);
  void fill_focus();
  bool lend_focus(bool wait, float*& memory, int& number);
  void return_focus(bool written);
  void colour_focus();
  void draw_focus(const View& view);

  // Time, in flow_transport.cpp. Positions are those of Transport.
  FlowRerun pass_on(const Settings& settings, bool jumps);
  bool exchange_frames(const Settings& settings, const FlowRerun& rerun);
  void seek(int position);
  void restart_at(int position);
  void show_kept(int position);
  void warm_up_behind();
  bool play_kept();
  void forget_frames();
  int steps_in_all() const { return std::max(1, settings_.flow.steps); }
  int next_position() const;
  int position_after(int steps) const;
  bool ended() const;
  const KeptFrame* looked_back_at() const { return looks_back_ ? kept_.find(position_) : nullptr; }
  bool begin_step(bool wait);
  bool ask_boxes();
  /// That of the newest embedding; null: there is none.
  Texture* written() const { return !no_texture_.empty() ? nullptr : next_ ? next_.get() : shown_.get(); }
  void show_colours(const std::vector<float>& scalar);
  void show_moment(const FlowMoment& moment);
  void show_dyes(std::shared_ptr<const std::vector<DyeMix>> mixes);
  void set_lines(std::shared_ptr<const FlowLines> lines);
  void find_range();
  FlowCaption caption() const;
  void draw_arrows(const View& view);
  void draw_boxes(const View& view) const;
  void move_arrows();
  double arrow_spacing() const;
  std::vector<std::string> describe(const TriangleHit& hit);

  FlowWorker worker_;  // before what it writes to, whose device it owns
  SurfaceBuffers surface_;
  SurfaceColours colours_;
  SurfacePass plain_pass_;  ///< until there is a texture
  EdgePass edge_pass_;
  ArrowPass arrow_pass_;
  FlowLinesPass lines_pass_;
  BoxPass box_pass_;
  std::shared_ptr<Texture> shown_, next_;  ///< what is seen; what will be, after its first step
  std::shared_ptr<Texture> lent_;          ///< to the worker, for a step
  /// Drawn; waits for its first values; drawn below the first until that is faded in; still written to.
  std::unique_ptr<FocusTexture> focus_, next_focus_, former_focus_;
  std::vector<std::unique_ptr<FocusTexture>> leaving_focuses_;
  FlowView seen_{{}, 0, 0};           ///< of the last frame
  double now_ = 0, rests_since_ = 0;  ///< seconds
  bool looked_ = false;               ///< a focus was asked for, for this view
  bool moved_since_ = false;          ///< the camera, since a kept frame has been seen
  bool awaits_focus_ = false;         ///< that is not answered
  bool begun_looking_ = false;        ///< a frame was made in lockstep
  bool lockstep_ = false;             ///< frames wait for their focus
  std::function<int()> ahead_;        ///< of the flow that it is compared with; empty: there is none
  const std::atomic<bool>* stop_ = nullptr;
  int focus_request_ = 0;       ///< the newest
  std::array<Vec3d, 2> box_{};  ///< around the surface: lower and upper corner
  FlowResults results_;
  std::uint64_t version_ = 1;
  std::uint64_t surfaces_ = 0;  ///< read so far
  FlowArrows arrows_;
  std::shared_ptr<const std::vector<Vec3f>> vectors_;  ///< at the time that is shown
  std::vector<float> scalar_;
  std::shared_ptr<const std::vector<DyeMix>> dyes_;  ///< per point; null: there are none
  std::vector<std::string> warnings_;
  std::string name_, failure_;
  std::string no_texture_;              ///< why the newest embedding has none; empty: it has
  std::optional<std::string> written_;  ///< how the writing that was asked for went
  std::optional<FlowSampled> sampled_;
  std::optional<Vec3d> asked_;  ///< of the worker: the texture's value there, after that step
  std::uint64_t asked_step_ = 0;
  Settings settings_;
  View view_;  ///< of the last frame
  double last_step_ = -1e9, area_ = 0;
  bool stale_ = true;  ///< knobs have changed what the next step shows
  KeptFrames kept_{std::size_t(512) << 20};
  Settings frames_of_;               ///< the knobs that those have
  std::deque<KeptFlow> kept_flows_;  ///< the last comes last
  const bool loops_;                 ///< the worker does, on and on
  double begun_at_;                  ///< the worker's `begin_at`
  int skipped_ = 0;                  ///< steps before the worker's first
  int position_ = -1;                ///< that is seen; -1: none yet
  int newest_ = -1;                  ///< of the worker's last step; -1: none since it started
  bool looks_back_ = false;          ///< a kept frame is seen, and the worker stands elsewhere
  bool warming_ = false;             ///< a start goes on at another time than the texture's
  std::uint64_t copied_ = 0, taken_ = 0;
  std::uint64_t overlay_version_ = 1, time_version_ = 0, legend_version_ = 0;  ///< of the overlay
  Image legend_;
};

}  // namespace nacre
