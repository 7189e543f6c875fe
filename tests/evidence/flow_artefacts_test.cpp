// Nacre: what the shown flow must not have: ridges that grow from step to step, chequers, streaks that do not move as
// the flow does.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <tuple>

#include "tests/evidence/legibility.hpp"
#include "tests/evidence/texture_measures.hpp"

namespace nacre {
namespace {

class FlowArtefacts : public testing::TestWithParam<const char*> {
 protected:
  FlowParameters at_resolution(int resolution) const {
    FlowParameters parameters;
    if (std::string(GetParam()) == "brick") parameters.method = EmbeddingKind::octree;
    parameters.resolution = resolution;
    return parameters;
  }
};

/// Power by frequency, 1 to 16 periods in a window of 33 cells.
using Spectrum = std::array<double, FlowWindow::reach>;

/// Adds that of the texture across its streaks, all over the surface.
void add_spectrum_across(const FlowValues& values, double cell, Spectrum& power) {
  constexpr int n = FlowWindow::side;
  const WindowCutter cutter(values, cell);
  for (const std::size_t position : chosen_positions(values.value.size(), 800)) {
    const auto window = cutter.cut(position);
    if (!window) continue;
    for (int x = 0; x < n; ++x)
      for (int f = 1; f <= FlowWindow::reach; ++f) {
        double c = 0, s = 0;
        for (int y = 0; y < n; ++y) {
          const double taper = 1 - std::cos(2 * std::numbers::pi * (y + 0.5) / n);
          const double angle = 2 * std::numbers::pi * f * y / n;
          c += taper * (*window)(x, y) * std::cos(angle);
          s += taper * (*window)(x, y) * std::sin(angle);
        }
        power[f - 1] += c * c + s * s;
      }
  }
}

Spectrum shares(const Spectrum& power) {
  const double sum = std::accumulate(power.begin(), power.end(), 0.0);
  Spectrum share;
  for (std::size_t f = 0; f < share.size(); ++f) share[f] = power[f] / sum;
  return share;
}

/// A texture that is fed back to itself for long picks a distance between its streaks, like a fingerprint's ridges. The
/// spectrum of few streaks is rough: four textures are looked at after 20 steps, one at four times up to 200.
TEST_P(FlowArtefacts, NoFingerprintAfterManySteps) {
  Spectrum early{}, late{};
  for (const std::uint32_t seed : {4u, 3u, 2u, 1u}) {
    FlowParameters parameters = at_resolution(96);
    parameters.seed = seed;
    FlowRun run("sphere", parameters);
    const double cell = run.pipeline->flow().embedding().cell_size;
    run.steps(20);
    add_spectrum_across(run.pipeline->flow().values(), cell, early);
    if (seed != 1) continue;
    run.steps(100);
    for (int part = 0; part < 4; ++part) {
      run.steps(20);
      add_spectrum_across(run.pipeline->flow().values(), cell, late);
    }
  }
  early = shares(early);
  late = shares(late);
  std::printf("power across streaks, step 20 and steps 140 to 200:");
  for (std::size_t f = 0; f < early.size(); ++f) std::printf(" %.4f/%.4f", early[f], late[f]);
  std::printf("\n");
  for (std::size_t f = 0; f < early.size(); ++f) EXPECT_LE(late[f], 1.25 * early[f] + 0.002) << f + 1 << " periods";
}

/// How much of a texture's power along the flow alternates from cell to cell: 1 in white noise. Runs of cells along an
/// axis of the lattice are looked at where the flow follows that axis; of the regions of 16^3 cells the worst counts.
double worst_alternation(const FlowValues& values, double cell) {
  using Key = std::tuple<int, int, int>;
  const auto key = [](const Int3& c) { return Key(c.x, c.y, c.z); };
  const Vec3d first = values.centre[0];
  const auto position = [&](std::size_t i) {
    const Vec3d q = (values.centre[i] - first) / cell;
    return Int3(int(std::lround(q.x)), int(std::lround(q.y)), int(std::lround(q.z)));
  };
  std::map<Key, std::size_t> at;
  for (std::size_t i = 0; i < values.value.size(); ++i) at[key(position(i))] = i;
  struct Sum {
    double alternating = 0;
    int runs = 0;
  };
  std::map<Key, Sum> region;
  constexpr int n = 8;
  for (std::size_t i = 0; i < values.value.size(); ++i) {
    const Vec3d d = normalized(Vec3d(values.velocity[i]));
    const Int3 start = position(i);
    for (int axis = 0; axis < 3; ++axis) {
      if (std::fabs(d[axis]) < 0.96) continue;
      double alternating = 0;
      int k = 0;
      for (; k < n; ++k) {
        Int3 c = start;
        c[axis] += k;
        const auto found = at.find(key(c));
        if (found == at.end()) break;
        const double v = values.value[found->second];
        alternating += k & 1 ? -v : v;
      }
      if (k < n) continue;
      const auto down = [](int x) { return int(std::floor(x / 16.0)); };
      Sum& here = region[{down(start.x), down(start.y), down(start.z)}];
      here.alternating += alternating * alternating / n;
      ++here.runs;
    }
  }
  double whole = 0;  // the texture's power; that of a few runs says little
  for (const float v : values.value) whole += (double(v) - 0.5) * (double(v) - 0.5);
  whole /= double(values.value.size());
  double worst = 0;
  int regions = 0;
  for (const auto& [where, sum] : region)
    if (sum.runs >= 60) {
      worst = std::max(worst, sum.alternating / sum.runs / whole);
      ++regions;
    }
  EXPECT_GT(regions, 10);
  return worst;
}

TEST_P(FlowArtefacts, NoChequers) {
  for (const bool slow_too : {false, true}) {
    FlowParameters parameters = at_resolution(192);
    if (slow_too) parameters.speed_power = 0.3, parameters.ttl = 6;
    FlowRun run("torus", parameters);
    run.steps(20);
    FlowValues values = run.pipeline->flow().values();
    const double cell = run.pipeline->flow().embedding().cell_size;
    const double worst = worst_alternation(values, cell);
    for (std::size_t i = 0; i < values.value.size(); ++i) values.value[i] = uniform_random(3, std::uint32_t(i), 0);
    const double noise = worst_alternation(values, cell);
    std::printf("alternation along the flow, speed power %.1f: %.3f in the worst region; white noise %.3f\n",
                parameters.speed_power, worst, noise);
    EXPECT_GT(noise, 1) << "the measure itself";
    EXPECT_LE(worst, 0.3);
  }
}

/// Points of the unit sphere at distances from the axis between `low` and `high`, turned about it.
std::vector<Vec3d> ring_points(int n, double low, double high, double angle) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double r = std::sqrt(low * low + (high * high - low * low) * (i + 0.5) / n), a = i * 2.399963 + angle;
    points.push_back({r * std::cos(a), r * std::sin(a), (i & 1 ? 1 : -1) * std::sqrt(1 - r * r)});
  }
  return points;
}

