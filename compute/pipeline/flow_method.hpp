// Nacre: what all methods of the flow pipeline share: the mesh on the device, time, the ring of steps, the view.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "compute/embedding/closest_point_grid.hpp"
#include "compute/flow/filter.hpp"
#include "compute/flow/velocity.hpp"
#include "compute/pipeline/carry.hpp"
#include "compute/pipeline/colour_scene.hpp"
#include "compute/pipeline/describe_cells.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/pipeline/kept_arrays.hpp"
#include "compute/pipeline/mesh_of_bricks.hpp"
#include "compute/pipeline/moved_shape.hpp"
#include "compute/pipeline/separate_sheets.hpp"
#include "compute/raycast/build_triangle_boxes.hpp"
#include "compute/raycast/draw_among_ranks.hpp"
#include "compute/raycast/moved_target.hpp"
#include "compute/raycast/triangle_tree.hpp"

namespace nacre {

/// The shared part on a backend. A derived class builds its embedding in `embed` (after `begin_embedding`), its arrays
/// in `make_arrays` (after `begin_flow`), and advances by one step in `advance`.
template <class Backend>
class FlowMethodOn : public FlowMethod {
 public:
  FlowMethodOn(Executor<Backend>& exec, const FlowParameters& parameters, Ranks* ranks = nullptr)
      : exec_(exec), parameters_(parameters), ranks_(ranks) {}

  void start(const FlowVectors& vectors, const std::function<void()>& between) override {
    make_arrays(vectors);
    const int begin = std::exchange(step_, first_);
    warm_up();
    shows_ = step_ == begin;
    show(), ++launched_;
    warm_up_to(begin, between);
  }

  int next_step() const override { return step_; }

  void save(const PutBytes& put) override {
    require_started();
    exec_.wait();
    put_arrays(exec_.device(), ranks_, kept_arrays(), put);
  }

  /// What is carried and shown follows from the values, as it did when they were new.
  void go_on(const FlowVectors& vectors, int next, const TakeBytes& take,
             const std::function<void()>& between) override {
    make_arrays(vectors);
    const int begin = std::exchange(step_, next);
    launched_ += next - first_ + 1;
    first_ = next;
    warm_up();
    take_arrays(exec_.device(), ranks_, kept_arrays(), take);
    take_up();
    shows_ = step_ >= begin;
    --launched_, show(), ++launched_;
    warm_up_to(begin, between);
  }

  /// Waits once, at its end: then the frame is there, for whoever draws it.
  void step() override {
    require_started();
    shows_ = true;
    advance(step_);
    ++step_;
    exec_.wait();
  }

  double time() const override { return time_of(step_); }
  double time_of(int k) const override {
    const double share = std::clamp(double(k) / std::max(1, parameters_.steps), 0.0, 1.0);
    return vectors_.start + (vectors_.end - vectors_.start) * share;
  }
  const EmbeddingInfo& embedding() const override { return info_; }

  void move(const FlowShape& shape) override {
    require_embedded();
    if (!shape_.made()) throw std::logic_error("a surface that was embedded as one that does not move");
    if (shape.points.size() != points_.size() || shape.corner_normals.size() != normals_.size())
      throw std::logic_error("a shape of another mesh");
    std::vector<Vec3d> points;
    points.reserve(shape.points.size());
    for (const Vec3d& p : shape.points) points.push_back(domain_.to_grid(p));
    shape_.move_to(exec_, corners_.data(), std::move(points), shape.corner_normals, shape.vectors);
  }

 protected:
  /// `begin_flow`, and arrays with noise for this embedding.
  virtual void make_arrays(const FlowVectors& vectors) = 0;
  /// What the next step carries, and the frame for the eye where it `shows_`: not in a warm-up before its end.
  virtual void show() = 0;
  /// Moves on by step `k` of the data; those before 0 are the warm-up.
  virtual void advance(int k) = 0;
  /// What the next step needs of those before: values and deposits.
  virtual std::vector<KeptArray> kept_arrays() const = 0;
  /// What else follows from these arrays, before `show`.
  virtual void take_up() {}
  /// Embeds the vectors on the device (one per point of the mesh, world units) as displacements of the step's slot.
  virtual void fill_slot(const Array<Vec3f>& vectors, const SpeedScale& scale, int slot) = 0;

