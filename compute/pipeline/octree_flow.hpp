// Nacre: flow by the closest point method on a sparse octree (ch. 6): values and vectors extended into a narrow band,
// particles advected there in plain 3-D.
#pragma once

#include <algorithm>
#include <cmath>

#include "compute/embedding/build_brick_octree.hpp"
#include "compute/embedding/build_thesis_octree.hpp"
#include "compute/embedding/tree_boxes.hpp"
#include "compute/flow/band_advect.hpp"
#include "compute/flow/band_filter.hpp"
#include "compute/flow/band_velocity.hpp"
#include "compute/flow/sample_band.hpp"
#include "compute/flow/thesis_advect.hpp"
#include "compute/pipeline/flow_method.hpp"
#include "compute/raycast/octree_cast.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

/// The two-level octree and how flow runs on it: as on the grid, contrast judged in each brick's surroundings.
struct BrickBand {
  using Octree = BrickOctree;
  using Surface = BrickSurface;
  static constexpr const char* name = "brick octree";
  static constexpr bool as_thesis = false;
  static constexpr int smallest_box = 8;  ///< texture cells
  static std::uint64_t touched(const Octree& tree) { return tree.surface_cells; }
  /// Triangles of a brick that lists some.
  static double mean_list(const Octree& tree) { return double(tree.list.size()) / std::max(1u, tree.brick_count); }

  template <class Backend>
  static Octree build(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                      const FlowDomain& domain, const FlowParameters&) {
    return build_brick_octree(exec, mesh, triangles, levels, domain.radius);
  }
};

/// The thesis octree of cells and its flow, as the thesis has it: every cell of the band releases a particle from its
/// centre, whose whole life is computed at once; the texture is shown without streaks.
struct ThesisBand {
  using Octree = ThesisOctree;
  using Surface = ThesisSurface;
  static constexpr const char* name = "source octree";
  static constexpr bool as_thesis = true;
  static constexpr int smallest_box = 2;
  static std::uint64_t touched(const Octree& tree) { return tree.touched_cells; }
  static double mean_list(const Octree&) { return 0; }  // it lists none

  template <class Backend>
  static Octree build(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                      const FlowDomain& domain, const FlowParameters& parameters) {
    return build_thesis_octree(exec, mesh, triangles, levels, domain.radius, parameters.neighbour_index);
  }
};

namespace detail {

/// Values at points of the band, for probes.
template <class View>
struct SampleBandAt {
  View view;
  const float* values;
  const BandPoint* points;
  float* result;
  NACRE_HD void operator()(std::int64_t i) const { result[i] = sample_band(view, values, points[i], 0.5f); }
};

/// Whether a triangle touches a cell that has a value of its own: all do among bricks.
NACRE_HD inline bool is_touched(const BrickOctreeView&, CellIndex) { return true; }
NACRE_HD inline bool is_touched(const ThesisOctreeView& view, CellIndex cell) { return view.touches(cell); }

/// What a renderer needs of the tree.
inline void fill_lookup(const BrickOctree& tree, FlowLookup& lookup) {
  lookup.kind = FlowLookup::Kind::octree;
  for (const OctreeNode& node : tree.nodes.node.download()) {
    lookup.node.push_back(node.first);
    lookup.node.push_back(node.children);
  }
  lookup.level_start = tree.nodes.level_start.download();
  if (tree.surface_cells > 0xffffffffu) throw Error("the octree is too large to be drawn", "", "lower `resolution`");
  lookup.layer.reserve(24 * std::size_t(tree.brick_count));
  for (const OctreeBrick& brick : tree.brick.download())
    for (int z = 0; z < BrickOctreeView::width; ++z) {
      const CellMask& mask = brick.surface;
      lookup.layer.push_back(std::uint32_t(mask.word[z]));
      lookup.layer.push_back(std::uint32_t(mask.word[z] >> 32));
      lookup.layer.push_back(std::uint32_t(mask.first + mask.before[z]));
    }
}

inline void fill_lookup(const ThesisOctree& tree, FlowLookup& lookup) {
  lookup.kind = FlowLookup::Kind::thesis;
  const std::vector<ThesisNode> nodes = tree.node.download();
  if (8 * nodes.size() > 0xffffffffu) throw Error("the octree is too large to be drawn", "", "lower `resolution`");
  lookup.child.reserve(8 * nodes.size());
  for (const ThesisNode& node : nodes) lookup.child.insert(lookup.child.end(), node.child, node.child + 8);
}

/// What an output needs of each cell that has a value.
template <class View>
struct GatherSurface {
  View view;
  std::uint64_t* code;  ///< Morton code of its position; all ones where no triangle touches it
  CellPoint* point;
  NACRE_HD void operator()(CellIndex s, CellIndex cell, const Int3& position, typename View::Cursor&) const {
    code[s] = is_touched(view, cell) ? morton(position) : ~std::uint64_t(0);
    point[s] = view.point[cell];
  }
};

}  // namespace detail

