// Nacre: a mesh in the making as the viewer shows it: the worker's results, on the graphics device.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/viewer/mesh/kept_particles.hpp"
#include "app/viewer/mesh/mesh_results.hpp"
#include "app/viewer/mesh/mesh_worker.hpp"
#include "app/viewer/mesh/ortho_slices.hpp"
#include "app/viewer/scene/scene.hpp"
#include "engine/interop/shared_buffer.hpp"
#include "engine/render/line_passes.hpp"
#include "engine/render/material_pass.hpp"
#include "engine/render/particle_pass.hpp"
#include "engine/render/segment_pass.hpp"
#include "engine/render/slice_pass.hpp"

namespace nacre {

/// Particles are drawn until there are triangles, which they would pierce; and where triangles are switched off.
class MeshScene : public Scene {
 public:
  MeshScene(const Session& session, const SceneOptions& options);
  ~MeshScene() override;
  MeshScene(const MeshScene&) = delete;
  MeshScene& operator=(const MeshScene&) = delete;

  void advance(double now) override;
  bool advance_and_wait(const std::atomic<bool>& stop, double patience = endless) override;
  void set_lockstep(bool lockstep) override;
  void set_settings(const Settings& settings, const ChangedKnobs& changed) override;
  void cancel() override { worker_.cancel(); }
  bool halted() const override { return worker_.halted(); }
  std::string lost_device() const override { return worker_.lost_device(); }
  void resume() override;
  void draw(const View& view) override;
  Image overlay(int width, int height) override;
  std::uint64_t version() const override { return version_; }
  std::uint64_t overlay_version() const override;
  bool settle_knobs(Session& session) override;
  std::optional<ProbeResult> probe(const Vec3d& from, const Vec3d& along) override;
  void write_result(const std::filesystem::path& file, const std::string& origin) override;
  void begin_write(const std::filesystem::path& file, const std::string& origin) override;
  std::optional<std::string> take_written() override;
  std::vector<std::string> result_formats() const override;

  const std::vector<Vec3d>& corners() const override { return corners_; }
  const std::vector<Vec3d>& seen() const override { return shows_planes() ? box_ : corners_; }
  std::uint64_t seen_version() const override { return 2 * volumes_ + (shows_planes() ? 1 : 0); }
  SliceViews* slices() override;
  bool has_legend() const override { return settings_.legend && (particles_drawn() || slice_has_legend()); }
  bool complete() const override { return results_.mesh || counts_.total() > 0; }
  bool settled() const override { return worker_.settled() || (paused() && worker_.waits()); }
  std::string unit() const override { return results_.volume ? results_.volume->input.unit : ""; }
  std::string title() const override;
  std::string state() const override;
  SceneProgress progress() const override;
  Transport transport() const override;
  const std::string& failure() const override { return failure_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  std::string remark() const override { return particle_positions_ ? particle_positions_->remark() : std::string(); }
  SceneTotals totals() const override { return {steps_, copied_bytes(), worker_.timers(), worker_.peak_bytes()}; }
  int steps() const { return steps_; }
  std::uint64_t copied_bytes() const;
  bool previews() const { return preview_drawn(); }  ///< shows a quick surface
  const MeshResults& results() const { return results_; }
  const Device& device() const override { return worker_.device(); }
  void finish() override { worker_.finish(); }

 private:
  void take(MeshEvent& event);
  void take(IsovalueProposed& told) { proposal_ = std::move(told.isovalue); }
  void take(VolumeRead& told);
  void take(PreviewMade& told);
  void take(RelaxBegun& told);
  void take(MeshIterated& told);
  void take(MeshTriangulated& told);
  void take(MeshMeasured& told);
  void take(SliceFilled& told);
  void take(MeshWritten& told);
  void take(MeshFailed& told);
  void lend(bool wait);
  void drop_memory();
  void warn_once(const std::string& warning);
  void update_material_styles();
  void update_edges();
  void update_worst();
  void update_slice();
  std::optional<SlicePlane> shown_plane() const;
  bool three_slices() const { return settings_.view.layout == ViewLayout::slices && results_.volume; }
  bool shows_planes() const { return three_slices() || shown_plane(); }
  void show_volume_slice(const SlicePlane& plane);
  std::array<double, 2> volume_range();
  const Colormap& slice_map() const;
  std::array<double, 2> slice_range(const std::vector<float>& values, MeshField field);
  void draw_particles(const View& view) const;
  void draw_triangles(const View& view) const;
  bool particles_drawn() const;
  /// Until particles lie on the surfaces, or triangles do.
  bool preview_drawn() const {
    return settings_.view.preview && preview_surface_ && counts_.surfaces == 0 && !triangles_drawn();
  }
  bool slice_has_legend() const {
    return slice_values_ && results_.volume && wanted_slice(*results_.volume, settings_.view);
  }
  bool triangles_drawn() const { return results_.mesh && !stale_ && settings_.view.triangles && !looked_back_at(); }
  /// Between two iterations, for the user; a replay does not wait.
  bool paused() const { return !settings_.view.play && !lockstep_; }
  const KeptIteration* looked_back_at() const;
  std::array<double, 2> size_range() const;
  std::optional<TriangleHit> first_seen(const Vec3d& from, const Vec3d& along) const;
  void describe_hit(ProbeResult& probed, const TriangleHit& hit) const;

  MeshWorker worker_;  // before what it writes to, whose device it owns
  bool lockstep_;
  const std::atomic<bool>* stop_;
  Settings settings_;
  MeshResults results_;
  TriangleTree rays_;
  std::vector<Vec3d> corners_, box_;  ///< of what is not outside; of all voxels
  std::uint64_t version_ = 1;
  std::uint64_t volumes_ = 0;  ///< taken so far
  std::vector<std::string> warnings_;
  std::string failure_;
  std::string proposal_;                ///< an iso-value that the session shall take over
  std::optional<std::string> written_;  ///< how the writing that was asked for went

  // Particles and boxes, which the worker writes.
  std::unique_ptr<SharedBuffer> particle_positions_, direction_, boxes_;
  std::int64_t capacity_ = 0;
  ShownCounts counts_;
  std::int64_t box_count_ = 0, box_capacity_ = 0;
  int lease_ = 0, steps_ = 0;
  int iterations_ = 0;  ///< since the particles were seeded
  KeptParticles kept_{std::size_t(512) << 20};
  bool lent_ = false, boxes_lent_ = false;
  std::uint64_t copied_ = 0;
  ParticlePass particle_pass_;
  BoxPass box_pass_;
  Placement voxels_{1.0};

  // Triangles; `stale_`: the particles have moved on since.
  MeshDrawing drawing_;
  SurfaceBuffers surface_;
  bool stale_ = false;
  std::vector<Color> palette_;  ///< per material
  std::vector<MaterialStyle> material_styles_;
  MaterialPass material_pass_, preview_pass_;
  SurfaceBuffers preview_surface_;
  EdgePass edge_pass_;
  SegmentPass segment_pass_;
  Buffer curves_, worst_, outline_;
  Placement outline_place_{1.0};

  // The slice, and what it was asked for.
  SlicePass slice_pass_;
  SliceRequest request_;
  bool slice_of_field_ = false, slice_values_ = false;
  std::array<double, 2> slice_range_{0, 1};
  double farthest_ = 0;                 ///< distance seen in slices so far
  std::unique_ptr<OrthoSlices> ortho_;  ///< of the layout, once it is wanted
};

}  // namespace nacre