  void require_embedded() const {
    if (!embedded_) throw Error("no surface embedded");
  }
  void require_started() const {
    if (!started_) throw Error("no flow started");
  }

  /// The surface as embedded: second sheets are more than `reach` cells of the domain, `cell` wide, from all others.
  FlowMesh separate(const FlowMesh& mesh, double cell, double reach) {
    sheets_ = {};
    if (mesh.moves) return mesh;  // the sheets of a surface that moves share their cells
    sheets_ = separate_sheets(mesh, cell * (2 * std::ceil(reach) + 6));
    if (!sheets_) return mesh;
    return {sheets_.points, sheets_.triangles, mesh.corner_normals, mesh.second_sheet};
  }

  /// Empties the arena and takes the mesh up, in cells of the domain: `embedded`, and `seen` where that is another.
  void begin_embedding(const FlowMesh& embedded, const FlowMesh& seen) {
    points_.clear();
    for (const Vec3d& p : embedded.points) points_.push_back(domain_.to_grid(p));
    Arena& arena = exec_.arena();
    device_points_ = arena.permanent_copy<Vec3d>(points_);
    corners_ = arena.permanent_copy<Triangle>(embedded.triangles);
    normals_ = arena.permanent_copy<Vec3f>(embedded.corner_normals);
    mesh_ = seen_ = {device_points_.data(), corners_.data(), normals_.data()};
    triangles_ = std::uint32_t(embedded.triangles.size());
    numbers_ = {};
    if (gathered_) numbers_ = arena.permanent_copy<std::uint32_t>(gathered_->numbers());
    boxes_ = {};
    second_sheet_.assign(seen.second_sheet.begin(), seen.second_sheet.end());
    if (seen.moves) shape_.make(exec_, mesh_, points_, seen.triangles, seen.corner_normals);
    if (!sheets_) return;
    // Points that are not moved are the first ones of both.
    seen_corners_ = arena.permanent_copy<Triangle>(seen.triangles);
    device_second_sheet_ = arena.permanent_copy<std::uint8_t>(second_sheet_);
    seen_.triangles = seen_corners_.data();
  }

  /// A tree for the rays of pictures. `triangles_met`: how many the list of a cell has, in the mean, where a ray looks
  /// for the surface; `most`: with how many of them lists are as fast.
  void build_boxes(double triangles_met, double most, const Vec3d& dims) {
    if (shape_.made()) return;  // it has a tree of its own
    if (sheets_ || triangles_met > most) boxes_ = build_triangle_boxes(exec_, seen_, triangles_, dims);
  }

  /// What finds the surface if there is such a tree.
  NearestTriangles nearest_triangles() const {
    NearestTriangles nearest;
    if (boxes_.leaves > 0) nearest.boxes = boxes_.view();
    if (sheets_) nearest.sheets = {device_second_sheet_.data(), sheets_.shift / domain_.cell_size};
    return nearest;
  }

  void end_embedding() {
    embedding_mark_ = exec_.arena().mark();
    embedded_ = true;
  }

  static constexpr int no_sight = -1;