template <class Backend, class Band>
class OctreeFlow final : public FlowMethodOn<Backend> {
 public:
  using FlowMethodOn<Backend>::FlowMethodOn;
  using View = decltype(std::declval<typename Band::Octree>().view());

  void embed(const FlowMesh& mesh) override {
    levels_ = make_octree_domain(mesh, parameters_, domain_);
    const FlowMesh embedded = this->separate(mesh, domain_.cell_size, domain_.radius);
    if (this->sheets_) levels_ = make_octree_domain(embedded, parameters_, domain_);
    require_octree_memory(embedded, parameters_, exec_.arena());
    auto stage = exec_.stage("embed");
    this->begin_embedding(embedded, mesh);
    octree_ = Band::build(exec_, mesh_, triangles_, levels_, domain_, parameters_);
    this->build_boxes(Band::mean_list(octree_), longest_lists, Vec3d(domain_.cells));
    describe();
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
  using Base::launched_, Base::output_, Base::seed_, Base::steady_, Base::triangles_, Base::ttl_;

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
      streak_cells_ = arena.permanent<StreakCell>(n);
    }
    info_.flow_bytes = arena.mark() - mark;
    for_each_surface_cell(exec_, view, FillBandNoise<View>{view, seed_, value_.data(), carried_.data()});
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
    info_.dense_bytes =
        std::uint64_t(double(n) * n * n * double(octree_.bytes()) / std::max<double>(1, double(view.cells)));
    info_.cell_size = domain_.cell_size;
  }

  void fill_slot(const Array<Vec3f>& vectors, const SpeedScale& scale, int slot) override {
    const View view = octree_.view();
    for_each_cell(exec_, view, ExtendVelocity<View>{view, mesh_, vectors.data(), scale, slots_[slot].data()});
  }

  void advance(int k) override {
    this->look_ahead(k);
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
    {
      auto stage = exec_.stage("advect");  // with the deposits: a particle draws while it moves
      for_each_surface_cell(exec_, view, particles);
    }
    auto stage = exec_.stage("extend");
    const BrickSurface surface{view};
    for_each_surface_cell_of(
        exec_, surface, std::int64_t(view.surface_cells),
        Normalise<BrickSurface>{surface, ended.data(), crossed.data(), carried_.data(), value_.data()});
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
    auto stage = exec_.stage("filter");
    const View view = octree_.view();
    const auto n = std::int64_t(view.surface_cells);
    Arena::Scope scope(exec_.arena());
    float* detail = exec_.arena().template temporary<float>(n).data();
    equalise(Band::as_thesis ? ahead_.data() : value_.data(), detail);
    for_each_surface_cell(exec_, view,
                          SharpenBand<View>{view, detail, float(parameters_.sharpen), float(parameters_.jitter), seed_,
                                            std::uint32_t(launched_ + 1), carried_.data()});
    frame_ = value_.data();
    if (!this->shows_) return;
    if constexpr (!Band::as_thesis) {
      if (parameters_.streaks > 0) {
        this->draw_streaks(BrickSurface{view}, n, 1.0, value_.data(), streak_cells_.data(), streaks_.data());
        frame_ = streaks_.data();
      }
    }
    equalise(frame_, detail);
    exec_.for_each(n, Show{detail, float(parameters_.contrast), shown_.data(), output_});
    if (this->output_means_) find_means(view, this->output_means_);
  }

  /// Of the shown values in each brick.
  void find_means(const View& view, float* means) {
    if constexpr (!Band::as_thesis) exec_.for_each(view.items(), BrickMeans{view, shown_.data(), means});
  }

  void equalise(const float* value, float* detail) {
    const View view = octree_.view();
    const auto n = std::int64_t(view.surface_cells);
    Arena::Scope scope(exec_.arena());
    const TextureSpread* whole = measure_spread(exec_, n, value);
    const auto run = [&](const auto& local) {
      using Local = std::remove_cvref_t<decltype(local)>;
      for_each_surface_cell(exec_, view,
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
  int levels_ = 0;
  Array<std::uint32_t> slots_[max_ttl + 1];
  Array<std::uint64_t> sums_[max_ttl];
  Array<float> carried_, value_, ahead_, shown_, streaks_;
  Array<StreakCell> streak_cells_;
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
  FlowValues values(std::size_t(info_.surface_cells));
  const typename Base::Describe describe(*this);
  std::size_t out = 0;
  for (std::size_t s = 0; s < n; ++s) {
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
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  std::vector<BandPoint> host;
  for (const Vec3d& p : this->embedded_places(points)) host.push_back(band_point(p));
  Array<BandPoint> places = arena.template temporary<BandPoint>(host.size());
  places.upload(host);
  Array<float> value = arena.template temporary<float>(host.size());
  exec_.for_each(std::int64_t(host.size()),
                 detail::SampleBandAt<View>{octree_.view(), shown_.data(), places.data(), value.data()});
  return value.download();
}

}  // namespace nacre
