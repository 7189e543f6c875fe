// Nacre: flow by the closest point method on a sparse octree (ch. 6): values and vectors extended into a narrow band,
// particles advected there in plain 3-D.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "compute/embedding/tree_boxes.hpp"
#include "compute/flow/band_advect.hpp"
#include "compute/flow/band_filter.hpp"
#include "compute/flow/band_velocity.hpp"
#include "compute/flow/thesis_advect.hpp"
#include "compute/pipeline/flow_method.hpp"
#include "compute/pipeline/octree_bands.hpp"
#include "compute/pipeline/octree_share.hpp"
#include "compute/pipeline/streak_drawing.hpp"
#include "compute/raycast/octree_cast.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

template <class Backend, class Band>
class OctreeFlow final : public FlowMethodOn<Backend> {
 public:
  using FlowMethodOn<Backend>::FlowMethodOn;
  using View = decltype(std::declval<typename Band::Octree>().view());

  void embed(const FlowMesh& mesh) override {
    levels_ = make_octree_domain(mesh, parameters_, domain_, mesh.shared ? ranks_ : nullptr);
    const FlowMesh embedded = this->separate(mesh, domain_.cell_size, domain_.radius);
    if (this->sheets_) levels_ = make_octree_domain(embedded, parameters_, domain_);
    if (!ranks_) require_octree_memory(embedded, parameters_, exec_.arena());
    if (ranks_ && mesh.moves) throw Error("several processes cannot share a surface that moves", "", "use one process");
    auto stage = exec_.stage("embed");
    if (ranks_) {
      const std::vector<std::uint64_t> begin = cut_octree(*ranks_, embedded, domain_, levels_);
      const HaloDepths depths = HaloDepths::of(domain_.radius, parameters_.step_cells, parameters_.streaks);
      share_.emplace(exec_, *ranks_, begin, depths);
      if (mesh.shared) this->gathered_.emplace(*ranks_, mesh, domain_, levels_, begin, depths.whole);
    }
    const std::optional<MeshOfBricks>& near = this->gathered_;
    this->begin_embedding(near ? near->mesh() : embedded, near ? near->mesh() : mesh);
    const OctreePart part = share_ ? share_->part() : OctreePart{};
    octree_ = Band::build(exec_, mesh_, triangles_, levels_, domain_, parameters_, share_ ? &part : nullptr);
    if constexpr (!Band::as_thesis)
      if (share_) share_->take(octree_);
    describe();
    this->build_boxes(mean_list_, longest_lists, Vec3d(domain_.cells));
    this->end_embedding();
  }

  double resume(const FlowVectors& vectors, const FlowMethod& before, FlowCarry how) override {
    const auto& old = dynamic_cast<const OctreeFlow&>(before);
    make_arrays(vectors);
    this->go_on_from(old);
    const View view = octree_.view();
    const std::size_t n = view.surface_cells;
    Arena::Scope scope(exec_.arena());
    CellIndex* source = exec_.arena().template temporary<CellIndex>(n).data();
    const typename Band::Surface on{view}, on_old{old.octree_.view()};
    const double found = this->find_sources(on, std::int64_t(n), 1.0, old, on_old, 1.0, how, source);
    if constexpr (Band::as_thesis) {  // deposits for all the steps to come
      for (int j = 0; j < std::min(ttl_, old.ttl_); ++j)
        this->take(source, old.sums_[(old.step_ + j - old.first_) % old.ttl_], sums_[j]);
    } else {
      this->take(source, old.sums_[1 + (launched_ & 1)], sums_[1 + (launched_ & 1)]);
    }
    for_each_surface_cell(exec_, view, FillBandNoise<View>{view, seed_, value_.data(), shown_.data()});
    this->take(source, old.value_, value_);
    this->take(source, old.carried_, carried_);
    this->take(source, old.shown_, shown_);
    frame_ = value_.data();
    this->warm_up();
    return found;
  }

