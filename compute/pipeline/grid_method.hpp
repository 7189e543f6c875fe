// Nacre: the two-level closest-point grid (ch. 5) as a method of flow: its embedding, and the texture on its cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "compute/embedding/tree_boxes.hpp"
#include "compute/flow/filter.hpp"
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

/// What every texture on the grid has: the embedding, contrast for the eye, pictures and values. A derived class makes
/// values (0..1) for the texture's cells and gives them to `show_frame` or `publish`.
template <class Backend>
class GridMethod : public FlowMethodOn<Backend> {
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

  std::vector<float> shown() const override;
  void show_into(float* memory, float* means) override { output_ = memory, this->output_means_ = means; }
  std::vector<std::uint8_t> render(const RenderOptions& options) override;
  FlowValues values() const override;
  std::vector<float> sample_shown(std::span<const Vec3d> points) override;
  FlowLookup lookup() const override;
  FlowBoxes boxes() const override { return {domain_.origin, coarse_.sub * domain_.cell_size, box_levels(coarse_)}; }
  void show_boxes(std::uint64_t* memory) override { write_boxes(exec_, coarse_, memory); }

 protected:
  using Base = FlowMethodOn<Backend>;
  using Base::domain_, Base::exec_, Base::info_, Base::mesh_, Base::parameters_, Base::started_;
  using Base::output_, Base::triangles_;

  /// Arrays that a frame needs; permanent.
  void make_frame_arrays() {
    Arena& arena = exec_.arena();
    const std::size_t n = fine_.surface_cells;
    detail_ = arena.permanent<float>(n);
    shown_ = arena.permanent<float>(n);
    for (Array<Float4>& moments : moments_) {
      moments = arena.permanent<Float4>(coarse_.cells);
      moments.fill_bytes(0);  // blurring never writes the cells without a block
    }
  }

  /// Puts values into `detail_`, in standard deviations from their mean, local contrast stretched.
  void equalise(const float* value) {
    const RefinedGridView texture = fine_.view(coarse_.view());
    const TextureSpread* whole = measure_spread(exec_, std::int64_t(fine_.surface_cells), value);
    const Float4* moments = gather_moments(texture, value);
    exec_.for_each_team(fine_.block_cell.size(),
                        Equalise{texture, value, moments, whole, float(parameters_.equalise), detail_.data()});
  }

  /// Makes `frame` the one that is shown, with local contrast. Inside a scope of the arena.
  void show_frame(const float* frame) {
    equalise(frame);
    publish(frame);
  }

  /// Makes `frame` the one that is shown, as far from its mean as `detail_` says.
  void publish(const float* frame) {
    frame_ = frame;
    exec_.for_each(fine_.surface_cells, Show{detail_.data(), float(parameters_.contrast), shown_.data(), output_});
    if (this->output_means_)
      exec_.for_each(fine_.block_cell.size(),
                     BlockMeans{fine_.view(coarse_.view()), shown_.data(), this->output_means_});
  }

  int refine_ = 4;
  ClosestPointGrid coarse_;
  RefinedGrid fine_;
  Array<float> detail_, shown_;
  const float* frame_ = nullptr;  ///< what is shown, before its contrast is stretched

 private:
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

  Array<Float4> moments_[2];
};

template <class Backend>
std::vector<float> GridMethod<Backend>::shown() const {
  this->require_started();
  std::vector<float> host(fine_.surface_cells);
  exec_.device().copy_to_host(host.data(), shown_.data(), host.size() * sizeof(float));
  return host;
}

template <class Backend>
std::vector<std::uint8_t> GridMethod<Backend>::render(const RenderOptions& options) {
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
FlowValues GridMethod<Backend>::values() const {
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
  const DescribeCells describe = this->describe_cells();
  for (std::size_t s = 0; s < n; ++s) {
    const Vec3d centre = Vec3d(texture.texel_cell(position[s])) + Vec3d(0.5);
    const Vec3d surface = centre + Vec3d(seed[s].x, seed[s].y, seed[s].z);
    describe(values, s, centre / double(refine_), surface / double(refine_), triangle[s]);
  }
  return values;
}

template <class Backend>
std::vector<float> GridMethod<Backend>::sample_shown(std::span<const Vec3d> points) {
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
FlowLookup GridMethod<Backend>::lookup() const {
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
