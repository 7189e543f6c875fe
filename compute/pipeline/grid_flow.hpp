// Nacre: flow on the two-level closest-point grid, particles kept on the surface by projection (ch. 5).
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "compute/embedding/tree_boxes.hpp"
#include "compute/flow/advect.hpp"
#include "compute/flow/filter.hpp"
#include "compute/flow/streaks.hpp"
#include "compute/flow/velocity.hpp"
#include "compute/pipeline/flow_method.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

namespace detail {
/// Whether triangles touch a cell.
struct ListsTriangles {
  const std::uint32_t* touch_start;
  NACRE_HD std::uint64_t operator()(std::int64_t cell) const { return touch_start[cell + 1] > touch_start[cell]; }
};

/// Shown values at points given in texture cells.
struct SampleShown {
  RefinedGridView texture;
  const float* shown;
  const Vec3f* points;
  float* value;
  NACRE_HD void operator()(std::int64_t i) const { value[i] = sample(texture, shown, points[i], 0.5f); }
};
}  // namespace detail

template <class Backend>
class GridFlow final : public FlowMethodOn<Backend> {
 public:
  using FlowMethodOn<Backend>::FlowMethodOn;

  void embed(const FlowMesh& mesh) override {
    domain_ = make_domain(mesh, parameters_);
    const FlowMesh embedded = this->separate(mesh, domain_.cell_size, domain_.radius);
    if (this->sheets_) domain_ = make_domain(embedded, parameters_);
    require_memory(embedded, parameters_, exec_.arena());
    refine_ = parameters_.refine;
    {
      auto stage = exec_.stage("embed");
      this->begin_embedding(embedded, mesh);
      coarse_ = build_closest_point_grid(exec_, mesh_, triangles_, domain_.bricks, parameters_.subcells,
                                         float(domain_.radius));
      const std::uint64_t listing = exec_.reduce(std::int64_t(coarse_.cells), std::uint64_t(0),
                                                 detail::ListsTriangles{coarse_.touch_start.data()}, Add());
      const double mean_list = double(coarse_.touch_triangle.size()) / std::max(1.0, double(listing));
      this->build_boxes(mean_list, longest_lists, Vec3d(domain_.bricks * Int3(coarse_.sub)));
    }
    {
      auto stage = exec_.stage("refine");
      fine_ = build_refined_grid(exec_, mesh_, triangles_, coarse_, refine_);
    }
    describe();
    this->end_embedding();
  }

  double resume(const FlowVectors& vectors, const FlowMethod& before, FlowCarry how) override {
    const auto& old = dynamic_cast<const GridFlow&>(before);
    make_arrays(vectors);
    this->go_on_from(old);
    exec_.for_each(fine_.surface_cells, FillNoise{seed_, shown_.data()});
    Arena::Scope scope(exec_.arena());
    CellIndex* source = exec_.arena().template temporary<CellIndex>(fine_.surface_cells).data();
    const GridSurface on{fine_.view(coarse_.view())}, on_old{old.fine_.view(old.coarse_.view())};
    const double found =
        this->find_sources(on, fine_.surface_cells, 1.0 / refine_, old, on_old, 1.0 / old.refine_, how, source);
    this->take(source, old.arrived_[launched_ & 1], arrived_[launched_ & 1]);
    this->take(source, old.value_, value_);
    this->take(source, old.carried_, carried_);
    this->take(source, old.shown_, shown_);
    frame_ = value_.data();
    this->warm_up();
    return found;
  }

  std::vector<float> shown() const override;
  void show_into(float* memory, float* means) override { output_ = memory, this->output_means_ = means; }
  std::vector<std::uint8_t> render(const RenderOptions& options) override;
  FlowValues values() const override;
  std::vector<float> sample_shown(std::span<const Vec3d> points) override;
  FlowLookup lookup() const override;
  FlowBoxes boxes() const override { return {domain_.origin, coarse_.sub * domain_.cell_size, box_levels(coarse_)}; }
  void show_boxes(std::uint64_t* memory) override { write_boxes(exec_, coarse_, memory); }

 private:
  using Base = FlowMethodOn<Backend>;
  using Base::domain_, Base::exec_, Base::first_, Base::info_, Base::mesh_, Base::parameters_, Base::started_;
  using Base::launched_, Base::output_, Base::seed_, Base::steady_, Base::triangles_, Base::ttl_;