  std::vector<float> shown() const override {
    this->require_started();
    return this->download_frame(shown_.data(), octree_.view().surface_cells);
  }
  void show_into(float* memory, float* means) override { output_ = memory, this->output_means_ = means; }
  FlowValues values() const override;
  std::vector<std::uint8_t> render(const RenderOptions& options) override;
  std::vector<float> sample_shown(std::span<const Vec3d> points) override;
  FlowLookup lookup() const override;
  FlowBoxes boxes() const override {
    return {domain_.origin, Band::smallest_box * domain_.cell_size, box_levels(octree_)};
  }
  void show_boxes(std::uint64_t* memory) override { write_boxes(exec_, octree_, memory); }

 private:
  using Base = FlowMethodOn<Backend>;
  using Base::domain_, Base::exec_, Base::first_, Base::info_, Base::mesh_, Base::parameters_, Base::started_;
  using Base::known_around_, Base::launched_, Base::output_, Base::ranks_, Base::seed_, Base::steady_, Base::step_,
      Base::triangles_, Base::ttl_;

  /// What kernels run on that make values of cells: all, or those that are this process's own.
  View own() const {
    if constexpr (!Band::as_thesis)
      if (share_) return share_->own(octree_.view());
    return octree_.view();
  }

  /// What `start` and `resume` need; noise in it.
  void make_arrays(const FlowVectors& vectors) override {
    this->begin_flow(vectors, 1.0, Band::as_thesis ? 0 : 1);
    Arena& arena = exec_.arena();
    const std::size_t mark = arena.mark();
    const View view = octree_.view();
    const std::size_t n = view.surface_cells;
    for (int j = 0; j < this->slots(); ++j) slots_[j] = arena.permanent<std::uint32_t>(view.cells);
    for (int j = 0; j < (Band::as_thesis ? ttl_ : 3); ++j) {
      sums_[j] = arena.permanent<std::uint64_t>(n);
      sums_[j].fill_bytes(0);
    }
    value_ = arena.permanent<float>(n);
    carried_ = arena.permanent<float>(n);
    shown_ = arena.permanent<float>(n);
    if constexpr (Band::as_thesis) {
      ahead_ = arena.permanent<float>(n);
      ahead_.fill_bytes(0);
    } else {
      moments_ = arena.permanent<Float4>(view.items());
      streaks_ = arena.permanent<float>(n);
      drawing_.make(BrickSurface{view}, n, this->mesh_, 1.0);
    }
    info_.flow_bytes = arena.mark() - mark;
    for_each_surface_cell(exec_, view, FillBandNoise<View>{view, seed_, value_.data(), carried_.data()});
  }

  /// Of the own cells, which follow each other; deposits in the halo are with their owners.
  std::vector<KeptArray> kept_arrays() const override {
    const std::size_t first = share_ ? share_->surface_first() : 0;
    const std::size_t n = share_ ? share_->surface_count() : octree_.view().surface_cells;
    std::vector<KeptArray> arrays{kept(value_, first, n)};
    if constexpr (Band::as_thesis) {
      arrays.push_back(kept(ahead_, first, n));
      for (int j = 0; j + 1 < ttl_; ++j) arrays.push_back(kept(sums_[(step_ + j - first_) % ttl_], first, n));
    } else {
      arrays.push_back(kept(sums_[1 + (launched_ & 1)], first, n));
    }
    return arrays;
  }

  static constexpr double longest_lists = 48;  ///< triangles in a brick, above which a tree of them is faster

  void describe() {
    const View view = octree_.view();
    const int n = domain_.cells.x;
    info_ = {};
    info_.kind = Band::name;
    info_.dimensions = info_.closest_point_dimensions = Int3(n);
    info_.cells = info_.closest_point_cells = view.cells;
    info_.surface_cells = Band::touched(octree_);
    info_.bytes = octree_.bytes();
    mean_list_ = Band::mean_list(octree_);
    if constexpr (!Band::as_thesis)
      if (share_) describe_share();
    info_.dense_bytes =
        std::uint64_t(double(n) * n * n * double(octree_.bytes()) / std::max<double>(1, double(view.cells)));
    info_.cell_size = domain_.cell_size;
  }

