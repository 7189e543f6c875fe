// Nacre: tests that steps and iterations make no memory: the device's blocks stay, the host's few do not grow with the
// work.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/compute/pipeline/choose_embedding.hpp"
#include "tests/evidence/exact_bodies.hpp"
#include "tests/evidence/texture_measures.hpp"

namespace {

std::atomic<long> made{0};

void* counted_or_null(std::size_t bytes) {
  made.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(bytes > 0 ? bytes : 1);
}

void* counted(std::size_t bytes) {
  if (void* block = counted_or_null(bytes)) return block;
  throw std::bad_alloc();
}

}  // namespace

// Of this program only.
void* operator new(std::size_t bytes) { return counted(bytes); }
void* operator new[](std::size_t bytes) { return counted(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return counted_or_null(bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return counted_or_null(bytes); }
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }

namespace nacre::test {
namespace {

/// Blocks that `work` makes on the host.
template <class Work>
long made_by(const Work& work) {
  const long before = made.load();
  work();
  return made.load() - before;
}

class StepsAllocateNothing : public testing::TestWithParam<const char*> {
 protected:
  /// Of four steps of steady flow, after two.
  static long host_blocks(int resolution) {
    FlowParameters parameters;
    test::choose_embedding(parameters, GetParam());
    parameters.resolution = resolution;
    FlowRun run("torus", parameters, 2);
    run.steps(2);
    return made_by([&] { run.steps(4); });  // a device's block is noted down in one of the host's
  }
};

TEST_P(StepsAllocateNothing, OfTheFlow) {
  const long coarse = host_blocks(48), fine = host_blocks(192);
  std::printf("%s: %ld and %ld blocks on the host in four steps\n", GetParam(), coarse, fine);
  EXPECT_LT(fine, 20) << "sixteen times the cells";
}

INSTANTIATE_TEST_SUITE_P(On, StepsAllocateNothing, testing::Values("grid", "brick", "thesis"));

TEST(IterationsAllocateNothing, OfTheParticles) {
  for (const char* solver : {"tree", "redblack"}) {
    const auto blocks = [&](int iterations) {
      const auto device = make_cpu_device(2);
      const auto pipeline = make_mesh_pipeline(*device);
      pipeline->parameters.solver = solver;
      pipeline->parameters.iterations = iterations;
      pipeline->parameters.stagnation = 0;
      pipeline->load(scalar_volume(cube, ball(middle, 12.3)));
      pipeline->build_fields();
      const long made = made_by([&] { pipeline->relax(); });
      EXPECT_GT(pipeline->particles().points.size(), 1000u);
      return made;
    };
    const long few = blocks(10), many = blocks(30);
    std::printf("%s: %ld blocks on the host in 10 iterations, %ld in 30\n", solver, few, many);
    EXPECT_LT(many - few, 20 * 15) << "of twenty iterations of 2,000 particles";
  }
}

}  // namespace
}  // namespace nacre::test
