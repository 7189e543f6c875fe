// Nacre: the flow pipeline on either backend; instantiated by flow_pipeline_cpu.cpp and flow_pipeline_cuda.cu.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "compute/flow/advect.hpp"
#include "compute/flow/filter.hpp"
#include "compute/flow/velocity.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

namespace detail {
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
class FlowPipelineOf final : public FlowPipeline {
 public:
  explicit FlowPipelineOf(Device& device) : exec_(device) {}

  void embed(const FlowMesh& mesh) override {
    Arena& arena = exec_.arena();
    arena.rewind(0);
    embedded_ = started_ = false;
    domain_ = make_domain(mesh, parameters);
    require_memory(mesh, parameters, arena.free_bytes());
    refine_ = parameters.refine;
    triangles_ = std::uint32_t(mesh.triangles.size());
    {
      auto stage = exec_.stage("embed");
      upload(mesh);
      coarse_ = build_closest_point_grid(exec_, mesh_, triangles_, domain_.bricks, parameters.subcells,
                                         float(domain_.radius));
    }
    {
      auto stage = exec_.stage("refine");
      fine_ = build_refined_grid(exec_, mesh_, triangles_, coarse_, refine_);
    }
    describe();
    embedding_mark_ = arena.mark();
    embedded_ = true;
  }

  void start(const FlowVectors& vectors) override {
    require_embedded();
    vectors_ = vectors;
    ttl_ = std::clamp(parameters.ttl, 1, max_ttl);
    steady_ = !(vectors.end > vectors.start);
    Arena& arena = exec_.arena();
    arena.rewind(embedding_mark_);
    const std::size_t n = fine_.surface_cells;
    point_vectors_ = arena.permanent<Vec3f>(points_.size());
    for (int j = 0; j <= (steady_ ? 0 : ttl_); ++j) slots_[j] = arena.permanent<Float4>(coarse_.cells);
    for (int j = 0; j < ttl_; ++j) {
      sums_[j] = arena.permanent<std::uint64_t>(n);
      sums_[j].fill_bytes(0);
    }
    axis_ = arena.permanent<std::uint8_t>(n);
    carried_ = arena.permanent<float>(n);
    value_ = arena.permanent<float>(n);
    ahead_ = arena.permanent<float>(n);
    detail_ = arena.permanent<float>(n);
    for (Array<Float4>& moments : moments_) {
      moments = arena.permanent<Float4>(coarse_.cells);
      moments.fill_bytes(0);  // blurring never writes the cells without a block
    }
    shown_ = arena.permanent<float>(n);
    exec_.for_each(n, FillNoise{parameters.seed, carried_.data()});
    exec_.for_each(n, FillNoise{parameters.seed, value_.data()});
    exec_.for_each(n, FillNoise{parameters.seed, ahead_.data()});
    step_ = launched_ = 0;
    first_ = parameters.warmup >= 0 ? -parameters.warmup : -ttl_;
    fill_slots();
    started_ = true;
    show();
    for (int k = first_; k < 0; ++k) advance(k);
  }

  void step() override {
    if (!started_) throw Error("step before start");
    advance(step_);
    ++step_;
  }

  double time() const override { return time_of(step_); }

  std::vector<float> shown() const override { return shown_.download(); }

  std::vector<std::uint8_t> render(const RenderOptions& options) override;
  FlowValues values() const override;
  std::vector<float> sample_shown(std::span<const Vec3d> points) override;

  const EmbeddingInfo& embedding() const override { return info_; }
  StageTimers& timers() override { return exec_.timers(); }
  std::size_t peak_bytes() const override { return const_cast<Executor<Backend>&>(exec_).arena().peak_bytes(); }
  void watch(const std::atomic<bool>* stop) override { exec_.watch(stop); }

 private:
  void require_embedded() const {
    if (!embedded_) throw Error("no surface embedded");
  }

  void upload(const FlowMesh& mesh) {
    Arena& arena = exec_.arena();
    std::vector<Vec3d> points(mesh.points.size());
    std::transform(mesh.points.begin(), mesh.points.end(), points.begin(),
                   [&](const Vec3d& p) { return domain_.to_grid(p); });
    points_ = arena.permanent_copy<Vec3d>(points);
    corners_ = arena.permanent_copy<Triangle>(mesh.triangles);
    normals_ = arena.permanent_copy<Vec3f>(mesh.corner_normals);
    mesh_ = {points_.data(), corners_.data(), normals_.data()};
  }

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

  /// Time of the data at the beginning of step `k`; it stands still before the first step and after the last.
  double time_of(int k) const {
    const double share = std::clamp(double(k) / std::max(1, parameters.steps), 0.0, 1.0);
    return vectors_.start + (vectors_.end - vectors_.start) * share;
  }

  /// Embeds the vectors of the beginning of step `k` into its slot.
  void fill_slot(int k) {
    auto stage = exec_.stage("velocity");
    host_vectors_.resize(points_.size());
    vectors_.at(time_of(k), host_vectors_);
    point_vectors_.upload(host_vectors_);
    const SpeedScale scale{float(vectors_.reference_speed), float(parameters.step_cells / refine_),
                           float(parameters.speed_power), 2.0f};
    exec_.for_each(coarse_.cells,
                   EmbedVelocity{mesh_, coarse_.view(), point_vectors_.data(), scale, 3.5f, slot(k).data()});
  }