  /// The numbers of all processes, and those of this one.
  void describe_share() {
    info_.own_bricks = share_->own_bricks();
    info_.own_surface_cells = share_->surface_count();
    info_.halo_bricks = share_->halo_bricks();
    info_.mesh_triangles = triangles_;
    if (this->gathered_) info_.mesh_bytes = this->gathered_->bytes();
    std::uint64_t all[] = {share_->own_cells(), share_->surface_count(), info_.bytes, share_->own_bricks(),
                           share_->own_lists(octree_)};
    ranks_->sum(all);
    if (all[0] == 0) throw Error("no cell lies near the surface", "", "give a surface");
    info_.cells = info_.closest_point_cells = all[0];
    info_.surface_cells = all[1];
    info_.bytes = all[2];
    known_around_ = share_->known_around();
    mean_list_ = double(all[4]) / double(std::max<std::uint64_t>(1, all[3]));
  }

  void fill_slot(const Array<Vec3f>& vectors, const SpeedScale& scale, int slot) override {
    const View view = octree_.view();
    for_each_cell(exec_, view, ExtendVelocity<View>{view, mesh_, vectors.data(), scale, slots_[slot].data()});
  }

  void advance(int k) override {
    this->look_ahead(k);
    if (share_)
      launch(k);  // it waits for other processes
    else
      exec_.repeat(this->shows_ ? steps_ : unseen_steps_, [&] { launch(k); });
    ++launched_;  // not inside: a graph that cannot be made is launched again, one by one
  }

  /// What follows the look ahead; nothing in it waits for the device.
  void launch(int k) {
    const View view = octree_.view();
    if constexpr (Band::as_thesis) {
      release(k, view);
    } else {
      move_particles(k, view);
    }
    show();
  }

  /// Advection as on the grid.
  void move_particles(int k, const View& view) {
    Array<std::uint64_t>&crossed = sums_[0], &arrived = sums_[1 + (launched_ & 1)], &ended = sums_[2 - (launched_ & 1)];
    MoveBrickParticles particles;
    particles.path.field = field(k, view);
    particles.carried = carried_.data();
    particles.arrived = arrived.data();
    particles.crossed = crossed.data();
    particles.ended = ended.data();
    particles.ttl = ttl_;
    particles.rounding = this->rounding_of(launched_);
    const auto move = [&](const View& on) {
      auto stage = exec_.stage("advect");  // with the deposits: a particle draws while it moves
      for_each_surface_cell(exec_, on, particles);
    };
    const auto normalise = [&](const View& on) {
      auto stage = exec_.stage("extend");
      const BrickSurface surface{on};
      for_each_surface_cell_of(
          exec_, surface, std::int64_t(view.surface_cells),
          Normalise<BrickSurface>{surface, ended.data(), crossed.data(), carried_.data(), value_.data()});
    };
    if (share_) {
      share_->collect(crossed, ended, view, move);
      share_->refresh_beside_for(crossed, view, normalise);
    } else {
      move(view);
      normalise(view);
    }
    exec_.fill(crossed, 0);
    exec_.fill(arrived, 0);
  }

  /// Advection as in the thesis: the deposits of step k are in buffer k modulo the lifetime.
  void release(int k, const View& view) {
    const auto of_step = [&](int step) -> Array<std::uint64_t>& { return sums_[(step - first_) % ttl_]; };
    ReleaseParticles<View> particles;
    particles.path.field = field(k, view);
    particles.carried = carried_.data();
    particles.ttl = ttl_;
    for (int j = 0; j < ttl_; ++j) particles.sums[j] = of_step(k + j).data();
    {
      auto stage = exec_.stage("advect");
      for_each_surface_cell(exec_, view, particles);
    }
    auto stage = exec_.stage("extend");
    const auto extend = [&](const Array<std::uint64_t>& sums, float share, float* value) {
      for_each_surface_cell(exec_, view, NormaliseAndExtend<View>{view, sums.data(), value_.data(), share, value});
    };
    extend(of_step(k), 1, value_.data());
    exec_.fill(of_step(k), 0);
    // A frame shows the middle of its step, but the particles of the next step start at its end. So they carry the mean
    // of this frame and of what older particles have already left in the next one; else the texture lags the flow.
    extend(of_step(k + 1), 0.5f, ahead_.data());
  }

