// Nacre: spots and stripes on the two-level closest-point grid, which react and diffuse along the vectors.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "compute/flow/turing.hpp"
#include "compute/pipeline/grid_method.hpp"

namespace nacre {

/// A Turing pattern by the closest point method (docs/method/reaction-diffusion.md), on the cells of the closest-point
/// grid. `start` lets it form of noise along the vectors of the first time; with each step it follows the vectors.
template <class Backend>
class GridPattern final : public GridMethod<Backend> {
 public:
  using GridMethod<Backend>::GridMethod;

  void embed(const FlowMesh& mesh) override {
    if (mesh.moves) throw Error("`texture` spots and stripes need a surface that does not move", "", "use streaks");
    Base::embed(mesh);
    {
      auto stage = exec_.stage("embed");
      band_ = find_diffusion_band(exec_, coarse_.view(), coarse_.cells);
      this->info_.bytes += band_.bytes();
    }
    this->end_embedding();
  }

  void start(const FlowVectors& vectors, const std::function<void()>&) override {
    make_arrays(vectors);
    this->warm_up();
    weigh();
    react(pattern_.formation);
    this->shows_ = true;
    show();
    exec_.wait();
  }

  double resume(const FlowVectors&, const FlowMethod&, FlowCarry) override {
    throw std::logic_error("a pattern carried to another surface");
  }

 private:
  using Base = GridMethod<Backend>;
  using Base::coarse_, Base::detail_, Base::exec_, Base::fine_, Base::mesh_, Base::parameters_, Base::refine_;
  using Base::seed_, Base::steady_;

  void make_arrays(const FlowVectors& vectors) override {
    spacing_ = parameters_.pattern_spacing / refine_;
    this->begin_flow(vectors, 1.0 / refine_, Base::no_sight);
    this->first_ = this->step_;
    pattern_ = parameters_.texture == FlowTexture::spots ? spots_pattern() : stripes_pattern();
    Arena& arena = exec_.arena();
    diffusion_ = SurfaceDiffusion<Backend>(exec_, coarse_.view(), coarse_.cells, band_);
    for (Array<Pair>* pairs : {&value_, &change_}) {
      *pairs = arena.permanent<Pair>(coarse_.cells);
      pairs->fill_bytes(0);
    }
    frame_ = arena.permanent<float>(fine_.surface_cells);
    this->make_frame_arrays();
    exec_.for_each(band_.inner.size(), FillPatternNoise{seed_, band_.inner.data(), change_.data()});
    exec_.for_each(band_.outer.size(), ExtendChange{coarse_.view(), band_.outer.data(), 0, TuringReaction::most,
                                                    change_.data(), value_.data()});
  }

  std::vector<KeptArray> kept_arrays() const override { return {kept(value_, 0, std::size_t(coarse_.cells))}; }
  void take_up() override { weigh(); }

  void fill_slot(const Array<Vec3f>&, const SpeedScale&, int) override {}  // it sees no step ahead

  void advance(int k) override {
    this->look_ahead(k);
    if (!steady_) weigh();
    react(pattern_.renewal);
    show();
    ++this->launched_;
  }

  /// Takes the vectors of the frame.
  void weigh() {
    auto stage = exec_.stage("velocity");
    const StretchBySpeed stretch{float(parameters_.pattern_stretch), slow * float(this->vectors_.reference_speed)};
    diffusion_.weigh(exec_, mesh_, this->present_vectors_.data(), stretch);
  }

  /// Lets the pattern react and diffuse for so long, in the longest steps that are stable.
  void react(double duration) {
    auto stage = exec_.stage("react");
    const double longest = pattern_.stable_step(spacing_, diffusion_.largest_row());
    const auto steps = int(std::ceil(duration / longest));
    const auto step = float(duration / steps);
    const Diffusivities diffusivities = pattern_.diffusivities(spacing_);
    exec_.repeat(react_, [&] {
      for (int k = 0; k < steps; ++k)
        diffusion_.step(exec_, diffusivities, pattern_.reaction, step, std::min(1.0f, renewal_rate * step),
                        TuringReaction::most, value_.data(), change_.data());
    });
  }

  void show() override {
    auto stage = exec_.stage("filter");
    const auto n = std::int64_t(fine_.surface_cells);
    Arena::Scope scope(exec_.arena());
    exec_.for_each(n, SamplePattern{fine_.view(coarse_.view()), value_.data(), frame_.data()});
    exec_.for_each(n, Standardise{frame_.data(), measure_spread(exec_, n, frame_.data()), detail_.data()});
    this->publish(frame_.data());
  }

  static constexpr float slow = 0.1f;          ///< of the reference speed: half of the stretch is reached there
  static constexpr float renewal_rate = 1.5f;  ///< share of the values that is extended anew, per time

  TuringPattern pattern_ = spots_pattern();
  double spacing_ = 7;  ///< cells of the grid
  DiffusionBand band_;
  SurfaceDiffusion<Backend> diffusion_;
  Array<Pair> value_, change_;
  Array<float> frame_;
  Steps react_;
};

}  // namespace nacre