  /// What `start` and `resume` need; noise in it.
  void make_arrays(const FlowVectors& vectors) override {
    this->begin_flow(vectors, 1.0 / refine_, 1);
    Arena& arena = exec_.arena();
    const std::size_t n = fine_.surface_cells;
    for (int j = 0; j < this->slots(); ++j) slots_[j] = arena.permanent<Float4>(coarse_.cells);
    for (Array<std::uint64_t>* words : {&crossed_, &arrived_[0], &arrived_[1]}) {
      *words = arena.permanent<std::uint64_t>(n);
      words->fill_bytes(0);
    }
    carried_ = arena.permanent<float>(n);
    value_ = arena.permanent<float>(n);
    streaks_ = arena.permanent<float>(n);
    detail_ = arena.permanent<float>(n);
    streak_cells_ = arena.permanent<StreakCell>(n);
    for (Array<Float4>& moments : moments_) {
      moments = arena.permanent<Float4>(coarse_.cells);
      moments.fill_bytes(0);  // blurring never writes the cells without a block
    }
    shown_ = arena.permanent<float>(n);
    for (Array<float>* noise : {&carried_, &value_}) exec_.for_each(n, FillNoise{seed_, noise->data()});
  }

  static constexpr double longest_lists = 6;  ///< triangles in a cell, above which a tree is faster

  void describe() {
    info_ = {};
    info_.closest_point_dimensions = domain_.extent;
    info_.dimensions = domain_.extent * Int3(refine_);
    info_.cells = fine_.cells;
    info_.surface_cells = fine_.surface_cells;
    info_.closest_point_cells = coarse_.cells;
    info_.bytes = coarse_.bytes() + fine_.bytes();
    const double box = double(info_.dimensions.x) * info_.dimensions.y * info_.dimensions.z;
    info_.dense_bytes = std::uint64_t(box * (double(fine_.bytes()) / std::max<double>(1, double(fine_.cells))) +
                                      box / std::pow(refine_, 3) * (sizeof(Float4) + 4));
    info_.cell_size = domain_.cell_size / refine_;
  }

  void fill_slot(const Array<Vec3f>& vectors, const SpeedScale& scale, int slot) override {
    exec_.for_each(coarse_.cells,
                   EmbedVelocity{mesh_, coarse_.view(), vectors.data(), scale, 3.5f, slots_[slot].data()});
  }

  void advance(int k) override {
    this->look_ahead(k);
    exec_.repeat(this->shows_ ? steps_ : unseen_steps_, [&] { launch(k); });
    ++launched_;  // not inside: a graph that cannot be made is launched again, one by one
  }

  /// What follows the look ahead; nothing in it waits for the device.
  void launch(int k) {
    const Array<std::uint64_t>&arrived = arrived_[launched_ & 1], &ended = arrived_[~launched_ & 1];
    const RefinedGridView texture = fine_.view(coarse_.view());
    MoveParticles particles;
    particles.field.grid = coarse_.view();
    particles.field.steady = steady_;
    for (int j = 0; j < 2; ++j) particles.field.slot[j] = slots_[this->slot(k + j)].data();
    particles.texture = texture;
    particles.carried = carried_.data();
    particles.arrived = arrived.data();
    particles.crossed = crossed_.data();
    particles.ended = ended.data();
    particles.ttl = ttl_;
    particles.rounding = this->rounding_of(launched_);
    {
      auto stage = exec_.stage("advect");  // with the deposits: a particle draws while it moves
      exec_.for_each(fine_.surface_cells, particles);
    }
    {
      auto stage = exec_.stage("deposit");
      const Normalise<GridSurface> normalise{{texture}, ended.data(), crossed_.data(), carried_.data(), value_.data()};
      for_each_surface_cell_of(exec_, GridSurface{texture}, fine_.surface_cells, normalise);
      exec_.fill(crossed_, 0);
      exec_.fill(arrived, 0);
    }
    show();
  }

  /// Sharpening and jitter for the next step, streaks and contrast for the eye.
  void show() override {
    auto stage = exec_.stage("filter");
    const std::int64_t n = fine_.surface_cells;
    const RefinedGridView texture = fine_.view(coarse_.view());
    Arena::Scope scope(exec_.arena());
    const auto equalise = [&](const float* value) {
      const TextureSpread* whole = measure_spread(exec_, n, value);
      const Float4* moments = gather_moments(texture, value);
      exec_.for_each_team(fine_.block_cell.size(),
                          Equalise{texture, value, moments, whole, float(parameters_.equalise), detail_.data()});
    };
    equalise(value_.data());
    exec_.for_each(n, SharpenAndJitter{texture, detail_.data(), float(parameters_.sharpen), float(parameters_.jitter),
                                       seed_, std::uint32_t(launched_ + 1), carried_.data()});
    if (!this->shows_) return;
    if (parameters_.streaks > 0)
      this->draw_streaks(GridSurface{texture}, GridSurface{texture}, n, 1.0 / refine_, value_.data(),
                         streak_cells_.data(), streaks_.data());
    frame_ = parameters_.streaks > 0 ? streaks_.data() : value_.data();
    equalise(frame_);
    exec_.for_each(n, Show{detail_.data(), float(parameters_.contrast), shown_.data(), output_});
    if (this->output_means_)
      exec_.for_each(fine_.block_cell.size(), BlockMeans{texture, shown_.data(), this->output_means_});
  }