  /// Gives the last run's arrays back. `texel` is the edge of a texture cell in cells of the domain; `sight` the number
  /// of steps that a path sees ahead, 0: a lifetime; `no_sight`: nothing is kept of any step.
  void begin_flow(const FlowVectors& vectors, double texel, int sight) {
    require_embedded();
    started_ = false;
    vectors_ = vectors;
    host_time_.reset();
    seed_ = parameters_.seed;
    texel_ = texel;
    ttl_ = std::clamp(parameters_.ttl, 1, max_ttl);
    sight_ = sight != 0 ? sight : ttl_;
    steady_ = !(vectors.end > vectors.start);
    exec_.arena().rewind(embedding_mark_);
    point_vectors_ = exec_.arena().template permanent<Vec3f>(points_.size());
    present_vectors_ = exec_.arena().template permanent<Vec3f>(points_.size());
    step_ = parameters_.first_step;
    const int whole = parameters_.warmup >= 0 ? -parameters_.warmup : -ttl_;  // where a whole run begins
    first_ = step_ > 0 ? std::max(whole, step_ - parameters_.lead_in) : whole;
    launched_ = first_ - whole;  // noise and rounding are those of the whole run
    output_ = output_means_ = nullptr;
  }

  /// Number of slots that hold displacements: those that a path can see.
  int slots() const { return sight_ == no_sight ? 0 : steady_ ? 1 : sight_ + 1; }
  int slot(int k) const { return steady_ ? 0 : (k - first_) % (sight_ + 1); }

  /// Speed below which nothing flows, in the units of the data.
  float least_speed() const { return 1e-6f * float(vectors_.reference_speed); }

  /// How displacements are rounded to whole cells in step `k`: -1/2..1/2 on each axis, spread evenly over few steps (an
  /// additive recurrence), so that slow particles move as far as fast ones in the mean. It is the same everywhere, so
  /// that a pattern keeps together.
  static Vec3f rounding_of(int k) {
    const auto spread = [k](double irrational) { return float(std::fmod(irrational * (k + 1), 1.0) - 0.5); };
    return {spread(0.8191725133961645), spread(0.6710436067037893), spread(0.5497004779019703)};
  }

  /// The slots that the first step sees, then the steps before the data's first.
  void warm_up() {
    for (int j = 0; j < slots(); ++j) fill(first_ + j);
    load_present(first_ - 1);
    started_ = true;
  }

  /// The steps of the warm-up that are left.
  void warm_up_to(int begin, const std::function<void()>& between) {
    const int whole = begin - first_;
    while (step_ < begin) {
      shows_ = step_ + 1 == begin;
      advance(step_);
      ++step_;
      exec_.tell_share(double(step_ - first_) / double(whole));
      if (between) between();
    }
    exec_.wait();
  }

  /// In `resume`, after `begin_flow`: time goes on where `before` is. The slots begin with the next step.
  void go_on_from(const FlowMethodOn& before) {
    step_ = first_ = before.step_;
    launched_ = before.launched_;
  }

  /// The surface cell of the flow before whose value each of the `n` surface cells takes, `no_cell` where there is
  /// none; the share of those that have one. `texel`, `texel_before`: edges of texture cells in cells of either domain.
  template <class Surface>
  double find_sources(const Surface& on, std::int64_t n, double texel, const FlowMethodOn& before,
                      const Surface& on_before, double texel_before, FlowCarry how, CellIndex* source) {
    const auto find = [&](const auto& origin) {
      using Origin = std::remove_cvref_t<decltype(origin)>;
      for_each_surface_cell_of(exec_, on, n,
                               FindSource<Surface, Origin>{on, on_before, origin, texel, texel_before, source});
    };
    if (how == FlowCarry::material) {
      if (before.triangles_ != triangles_) throw std::logic_error("a texture carried between other triangles");
      find(SameMaterial{mesh_, before.mesh_});
    } else {
      if (!before.shape_.made()) throw std::logic_error("a texture carried from a surface that does not move");
      const double cell = before.domain_.cell_size;
      find(ClosestMaterial{before.shape_.tree(), before.shape_.mesh(before.corners_.data()), before.mesh_,
                           domain_.cell_size / cell, (domain_.origin - before.domain_.origin) / cell,
                           carry_reach * texel_before, before.is_at_rest(0.01 * texel_before)});
    }
    return n > 0 ? double(exec_.reduce(n, std::uint64_t(0), HasSource{source}, Add{})) / double(n) : 0;
  }