/// Frame k looks most like frame k + 1 when that is turned back by what the flow turns in a step. Near the poles, where
/// it moves half a cell to two cells, streaks are so much longer than a step that frames are as much alike at rest:
/// said, not judged.
TEST_P(FlowArtefacts, StreaksMoveWithTheFlow) {
  FlowRun run("sphere-rotation", at_resolution(256));
  run.steps(8);
  const double expected = run.pipeline->parameters.step_cells * run.pipeline->flow().embedding().cell_size /
                          run.vectors->statistics().percentile_98;
  const double slow = 2 / run.pipeline->parameters.step_cells;
  const struct {
    const char* what;
    double low, high;
  } parts[] = {{"everywhere", 0, 0.999}, {"slow", slow / 4, slow}};
  const int points = 6000, frames = 4;
  std::map<std::string, std::vector<double>> likeness;
  for (int frame = 0; frame < frames; ++frame) {
    std::map<std::string, std::vector<float>> before;
    for (const auto& part : parts)
      before[part.what] = run.pipeline->flow().sample_shown(ring_points(points, part.low, part.high, 0.1 * frame));
    run.steps(1);
    for (const auto& part : parts) {
      std::vector<double>& sum = likeness[part.what];
      sum.resize(41);
      for (int k = 0; k <= 40; ++k)
        sum[k] += correlation(before[part.what], run.pipeline->flow().sample_shown(ring_points(
                                                     points, part.low, part.high, 0.1 * frame + 0.05 * k * expected))) /
                  frames;
    }
  }
  for (const auto& [what, c] : likeness) {
    const auto best = int(std::max_element(c.begin(), c.end()) - c.begin());
    std::printf("motion %s: best at %.2f of v dt, correlation %.3f, at rest %.3f, at twice %.3f\n", what.c_str(),
                0.05 * best, c[best], c[0], c[40]);
    if (what == "everywhere") {
      EXPECT_NEAR(0.05 * best, 1, 0.101);
    }
    EXPECT_GT(c[best], 0.5) << what;
  }
}

INSTANTIATE_TEST_SUITE_P(On, FlowArtefacts, testing::Values("grid", "brick"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace nacre