  BandFlowField<View> field(int k, const View& view) const {
    BandFlowField<View> field;
    field.view = view;
    field.steady = steady_;
    for (int j = 0; j < (Band::as_thesis ? ttl_ : 1) + 1; ++j) field.slot[j] = slots_[this->slot(k + j)].data();
    return field;
  }

  /// Sharpening and jitter for the next step, streaks and contrast for the eye.
  void show() override {
    const View view = octree_.view();
    const auto n = std::int64_t(view.surface_cells);
    const bool streaks = !Band::as_thesis && this->shows_ && parameters_.streaks > 0;
    refresh(value_, [&] {
      if constexpr (!Band::as_thesis)
        if (streaks) drawing_.mark(BrickSurface{view}, this->present_vectors_.data(), this->least_speed());
    });
    auto filter = exec_.stage("filter");
    Arena::Scope scope(exec_.arena());
    const Array<float> detail = exec_.arena().template temporary<float>(n);
    equalise(Band::as_thesis ? ahead_.data() : value_.data(), detail.data(), around_own());
    for_each_surface_cell(exec_, own(),
                          SharpenBand<View>{view, detail.data(), float(parameters_.sharpen), float(parameters_.jitter),
                                            seed_, std::uint32_t(launched_ + 1), carried_.data()});
    frame_ = value_.data();
    if (!this->shows_) return;
    if constexpr (!Band::as_thesis) {
      if (streaks) {
        const Array<float>& means = detail;  // until the frame is equalised
        const auto convolve = [&](const View& on) {
          drawing_.convolve(BrickSurface{on}, parameters_.streaks, means.data());
        };
        const auto smooth = [&](const View& on) { drawing_.smooth(BrickSurface{on}, means.data(), streaks_.data()); };
        drawing_.follow(BrickSurface{view}, value_.data());
        share_ ? share_->refresh_beside_of(means, view, convolve) : convolve(view);
        share_ ? share_->refresh_beside_of(streaks_, view, smooth) : smooth(view);
        frame_ = streaks_.data();
      }
    }
    equalise(frame_, detail.data(), own());
    exec_.for_each(n, Show{detail.data(), float(parameters_.contrast), shown_.data(), output_});
    if (this->output_means_) find_means(view, this->output_means_);
  }

  /// Of the shown values in each brick.
  void find_means(const View& view, float* means) {
    if constexpr (!Band::as_thesis) exec_.for_each(view.items(), BrickMeans{view, shown_.data(), means});
  }

  /// Gives the halo the values of the processes that own them, while this one does something else.
  template <class Work>
  void refresh(const Array<float>& value, const Work& meanwhile) {
    share_ ? share_->refresh(value, meanwhile) : meanwhile();
  }
  void refresh(const Array<float>& value) {
    refresh(value, [] {});
  }

  /// Own bricks, and those whose values sharpening asks for.
  View around_own() const {
    if constexpr (!Band::as_thesis)
      if (share_) return share_->detail(octree_.view());
    return octree_.view();
  }

  /// Of the values of all processes.
  const TextureSpread* spread_of(const float* value) {
    if (!share_) return measure_spread(exec_, std::int64_t(octree_.view().surface_cells), value);
    const auto n = std::int64_t(share_->surface_count());
    return measure_spread(exec_, n, value + share_->surface_first(), *ranks_);
  }

  /// On the bricks of `on`, from the values in those and around them.
  void equalise(const float* value, float* detail, const View& on) {
    const View view = octree_.view();
    Arena::Scope scope(exec_.arena());
    const TextureSpread* whole = spread_of(value);
    const auto run = [&](const auto& local) {
      using Local = std::remove_cvref_t<decltype(local)>;
      for_each_surface_cell(exec_, on,
                            EqualiseBand<View, Local>{view, value, local, whole, float(parameters_.equalise), detail});
    };
    if constexpr (Band::as_thesis) {
      run(NoLocalMoments{});
    } else {
      exec_.for_each_team(view.items(), BrickMoments{view, value, moments_.data()});
      run(LocalBrickMoments{moments_.data()});
    }
  }