  /// Whether no point has moved farther than `slack` from where it was embedded, in cells of the domain.
  bool is_at_rest(double slack) const {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (!(length(shape_.points()[i] - points_[i]) <= slack)) return false;
    return true;
  }

  template <class Value>
  void take(const CellIndex* source, const Array<Value>& from, const Array<Value>& to) {
    exec_.for_each(std::int64_t(to.size()), TakeFromSource<Value>{source, from.data(), to.data()});
  }

  /// Embeds what comes into sight at step `k`.
  void look_ahead(int k) {
    if (steady_) return;
    if (k > first_ && sight_ != no_sight) fill(k + sight_);
    load_present(k);
  }

  /// Draws the surface, where it has moved to if it has. `shown`: its texture; null: none.
  template <class Target>
  std::vector<std::uint8_t> draw_target(const Target& target, const float* shown, const RenderOptions& options,
                                        const Vec3d& dims) {
    if (!shape_.moved()) {
      RenderPixel<Target> pixel;
      pixel.scene.target = target;
      pixel.scene.shown = shown;
      return draw(pixel, options, dims);
    }
    RenderPixel<MovedTarget<Target>> pixel;
    pixel.scene.target = {target, mesh_, shape_.mesh(corners_.data()), shape_.tree()};
    pixel.scene.shown = shown;
    return draw(pixel, options, dims);
  }

  /// Draws what `pixel` casts into: sets its camera, light, colours and background, and runs it on every pixel. `dims`
  /// is the extent of the domain in cells. RGBA, row 0 at the top.
  template <class Pixel>
  std::vector<std::uint8_t> draw(Pixel& pixel, const RenderOptions& options, const Vec3d& dims) {
    Arena& arena = exec_.arena();
    Arena::Scope scope(arena);
    auto& scene = pixel.scene;
    std::vector<float> scalar(options.scalar.begin(), options.scalar.end());
    if (gathered_) gathered_->take_scalar(scalar);
    colour_scene(arena, options, scalar, scene);
    scene.mesh = shape_.moved() ? shape_.mesh(corners_.data()) : seen_;
    place_camera(options, domain_, dims, pixel);
    pixel.number = numbers_.size() ? numbers_.data() : nullptr;
    if (shape_.moved()) {  // perhaps out of the domain
      const Vec3d target = domain_.to_grid(options.camera.target);
      for (const Vec3d& p : shape_.points()) pixel.reach = std::max(pixel.reach, 1 + length(p - target));
    }
    Array<std::uint32_t> pixels = arena.template temporary<std::uint32_t>(std::size_t(pixel.width) * pixel.height);
    pixel.pixels = pixels.data();
    draw_among(exec_, ranks_, pixel, pixels, known_around_);
    std::vector<std::uint8_t> bytes(pixels.bytes());
    exec_.device().copy_to_host(bytes.data(), pixels.data(), bytes.size());
    return bytes;
  }

  /// For FlowValues; this object must outlive the result.
  DescribeCells describe_cells() const {
    std::vector<Vec3f> vectors = shape_.vectors();
    if (vectors.empty()) {
      vectors.resize(points_.size());
      fill_vectors(time(), vectors);
    }
    return {domain_,
            points_,
            corners_.download(),
            normals_.download(),
            vectors,
            shape_.moved(),
            shape_.points(),
            shape_.normals(),
            sheets_ ? second_sheet_.data() : nullptr,
            sheets_.shift};
  }

  /// Where the embedded shape has the material that is at `points` (world) now, in cells of the domain.
  std::vector<Vec3d> embedded_positions(std::span<const Vec3d> points) const {
    std::vector<Vec3d> positions;
    for (const Vec3d& p : points) positions.push_back(domain_.to_grid(p));
    if (!shape_.moved()) return positions;
    const std::vector<Vec3d>& now = shape_.points();
    const TriangleTree tree(now, shape_.triangles());
    for (Vec3d& p : positions) {
      const TriangleHit hit = *tree.closest(p);
      const Triangle& t = shape_.triangles()[hit.triangle];
      const Vec3d w = barycentric({now[t.a], now[t.b], now[t.c]}, hit.position);
      p = points_[t.a] * w.x + points_[t.b] * w.y + points_[t.c] * w.z;
    }
    return positions;
  }