  /// Local moments of `value` over a window of about a dozen texture cells, in one of two buffers.
  const Float4* gather_moments(const RefinedGridView& texture, const float* value) {
    const Array<Float4>*from = &moments_[0], *to = &moments_[1];
    exec_.for_each(coarse_.cells, LocalMoments{texture, value, from->data()});
    const int passes = refine_ == 1 ? 8 : refine_ == 2 ? 4 : refine_ <= 4 ? 1 : 0;
    for (int k = 0; k < passes; ++k) {
      exec_.for_each(fine_.block_cell.size(), BlurMoments{texture, from->data(), to->data()});
      std::swap(from, to);
    }
    return from->data();
  }

  int refine_ = 4;
  ClosestPointGrid coarse_;
  RefinedGrid fine_;
  Array<Float4> slots_[2];
  Array<std::uint64_t> crossed_, arrived_[2];
  Array<float> carried_, value_, streaks_, detail_, shown_;
  Array<StreakCell> streak_cells_;
  const float* frame_ = nullptr;  ///< what is shown, before its contrast is stretched
  Array<Float4> moments_[2];
  Steps steps_, unseen_steps_;
};

template <class Backend>
std::vector<float> GridFlow<Backend>::shown() const {
  this->require_started();
  std::vector<float> host(fine_.surface_cells);
  exec_.device().copy_to_host(host.data(), shown_.data(), host.size() * sizeof(float));
  return host;
}

template <class Backend>
std::vector<std::uint8_t> GridFlow<Backend>::render(const RenderOptions& options) {
  this->require_embedded();
  auto stage = exec_.stage("render");
  const RefinedGridView texture = fine_.view(coarse_.view());
  GridTarget target{coarse_.view(), texture, this->nearest_triangles()};
  const float* shown = started_ && options.texture ? shown_.data() : nullptr;
  Arena::Scope scope(exec_.arena());
  if (shown) {
    Array<float> means = exec_.arena().template temporary<float>(fine_.block_cell.size());
    exec_.for_each(fine_.block_cell.size(), BlockMeans{texture, shown_.data(), means.data()});
    target.means = means.data();
  }
  return this->draw_target(target, shown, options, Vec3d(domain_.bricks * Int3(coarse_.sub)));
}

template <class Backend>
FlowValues GridFlow<Backend>::values() const {
  this->require_started();
  const std::size_t n = fine_.surface_cells;
  FlowValues values(n);
  values.value = this->download_frame(frame_, n);
  const std::vector<Float4> seed = fine_.seed.download();
  const std::vector<std::uint32_t> position = fine_.position.download(), triangle = fine_.seed_triangle.download();
  const std::vector<std::uint32_t> block_cell = fine_.block_cell.download();
  const std::vector<std::uint64_t> code = coarse_.brick_code.download();
  ClosestPointGridView grid = coarse_.view();
  grid.brick_code = code.data();
  RefinedGridView texture = fine_.view(grid);
  texture.block_cell = block_cell.data();
  const typename Base::Describe describe(*this);
  for (std::size_t s = 0; s < n; ++s) {
    const Vec3d centre = Vec3d(texture.texel_cell(position[s])) + Vec3d(0.5);
    const Vec3d surface = centre + Vec3d(seed[s].x, seed[s].y, seed[s].z);
    describe(values, s, centre / double(refine_), surface / double(refine_), triangle[s]);
  }
  return values;
}

template <class Backend>
std::vector<float> GridFlow<Backend>::sample_shown(std::span<const Vec3d> points) {
  this->require_started();
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  std::vector<Vec3f> host;
  for (const Vec3d& p : this->embedded_positions(points)) host.push_back(Vec3f(p * double(refine_)));
  Array<Vec3f> positions = arena.temporary<Vec3f>(host.size());
  positions.upload(host);
  Array<float> value = arena.temporary<float>(host.size());
  exec_.for_each(std::int64_t(host.size()),
                 detail::SampleShown{fine_.view(coarse_.view()), shown_.data(), positions.data(), value.data()});
  return value.download();
}

template <class Backend>
FlowLookup GridFlow<Backend>::lookup() const {
  this->require_embedded();
  FlowLookup lookup;
  lookup.kind = FlowLookup::Kind::grid;
  lookup.values = fine_.surface_cells;
  lookup.means = fine_.block_cell.size();
  lookup.sheet_shift = this->sheets_.shift;
  lookup.bricks = coarse_.bricks;
  lookup.subcells = coarse_.sub;
  lookup.refine = refine_;
  lookup.origin = domain_.origin;
  lookup.cell_size = domain_.cell_size;
  lookup.brick_index = coarse_.brick_index.download();
  lookup.block = fine_.block.download();
  lookup.texel = fine_.texel.download();
  return lookup;
}

}  // namespace nacre