  Array<Float4>& slot(int k) { return slots_[steady_ ? 0 : (k - first_) % (ttl_ + 1)]; }

  void fill_slots() {
    for (int j = 0; j <= (steady_ ? 0 : ttl_); ++j) fill_slot(first_ + j);
  }

  void advance(int k) {
    if (!steady_ && k > first_) fill_slot(k + ttl_);
    ReleaseParticles particles;
    particles.field.grid = coarse_.view();
    particles.field.steady = steady_;
    for (int j = 0; j <= ttl_; ++j) particles.field.slot[j] = slot(k + j).data();
    particles.texture = fine_.view(coarse_.view());
    particles.carried = carried_.data();
    particles.ttl = ttl_;
    for (int j = 0; j < ttl_; ++j) particles.sums[j] = sums_[(k - first_ + j) % ttl_].data();
    {
      auto stage = exec_.stage("advect");  // with the deposits: a particle draws while it moves
      exec_.for_each(fine_.surface_cells, particles);
    }
    Array<std::uint64_t>& done = sums_[(k - first_) % ttl_];
    {
      auto stage = exec_.stage("deposit");
      exec_.for_each(fine_.surface_cells, PathAxis{fine_.view(coarse_.view()), slot(k).data(), axis_.data()});
      antialias(done, value_, 1, value_);
      done.fill_bytes(0);
      // A frame shows the middle of its step, but the particles of the next step start at its end. So they carry the mean
      // of this frame and of what older particles have already left in the next one; else the texture lags the flow.
      antialias(sums_[(k + 1 - first_) % ttl_], value_, 0.5f, ahead_);
    }
    show();
  }

  /// Contrast for the eye, sharpening and jitter for the next step.
  void show() {
    auto stage = exec_.stage("filter");
    const std::int64_t n = fine_.surface_cells;
    const RefinedGridView texture = fine_.view(coarse_.view());
    const auto moments_of = [&](const Array<float>& a) {
      return exec_.reduce(n, Moments{}, MomentsOf{a.data()}, AddMoments{});
    };
    const Moments now = moments_of(value_), next = moments_of(ahead_);
    const float deviation = std::max(now.deviation(n), 1e-4f);
    const Float4* moments = gather_moments(texture);
    exec_.for_each(n, Equalise{texture, value_.data(), ahead_.data(), moments, now.mean(n), deviation, next.mean(n),
                               std::max(next.deviation(n), 1e-4f) / deviation, float(parameters.equalise),
                               float(parameters.contrast), shown_.data(), detail_.data()});
    exec_.for_each(n, SharpenAndJitter{texture, detail_.data(), float(parameters.sharpen), float(parameters.jitter),
                                       parameters.seed, std::uint32_t(++launched_), carried_.data()});
  }

  /// Local moments of `value_` over a window of about a dozen texture cells, in one of two buffers.
  const Float4* gather_moments(const RefinedGridView& texture) {
    const Array<Float4>*from = &moments_[0], *to = &moments_[1];
    exec_.for_each(coarse_.cells, LocalMoments{texture, value_.data(), from->data()});
    const int passes = refine_ == 1 ? 8 : refine_ == 2 ? 4 : refine_ <= 4 ? 1 : 0;
    for (int k = 0; k < passes; ++k) {
      exec_.for_each(fine_.block_cell.size(), BlurMoments{texture, from->data(), to->data()});
      std::swap(from, to);
    }
    return from->data();
  }

  void antialias(const Array<std::uint64_t>& sums, const Array<float>& otherwise, float share, Array<float>& value) {
    exec_.for_each(fine_.surface_cells, Antialias{fine_.view(coarse_.view()), sums.data(), axis_.data(),
                                                  otherwise.data(), share, value.data()});
  }

  Executor<Backend> exec_;
  FlowDomain domain_;
  EmbeddingInfo info_;
  FlowVectors vectors_;
  bool embedded_ = false, started_ = false, steady_ = true;
  int refine_ = 4, ttl_ = 4;
  int step_ = 0, first_ = 0, launched_ = 0;
  std::uint32_t triangles_ = 0;
  std::size_t embedding_mark_ = 0;

