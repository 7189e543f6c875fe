// Nacre: flow on the two-level closest-point grid, particles kept on the surface by projection (ch. 5).
#pragma once

#include "compute/flow/advect.hpp"
#include "compute/flow/filter.hpp"
#include "compute/flow/velocity.hpp"
#include "compute/pipeline/grid_method.hpp"
#include "compute/pipeline/streak_drawing.hpp"

namespace nacre {

template <class Backend>
class GridFlow final : public GridMethod<Backend> {
 public:
  using GridMethod<Backend>::GridMethod;

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

 private:
  using Base = GridMethod<Backend>;
  using Base::coarse_, Base::detail_, Base::exec_, Base::fine_, Base::frame_, Base::mesh_, Base::parameters_;
  using Base::launched_, Base::refine_, Base::seed_, Base::shown_, Base::steady_, Base::ttl_;

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
    drawing_.make(GridSurface{fine_.view(coarse_.view())}, n, mesh_, 1.0 / refine_);
    this->make_frame_arrays();
    for (Array<float>* noise : {&carried_, &value_}) exec_.for_each(n, FillNoise{seed_, noise->data()});
  }

  std::vector<KeptArray> kept_arrays() const override {
    const std::size_t n = fine_.surface_cells;
    return {kept(value_, 0, n), kept(arrived_[launched_ & 1], 0, n)};
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
    particles.n = fine_.surface_cells;
    particles.ttl = ttl_;
    particles.rounding = this->rounding_of(launched_);
    {
      auto stage = exec_.stage("advect");  // with the deposits: a particle draws while it moves
      exec_.for_each((particles.n + Widest::lanes - 1) / Widest::lanes, particles);
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
    this->equalise(value_.data());
    exec_.for_each(n, SharpenAndJitter{texture, detail_.data(), float(parameters_.sharpen), float(parameters_.jitter),
                                       seed_, std::uint32_t(launched_ + 1), carried_.data()});
    if (!this->shows_) return;
    if (parameters_.streaks > 0) {
      const GridSurface surface{texture};
      drawing_.mark(surface, this->present_vectors_.data(), this->least_speed());
      drawing_.follow(surface, value_.data());
      float* means = detail_.data();  // until the frame is equalised
      drawing_.convolve(surface, parameters_.streaks, means);
      drawing_.smooth(surface, means, streaks_.data());
    }
    this->show_frame(parameters_.streaks > 0 ? streaks_.data() : value_.data());
  }

  Array<Float4> slots_[2];
  Array<std::uint64_t> crossed_, arrived_[2];
  Array<float> carried_, value_, streaks_;
  StreakDrawing<Backend> drawing_{exec_};
  Steps steps_, unseen_steps_;
};

}  // namespace nacre
