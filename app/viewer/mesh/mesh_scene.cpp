// Nacre: a mesh in the making as the viewer shows it: what comes from the worker, and what it is asked for.
#include "app/viewer/mesh/mesh_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/viewer/scene/text.hpp"
#include "compute/device/error.hpp"
#include "engine/io/mesh_writer.hpp"
#include "engine/picture/colormap.hpp"

namespace nacre {
namespace {

Placement placement_of(const VoxelFrame& frame) {
  const auto column = [](const Vec3d& v, double w) { return glm::dvec4(v.x, v.y, v.z, w); };
  return Placement(column(frame.axes[0], 0), column(frame.axes[1], 0), column(frame.axes[2], 0),
                   column(frame.origin, 1));
}

/// The 12 edges of the box around all voxels, from the first one's centre in steps of a voxel.
std::vector<LineSegment> box_edges(const Int3& dims) {
  std::vector<LineSegment> edges;
  const auto corner = [&](int k) {
    return Vec3f(Vec3d((k & 1 ? dims.x : 0) - 0.5, (k & 2 ? dims.y : 0) - 0.5, (k & 4 ? dims.z : 0) - 0.5));
  };
  for (int k = 0; k < 8; ++k)
    for (const int bit : {1, 2, 4})
      if (!(k & bit)) edges.push_back({corner(k), corner(k | bit)});
  return edges;
}

}  // namespace

MeshScene::MeshScene(const Session& session, const SceneOptions& options)
    : worker_(session, options.open_device(), options.lockstep || !session.settings.view.play, options.low_priority,
              !options.lockstep),
      lockstep_(options.lockstep),
      stop_(options.stop),
      settings_(session.settings) {
  particle_pass_.set_map(colormap(settings_.colormap).table);
}

MeshScene::~MeshScene() {
  worker_.finish();  // nobody writes to the memory any more
  drop_memory();
}

void MeshScene::set_settings(const Settings& settings, const ChangedKnobs& changed) {
  ++version_;
  settings_ = settings;
  worker_.set_settings(settings);
  if (changed.has("play")) worker_.set_lockstep(lockstep_ || paused());
  if (changed.has("colormap")) particle_pass_.set_map(colormap(settings_.colormap).table);
  if (changed.has_any({"hidden", "ghosts", "opacity", "material_colors"})) update_material_styles();
  if (changed.has("worst")) update_worst();
  const bool moved = settings_.view.slice == PlaneAxis::plane && changed.has("clip_planes");
  if (moved ||
      changed.has_any({"slice", "slice_at", "slice_field", "slice_range", "layout", "colormap", "material_colors"}))
    update_slice();
}

bool MeshScene::settle_knobs(Session& session) {
  const std::string proposal = std::exchange(proposal_, {});
  if (!proposal.empty()) session.settings.materials.isovalue = proposal;
  return !proposal.empty();
}

void MeshScene::resume() {
  failure_.clear();
  worker_.resume();
}

void MeshScene::advance(double) {
  while (std::optional<MeshEvent> event = worker_.poll()) take(*event);
  if (lockstep_) worker_.grant_turn();
  worker_.run_to(settings_.view.iteration);
  lend(false);
}

void MeshScene::set_lockstep(bool lockstep) {
  lockstep_ = lockstep;
  worker_.set_lockstep(lockstep_ || paused());
}

bool MeshScene::advance_and_wait(const std::atomic<bool>& stop, double patience) {
  const int before = steps_;
  bool shown = false;
  worker_.grant_turn();
  while (!stop) {
    if (!failure_.empty()) throw Error(failure_);
    lend(true);
    if (shown && !worker_.slice_comes()) return true;
    std::optional<MeshEvent> event = worker_.wait(stop, patience);
    if (!event) return shown || !worker_.busy();
    take(*event);
    shown = shown || steps_ > before || std::holds_alternative<MeshTriangulated>(*event);
  }
  return true;
}

/// Gives the worker the halves of the buffers that no frame reads.
void MeshScene::lend(bool wait) {
  if (lent_ || !particle_positions_) return;
  LentMemory memory;
  memory.lease = lease_;
  memory.particles.capacity = capacity_;
  memory.particles.position = static_cast<Float4*>(particle_positions_->begin_write(wait));
  if (!memory.particles.position) return;
  memory.particles.direction = static_cast<Float4*>(direction_->begin_write(wait));
  if (!memory.particles.direction) return particle_positions_->cancel_write();
  if (settings_.view.boxes) {
    const std::size_t bytes = std::size_t(box_capacity_) * sizeof(ShownBox);
    if (!boxes_) boxes_ = std::make_unique<SharedBuffer>(worker_.device(), bytes, GL_R32F);
    memory.boxes = static_cast<ShownBox*>(boxes_->begin_write(wait));
    memory.box_capacity = box_capacity_;
    boxes_lent_ = memory.boxes != nullptr;
  }
  lent_ = true;
  worker_.lend(memory);
}

void MeshScene::drop_memory() {
  for (std::unique_ptr<SharedBuffer>* buffer : {&particle_positions_, &direction_, &boxes_}) {
    if (*buffer) copied_ += (*buffer)->copied_bytes();
    buffer->reset();
  }
  counts_ = {};
  box_count_ = 0;
}

std::uint64_t MeshScene::copied_bytes() const {
  std::uint64_t bytes = copied_;
  for (const auto* buffer : {&particle_positions_, &direction_, &boxes_})
    if (*buffer) bytes += (*buffer)->copied_bytes();
  return bytes;
}

void MeshScene::take(MeshEvent& event) {
  ++version_;
  std::visit([this](auto& told) { take(told); }, event);
}

void MeshScene::take(VolumeRead& told) {
  failure_.clear();
  results_ = {};
  results_.volume = told.volume;
  rays_ = {};
  drawing_ = {};
  surface_ = {};
  preview_surface_ = {};
  counts_ = {};
  corners_ = std::move(told.corners);
  box_ = told.volume->box();
  ++volumes_;
  voxels_ = placement_of(told.frame);
  const MeshInput& input = told.volume->input;
  for (const std::string& warning : input.warnings) warn_once(warning);
  VoxelFrame frame{input.origin, input.axes};
  for (int a = 0; a < 3; ++a) frame.axes[std::size_t(a)] *= input.spacing[a];
  outline_place_ = placement_of(frame);
  outline_ = Buffer::of<LineSegment>(box_edges(input.dims));
  update_material_styles();
  update_slice();
}

void MeshScene::take(PreviewMade& told) {
  preview_surface_ = SurfaceBuffers(told.preview.geometry);
  preview_pass_.set_materials(told.preview.materials);
}

void MeshScene::take(RelaxBegun& told) {
  failure_.clear();
  results_.info = told.info;
  results_.energy.clear();
  results_.particles.clear();
  lease_ = told.lease;
  farthest_ = 0;
  iterations_ = 0;
  kept_.clear();
  for (const auto* buffer : {&particle_positions_, &direction_, &boxes_})
    if (*buffer) (*buffer)->cancel_write();
  lent_ = boxes_lent_ = false;
  if (particle_positions_ && capacity_ >= told.capacity && capacity_ <= 2 * told.capacity) return;
  drop_memory();
  capacity_ = told.capacity;
  box_capacity_ = told.box_capacity;
  const std::size_t bytes = std::size_t(capacity_) * sizeof(Float4);
  auto position = std::make_unique<SharedBuffer>(worker_.device(), bytes, GL_RGBA32F);
  direction_ = std::make_unique<SharedBuffer>(worker_.device(), bytes, GL_RGBA32F);
  particle_positions_ = std::move(position);  // with it the memory counts as there
}

void MeshScene::take(MeshIterated& told) {
  if (told.shown) {
    particle_positions_->end_write();
    direction_->end_write();
    counts_ = results_.counts = *told.shown;
    if (boxes_lent_) {
      boxes_->end_write();
      box_count_ = told.boxes;
    }
    lent_ = boxes_lent_ = false;
  }
  if (!told.step) return;
  ++steps_;
  ++iterations_;
  if (told.shown) {
    kept_.keep(iterations_, particle_positions_->shown(), direction_->shown(), counts_);
    particle_positions_->drawn();
    direction_->drawn();
  }
  stale_ = true;
  if (told.progress.stage != "relax") return;
  if (told.progress.iteration == 1) results_.energy.clear(), results_.particles.clear();
  results_.energy.push_back(float(told.progress.energy));
  results_.particles.push_back(float(told.progress.particles));
}

void MeshScene::take(MeshTriangulated& told) {
  failure_.clear();
  results_.mesh = std::move(told.mesh);
  results_.measures.reset();
  results_.info = std::move(told.info);
  drawing_ = std::move(told.drawing);
  surface_ = SurfaceBuffers(drawing_.geometry);
  preview_surface_ = {};
  if (told.brought_back) {  // its particles are gone
    counts_ = results_.counts = {};
    iterations_ = 0;
    kept_.clear();
    results_.energy.clear();
    results_.particles.clear();
  }
  material_pass_.set_materials(drawing_.materials);
  rays_ = std::move(told.rays);
  stale_ = false;
  update_edges();
  update_worst();
  update_slice();
}

void MeshScene::take(MeshMeasured& told) {
  results_.measures = std::move(told.measures);
  for (const std::string& flaw : mesh_flaws(results_.volume->input.labels, results_.measures->topology))
    warn_once(flaw);
  update_worst();
}

void MeshScene::take(MeshWritten& told) { written_ = std::move(told.failure); }

void MeshScene::take(MeshFailed& told) { failure_ = std::move(told.what); }

void MeshScene::warn_once(const std::string& warning) {
  if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
}

void MeshScene::write_result(const std::filesystem::path& file, const std::string& origin) {
  begin_write(file, origin);
  worker_.grant_turn(true);
  static const std::atomic<bool> never{false};
  const std::atomic<bool>& stop = stop_ ? *stop_ : never;
  while (!written_) {
    lend(true);
    std::optional<MeshEvent> event = worker_.wait(stop);
    if (stop) {
      worker_.cancel();
      throw Interrupted();
    }
    if (event) take(*event);
  }
  if (const std::string why = *take_written(); !why.empty()) throw Error(why);
}

void MeshScene::begin_write(const std::filesystem::path& file, const std::string& origin) {
  written_.reset();
  worker_.write(file, origin);
}

std::optional<std::string> MeshScene::take_written() {
  std::optional<std::string> told = std::exchange(written_, {});
  if (told && !told->empty() && !failure_.empty()) told = failure_;  // which is why there is no mesh
  return told;
}

std::vector<std::string> MeshScene::result_formats() const { return mesh_extensions(); }

std::string MeshScene::title() const { return results_.volume ? results_.volume->input.name : ""; }

std::string MeshScene::state() const {
  const std::string end = worker_.halted() && failure_.empty() ? "   cancelled" : "";
  if (results_.mesh && !stale_)
    return fmt::format("{} triangles of {} particles", grouped((long long)results_.mesh->triangles.size()),
                       grouped(results_.info.final)) +
           end;
  if (results_.energy.empty()) return end;
  // All that are seen: the history is of those that move, which are the few of the curves at first.
  const auto particles = std::max((long long)results_.particles.back(), (long long)counts_.total());
  return fmt::format("{} particles, energy {:.4f}", grouped(particles), results_.energy.back()) + end;
}

const KeptIteration* MeshScene::looked_back_at() const {
  const int wanted = settings_.view.iteration;
  return wanted > 0 && wanted < iterations_ ? kept_.find(wanted) : nullptr;
}

Transport MeshScene::transport() const {
  Transport t;
  if (iterations_ == 0) return t;
  t.kind = Transport::Kind::iterations;
  t.first = 1;
  t.last = iterations_;
  const int wanted = settings_.view.iteration;
  t.shown = wanted > 0 ? std::min(wanted, iterations_) : iterations_;
  for (int k = t.first; k <= t.last; ++k) t.warm.push_back(kept_.has(k) || k == iterations_);
  t.ended = worker_.settled();
  return t;
}

SceneProgress MeshScene::progress() const {
  if (paused() && worker_.waits()) return {};
  const MeshProgress p = worker_.progress();
  if (p.stage.empty()) return {};
  return {p.iteration > 0 ? fmt::format("{} {}", p.stage, p.iteration) : std::string(p.stage), p.fraction};
}

}  // namespace nacre
