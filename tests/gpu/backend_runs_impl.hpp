// Nacre: BackendRuns on either backend; instantiated by backend_runs_cpu.cpp and backend_runs_cuda.cu.
#pragma once

#include <algorithm>
#include <atomic>
#include <utility>

#include "compute/device/random.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "tests/gpu/backend_runs.hpp"

namespace nacre::gpu_tests {

struct RandomBits {
  std::uint32_t* out;
  NACRE_HD void operator()(std::int64_t i) const { out[i] = philox(std::uint32_t(i), 0, 7).a; }
};

/// How often CUDA made a graph, and did not update it, for a repeated part.
template <class Backend>
long graphs_made(const Steps& steps);

struct RandomNumber {
  std::uint64_t* out;
  NACRE_HD void operator()(std::int64_t i) const { out[i] += philox(std::uint32_t(i), 0, 7).a; }
};

struct NumberAt {
  const std::uint64_t* in;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return in[i]; }
};

struct CountByRemainder {
  int buckets;
  std::uint64_t* count;
  NACRE_HD void operator()(std::int64_t i) const { atomic_add(count + i % buckets, std::uint64_t(i) + 1); }
};

struct FlagEvery {
  std::uint32_t every;
  std::uint32_t* out;
  NACRE_HD void operator()(std::int64_t i) const { out[i] = i % every == 0; }
};

struct Widen {
  const std::uint32_t* in;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return in[i]; }
};

struct Add {
  NACRE_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

struct ValueAt {
  const float* in;
  NACRE_HD float operator()(std::int64_t i) const { return in[i]; }
};

struct Larger {
  NACRE_HD float operator()(float a, float b) const { return a > b ? a : b; }
};

template <class Backend>
class BackendRunsOf final : public BackendRuns {
 public:
  explicit BackendRunsOf(Device& device) : exec_(device) {}

  std::vector<std::uint32_t> random_bits(std::int64_t n) override {
    Arena::Scope scope(arena());
    Array<std::uint32_t> out = arena().template temporary<std::uint32_t>(n);
    out.fill_bytes(0xcd);
    exec_.for_each(n, RandomBits{out.data()});
    return out.download();
  }

  std::vector<std::uint64_t> count_by_remainder(std::int64_t n, int buckets) override {
    Arena::Scope scope(arena());
    Array<std::uint64_t> count = arena().template temporary<std::uint64_t>(buckets);
    count.fill_bytes(0);
    exec_.for_each(n, CountByRemainder{buckets, count.data()});
    return count.download();
  }

  std::vector<std::uint32_t> scan(std::span<const std::uint32_t> in, bool in_place) override {
    return scan_of(in, in_place);
  }
  std::vector<std::uint64_t> scan(std::span<const std::uint64_t> in, bool in_place) override {
    return scan_of(in, in_place);
  }

  std::pair<std::uint32_t, std::uint32_t> scan_flags(std::int64_t n, std::uint32_t every) override {
    Arena::Scope scope(arena());
    Array<std::uint32_t> flags = arena().template temporary<std::uint32_t>(n);
    exec_.for_each(n, FlagEvery{every, flags.data()});
    const std::uint32_t sum = exec_.exclusive_scan(flags.data(), flags.data(), n);
    return {flags.download(n - 1, 1)[0], sum};
  }

  std::vector<std::uint64_t> sort(std::span<const std::uint64_t> keys) override {
    Arena::Scope scope(arena());
    Array<std::uint64_t> sorted = uploaded(keys);
    exec_.sort(sorted.data(), std::int64_t(keys.size()));
    return sorted.download();
  }

  std::uint64_t sum(std::span<const std::uint32_t> in) override {
    Arena::Scope scope(arena());
    return exec_.reduce(std::int64_t(in.size()), std::uint64_t(0), Widen{uploaded(in).data()}, Add{});
  }

  float maximum(std::span<const float> in) override {
    Arena::Scope scope(arena());
    return exec_.reduce(std::int64_t(in.size()), -1.0f, ValueAt{uploaded(in).data()}, Larger{});
  }