  typename Band::Octree octree_;
  std::optional<OctreeShare<Backend>> share_;  ///< none: this process is alone
  double mean_list_ = 0;                       ///< triangles of a brick
  int levels_ = 0;
  Array<std::uint32_t> slots_[max_ttl + 1];
  Array<std::uint64_t> sums_[max_ttl];
  Array<float> carried_, value_, ahead_, shown_, streaks_;
  StreakDrawing<Backend> drawing_{exec_};
  const float* frame_ = nullptr;  ///< what is shown, before its contrast is stretched
  Array<Float4> moments_;
  Steps steps_, unseen_steps_;
};

template <class Backend, class Band>
std::vector<std::uint8_t> OctreeFlow<Backend, Band>::render(const RenderOptions& options) {
  this->require_embedded();
  auto stage = exec_.stage("render");
  const View view = octree_.view();
  BandTarget<View> target{view, this->nearest_triangles()};
  const float* shown = started_ && options.texture ? shown_.data() : nullptr;
  Arena::Scope scope(exec_.arena());
  if (shown) refresh(shown_);
  if constexpr (!Band::as_thesis)
    if (share_) target.own_first = share_->own_first_brick(), target.own_count = std::uint32_t(share_->own_bricks());
  if (shown && !Band::as_thesis) {
    Array<float> means = exec_.arena().template temporary<float>(std::size_t(view.items()));
    find_means(view, means.data());
    target.means = means.data();
  }
  return this->draw_target(target, shown, options, Vec3d(domain_.cells));
}

template <class Backend, class Band>
FlowLookup OctreeFlow<Backend, Band>::lookup() const {
  this->require_embedded();
  FlowLookup lookup;
  lookup.values = octree_.view().surface_cells;
  lookup.means = Band::as_thesis ? 0 : std::uint64_t(octree_.view().items());
  lookup.sheet_shift = this->sheets_.shift;
  lookup.origin = domain_.origin;
  lookup.cell_size = domain_.cell_size;
  lookup.levels = levels_;
  detail::fill_lookup(octree_, lookup);
  return lookup;
}

template <class Backend, class Band>
FlowValues OctreeFlow<Backend, Band>::values() const {
  this->require_started();
  const View view = octree_.view();
  const std::size_t n = view.surface_cells;
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  Array<std::uint64_t> device_code = arena.template temporary<std::uint64_t>(n);
  Array<CellPoint> device_point = arena.template temporary<CellPoint>(n);
  for_each_surface_cell(exec_, view, detail::GatherSurface<View>{view, device_code.data(), device_point.data()});
  const std::vector<std::uint64_t> code = device_code.download();
  const std::vector<CellPoint> point = device_point.download();
  const std::vector<float> value = this->download_frame(frame_, n);
  const std::size_t first = share_ ? share_->surface_first() : 0, own = share_ ? share_->surface_count() : n;
  FlowValues values(share_ ? own : std::size_t(info_.surface_cells));
  const DescribeCells describe = this->describe_cells();
  std::size_t out = 0;
  for (std::size_t s = first; s < first + own; ++s) {
    if (code[s] == ~std::uint64_t(0)) continue;
    const Vec3d centre = Vec3d(morton_cell(code[s])) + Vec3d(0.5);
    values.value[out] = value[s];
    describe(values, out++, centre, centre + Vec3d(point[s].offset(view.quantum)), point[s].triangle);
  }
  return values;
}

template <class Backend, class Band>
std::vector<float> OctreeFlow<Backend, Band>::sample_shown(std::span<const Vec3d> points) {
  this->require_started();
  refresh(shown_);
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  std::vector<BandPoint> host;
  for (const Vec3d& p : this->embedded_positions(points)) host.push_back(band_point(p));
  Array<BandPoint> positions = arena.template temporary<BandPoint>(host.size());
  positions.upload(host);
  Array<float> value = arena.template temporary<float>(host.size());
  exec_.for_each(std::int64_t(host.size()),
                 detail::SampleBandAt<View>{octree_.view(), shown_.data(), positions.data(), value.data()});
  return share_ ? share_->of_owners(host, value.download()) : value.download();
}

}  // namespace nacre