  std::vector<float> download_frame(const float* frame, std::size_t n) const {
    std::vector<float> host(n);
    exec_.device().copy_to_host(host.data(), frame, n * sizeof(float));
    return host;
  }

  Executor<Backend>& exec_;
  const FlowParameters& parameters_;
  Ranks* ranks_;                          ///< null: this process is alone
  std::optional<MeshOfBricks> gathered_;  ///< of a mesh that came in shares
  double known_around_ = 0;               ///< else: cells around its own in which this one knows the values
  FlowDomain domain_;
  EmbeddingInfo info_;
  FlowVectors vectors_;
  bool embedded_ = false, started_ = false, steady_ = true, shows_ = true;
  int ttl_ = 4, sight_ = 1, step_ = 0, first_ = 0, launched_ = 0;
  double texel_ = 1;  ///< edge of a texture cell in cells of the domain
  std::uint32_t triangles_ = 0;
  std::size_t embedding_mark_ = 0;
  std::uint32_t seed_ = 0;
  float* output_ = nullptr;  ///< where the shown values go, too, besides the method's own array; null: nowhere

  std::vector<Vec3d> points_;  ///< in cells of the domain
  MeshView mesh_{};
  Array<Vec3d> device_points_;
  Array<Triangle> corners_;
  Array<Vec3f> normals_;
  Array<std::uint32_t> numbers_;  ///< of the triangles among those of all processes; empty: as here
  MovedShape<Backend> shape_;     ///< of a surface that moves

  /// Values come from no farther, in texture cells: as far as the band of the grid knows the surface.
  static constexpr double carry_reach = 18;

  SeparatedSheets sheets_;
  std::vector<std::uint8_t> second_sheet_;
  MeshView seen_{};  ///< what pictures show: as `mesh_`, but all triangles where they are
  TriangleBoxes boxes_;
  float* output_means_ = nullptr;  ///< where the means of blocks of shown values go; null: nowhere
  Array<Vec3f> present_vectors_;   ///< of the frame, one for each embedded point

 private:
  void fill_vectors(double time, std::vector<Vec3f>& vectors) const {
    if (gathered_) {
      std::vector<Vec3f> of_share(gathered_->share_points());
      vectors_.at(time, of_share);
      return gathered_->take(std::span<const Vec3f>(of_share), std::span<Vec3f>(vectors));
    }
    const std::size_t own = points_.size() - sheets_.source.size();
    vectors_.at(time, std::span(vectors).first(own));
    for (std::size_t i = own; i < vectors.size(); ++i) vectors[i] = vectors[sheets_.source[i - own]];
  }

  /// The same of all embedded points; those of the last time are kept, since a slot and a frame ask for them.
  std::span<const Vec3f> vectors_at(double time) {
    if (host_time_ != time) {
      host_vectors_.resize(points_.size());
      fill_vectors(time, host_vectors_);
      host_time_ = time;
    }
    return host_vectors_;
  }

  /// The vectors at the time of the frame that step `k` makes.
  void load_present(int k) {
    auto stage = exec_.stage("velocity");
    present_vectors_.upload(vectors_at(time_of(k + 1)));
  }

  void fill(int k) {
    auto stage = exec_.stage("velocity");
    point_vectors_.upload(vectors_at(time_of(k)));
    const SpeedScale scale{float(vectors_.reference_speed), float(parameters_.step_cells * texel_),
                           float(parameters_.speed_power), 2.0f};
    fill_slot(point_vectors_, scale, slot(k));
  }

  Array<Triangle> seen_corners_;
  Array<std::uint8_t> device_second_sheet_;
  Array<Vec3f> point_vectors_;
  std::vector<Vec3f> host_vectors_;
  std::optional<double> host_time_;  ///< of `host_vectors_`
};

}  // namespace nacre