  std::vector<std::vector<std::uint64_t>> repeat(std::span<const std::int64_t> sizes) override {
    std::vector<std::vector<std::uint64_t>> results;
    for (const std::int64_t n : sizes) {
      Arena::Scope scope(arena());
      const Array<std::uint64_t> out = arena().template temporary<std::uint64_t>(n + 1);
      exec_.repeat(steps_, [&] {
        auto stage = exec_.stage("repeat");
        exec_.fill(out, 0);
        exec_.for_each(n, RandomNumber{out.data()});
        exec_.reduce_into(out.data() + n, n, std::uint64_t(0), NumberAt{out.data()}, Add{});
        exec_.scan(out.data(), out.data(), n);
      });
      results.push_back(out.download());
    }
    return results;
  }

  long graphs_made() const override { return gpu_tests::graphs_made<Backend>(steps_); }

  int stop_inside(int calls) override {
    Arena::Scope scope(arena());
    const Array<std::uint64_t> out = arena().template temporary<std::uint64_t>(1000);
    std::atomic<bool> stop = false;
    exec_.watch(&stop);
    int interrupted = 0;
    for (int call = 0; call < calls; ++call) {
      stop = false;
      try {
        exec_.repeat(steps_, [&] {
          auto stage = exec_.stage("stopped");
          for (int k = 0; k < 10; ++k) {
            if (k == 5) stop = true;
            exec_.for_each(1000, RandomNumber{out.data()});
          }
        });
      } catch (const Interrupted&) {
        ++interrupted;
      }
    }
    exec_.watch(nullptr);
    return interrupted;
  }

  StageTimers timers() override { return exec_.timers(); }

  HostEmbedding embed(const FlowMesh& mesh, const FlowParameters& parameters) override;

 private:
  Arena& arena() { return exec_.arena(); }

  template <class T>
  Array<T> uploaded(std::span<const T> host) {
    Array<T> array = arena().template temporary<T>(host.size());
    array.upload(host);
    return array;
  }

  template <class T>
  std::vector<T> scan_of(std::span<const T> in, bool in_place) {
    Arena::Scope scope(arena());
    Array<T> from = uploaded(in), to = in_place ? from : arena().template temporary<T>(in.size());
    const T sum = exec_.exclusive_scan(from.data(), to.data(), std::int64_t(in.size()));
    std::vector<T> out = to.download();
    out.push_back(sum);
    return out;
  }

  Executor<Backend> exec_;
  Steps steps_;
};

template <class Backend>
HostEmbedding BackendRunsOf<Backend>::embed(const FlowMesh& mesh, const FlowParameters& parameters) {
  const FlowDomain domain = make_domain(mesh, parameters);
  std::vector<Vec3d> in_grid(mesh.points.size());
  std::transform(mesh.points.begin(), mesh.points.end(), in_grid.begin(),
                 [&](const Vec3d& p) { return domain.to_grid(p); });
  const std::size_t mark = arena().mark();
  const Array<Vec3d> points = arena().template permanent_copy<Vec3d>(in_grid);
  const Array<Triangle> corners = arena().template permanent_copy<Triangle>(mesh.triangles);
  const Array<Vec3f> normals = arena().template permanent_copy<Vec3f>(mesh.corner_normals);
  const MeshView view{points.data(), corners.data(), normals.data()};
  const auto triangles = std::uint32_t(mesh.triangles.size());
  const ClosestPointGrid coarse =
      build_closest_point_grid(exec_, view, triangles, domain.bricks, parameters.subcells, float(domain.radius));
  const RefinedGrid fine = build_refined_grid(exec_, view, triangles, coarse, parameters.refine);
  HostEmbedding host{coarse.brick_code.download(), coarse.offset.download(),   coarse.triangle.download(),
                     fine.texel.download(),        fine.block_cell.download(), fine.position.download(),
                     fine.neighbour.download(),    fine.seed.download()};
  arena().rewind(mark);
  return host;
}

}  // namespace nacre::gpu_tests