  MeshView mesh_{};
  Array<Vec3d> points_;
  Array<Triangle> corners_;
  Array<Vec3f> normals_;
  ClosestPointGrid coarse_;
  RefinedGrid fine_;
  Array<Vec3f> point_vectors_;
  std::vector<Vec3f> host_vectors_;
  Array<Float4> slots_[max_ttl + 1];
  Array<std::uint64_t> sums_[max_ttl];
  Array<std::uint8_t> axis_;
  Array<float> carried_, value_, ahead_, detail_, shown_;
  Array<Float4> moments_[2];
};

template <class Backend>
std::vector<std::uint8_t> FlowPipelineOf<Backend>::render(const RenderOptions& options) {
  require_embedded();
  auto stage = exec_.stage("render");
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  RenderPixel pixel;
  const auto linear = [](const std::array<float, 3>& c) { return to_linear({c[0], c[1], c[2]}); };
  Scene& scene = pixel.scene;
  scene.grid = coarse_.view();
  scene.texture = fine_.view(coarse_.view());
  scene.mesh = mesh_;
  scene.shown = started_ && options.texture ? shown_.data() : nullptr;
  if (!options.scalar.empty()) {
    Array<float> scalar = arena.temporary<float>(options.scalar.size());
    scalar.upload(options.scalar);
    std::vector<Float4> table;
    for (const auto& c : options.colours) table.push_back({linear(c).x, linear(c).y, linear(c).z, 1});
    Array<Float4> colours = arena.temporary<Float4>(table.size());
    colours.upload(table);
    scene.scalar = scalar.data();
    scene.colours = colours.data();
    scene.low = float(options.low);
    scene.high = options.high > options.low ? float(options.high) : std::nextafter(float(options.low), 1e30f);
  }
  scene.background = linear(options.background);
  scene.background_alpha = options.transparent ? 0.0f : 1.0f;

  const Camera& camera = options.camera;
  GridCamera& view = pixel.camera;
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  const double half = 0.5 * camera.height / domain_.cell_size;
  view.eye = domain_.to_grid(camera.eye);
  view.forward = camera.forward();
  view.right = right * (half * options.width / options.height);
  view.up = up * half;
  view.distance = length(camera.target - camera.eye) / domain_.cell_size;
  view.orthographic = camera.orthographic;
  scene.light = Vec3f(normalized(-view.forward + right * 0.35 + up * 0.55));
  // A ball around the target that holds the grid, and what the camera sees of it.
  const Vec3d dims(domain_.bricks * Int3(parameters.subcells));
  pixel.reach = length(dims) + length(domain_.to_grid(camera.target) - dims * 0.5) + half * 2;
  pixel.width = options.width;
  pixel.height = options.height;
  pixel.samples = std::max(1, options.samples);
  const std::size_t n = std::size_t(options.width) * options.height;
  Array<std::uint32_t> pixels = arena.temporary<std::uint32_t>(n);
  pixel.pixels = pixels.data();
  exec_.for_each(std::int64_t(n), pixel);
  std::vector<std::uint8_t> bytes(4 * n);
  exec_.device().copy_to_host(bytes.data(), pixels.data(), bytes.size());
  return bytes;
}

template <class Backend>
FlowValues FlowPipelineOf<Backend>::values() const {
  const std::size_t n = fine_.surface_cells;
  FlowValues values;
  const std::vector<float> value = value_.download();
  const std::vector<Float4> seed = fine_.seed.download();
  const std::vector<std::uint32_t> place = fine_.place.download(), triangle = fine_.seed_triangle.download();
  const std::vector<std::uint32_t> block_cell = fine_.block_cell.download();
  const std::vector<std::uint64_t> code = coarse_.brick_code.download();
  const std::vector<Vec3d> points = points_.download();
  const std::vector<Triangle> corners = corners_.download();
  const std::vector<Vec3f> normals = normals_.download();
  std::vector<Vec3f> vectors(points.size());
  vectors_.at(time(), vectors);
  ClosestPointGridView grid = coarse_.view();
  grid.brick_code = code.data();
  RefinedGridView texture = fine_.view(grid);
  texture.block_cell = block_cell.data();
  const MeshView mesh{points.data(), corners.data(), normals.data()};
  values.value = value;
  values.centre.resize(n);
  values.closest_point.resize(n);
  values.velocity.resize(n);
  values.normal.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    const Vec3d centre = Vec3d(texture.texel_cell(place[s])) + Vec3d(0.5);
    const Vec3d surface = (centre + Vec3d(seed[s].x, seed[s].y, seed[s].z)) / double(refine_);
    const std::uint32_t t = triangle[s];
    const Vec3f w(barycentric(mesh.corners(t), surface));
    const Triangle c = corners[t];
    const Vec3f v = vectors[c.a] * w.x + vectors[c.b] * w.y + vectors[c.c] * w.z, normal = mesh.normal(t, w);
    values.centre[s] = domain_.to_world(centre / double(refine_));
    values.closest_point[s] = domain_.to_world(surface);
    values.normal[s] = normal;
    values.velocity[s] = v - normal * dot(normal, v);
  }
  return values;
}

template <class Backend>
std::vector<float> FlowPipelineOf<Backend>::sample_shown(std::span<const Vec3d> points) {
  Arena& arena = exec_.arena();
  Arena::Scope scope(arena);
  std::vector<Vec3f> host;
  for (const Vec3d& p : points) host.push_back(Vec3f(domain_.to_grid(p) * double(refine_)));
  Array<Vec3f> places = arena.temporary<Vec3f>(host.size());
  places.upload(host);
  Array<float> value = arena.temporary<float>(host.size());
  exec_.for_each(std::int64_t(host.size()),
                 detail::SampleShown{fine_.view(coarse_.view()), shown_.data(), places.data(), value.data()});
  return value.download();
}

}  // namespace nacre
