// Nacre: tests of flow runs of the library that several processes share: they give what one process gives.
#include "include/nacre/processes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "include/nacre/flow.hpp"
#include "include/nacre/mesh.hpp"
#include "tests/api/thread_processes.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// Flow around a ball, about an axis that is none of the lattice's.
SurfaceFlow ball() {
  SurfaceFlow flow;
  constexpr unsigned n = 24, m = 12;
  flow.points.push_back({0, 0, 1});
  for (unsigned j = 1; j < m; ++j)
    for (unsigned i = 0; i < n; ++i) {
      const double u = 2 * M_PI * i / n, v = M_PI * j / m;
      flow.points.push_back({std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v)});
    }
  flow.points.push_back({0, 0, -1});
  const auto at = [](unsigned j, unsigned i) { return 1 + (j - 1) * n + i % n; };
  const auto last = unsigned(flow.points.size() - 1);
  for (unsigned i = 0; i < n; ++i) {
    flow.triangles.push_back({0, at(1, i), at(1, i + 1)});
    for (unsigned j = 1; j + 1 < m; ++j) {
      flow.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      flow.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
    flow.triangles.push_back({at(m - 1, i), last, at(m - 1, i + 1)});
  }
  const std::vector<std::array<double, 3>> points = flow.points;
  flow.vectors = [points](std::size_t, std::span<float> to) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [x, y, z] = points[i];
      to[3 * i] = float(0.3 * z - y), to[3 * i + 1] = float(x), to[3 * i + 2] = float(-0.3 * x);
    }
  };
  return flow;
}

const KnobValues knobs{{"method", "octree"}, {"resolution", 96}, {"steps", 2},
                       {"warmup", 2},        {"width", 160},     {"height", 120}};

struct Results {
  std::vector<std::uint8_t> pixels;
  std::vector<float> values, samples;
  std::vector<std::array<double, 3>> centres;
  std::string report;
};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Of each process. `folder`: for values.vtp and pieces.pvtp.
std::vector<Results> results_of(int count, const fs::path& folder) {
  std::vector<Results> all(static_cast<std::size_t>(count));
  fs::create_directories(folder);
  on_processes(count, [&](Processes& processes) {
    try {
      RunOptions options;
      options.processes = &processes;
      Flow flow(ball(), knobs, options);
      while (flow.step()) continue;
      Results& own = all[std::size_t(processes.rank())];
      own.pixels = flow.picture().pixels;
      FlowCells cells = flow.cells();
      own.values = std::move(cells.value);
      own.centres = std::move(cells.centre);
      std::vector<std::array<double, 3>> points = ball().points;
      own.samples = flow.sample(points);
      flow.save(folder / "values.vtp");
      flow.save(folder / "pieces.pvtp");
      own.report = flow.report();
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  });
  return all;
}

TEST(FlowOfSeveralProcesses, GivesWhatOneProcessGives) {
  const fs::path folder = fs::path(testing::TempDir()) / "nacre_processes";
  const Results one = results_of(1, folder / "1")[0];
  ASSERT_FALSE(one.values.empty());
  for (const int count : {2, 3, 5}) {
    const fs::path own_folder = folder / std::to_string(count);
    const std::vector<Results> all = results_of(count, own_folder);
    std::vector<float> values;
    std::vector<std::array<double, 3>> centres;
    for (const Results& each : all) {
      EXPECT_EQ(each.pixels, one.pixels) << count;
      EXPECT_EQ(each.samples, one.samples) << count;
      values.insert(values.end(), each.values.begin(), each.values.end());
      centres.insert(centres.end(), each.centres.begin(), each.centres.end());
    }
    EXPECT_EQ(values, one.values) << count;
    EXPECT_EQ(centres, one.centres) << count;
    EXPECT_EQ(content(own_folder / "values.vtp"), content(folder / "1" / "values.vtp")) << count;
    for (int k = 0; k < count; ++k)
      EXPECT_NE(content(own_folder / ("pieces_" + std::to_string(k) + ".vtp")).find("Nacre origin"), std::string::npos);
    EXPECT_NE(content(own_folder / "pieces.pvtp").find("Nacre origin"), std::string::npos);
    EXPECT_NE(all[0].report.find("\"count\": " + std::to_string(count)), std::string::npos);
  }
  fs::remove_all(folder);
}

/// What each of two processes says that cannot make the run; `change(rank, flow, knobs)` makes it wrong.
std::vector<std::string> refusals(const std::function<void(int, SurfaceFlow&, KnobValues&)>& change) {
  std::vector<std::string> said(2);
  on_processes(2, [&](Processes& processes) {
    SurfaceFlow flow = ball();
    KnobValues own = knobs;
    change(processes.rank(), flow, own);
    RunOptions options;
    options.processes = &processes;
    try {
      Flow(std::move(flow), own, options).step();
    } catch (const Error& error) {
      said[std::size_t(processes.rank())] = error.what();
    }
  });
  return said;
}

TEST(FlowOfSeveralProcesses, IsRefusedOnAllOfThem) {
  for (const std::string& said : refusals([](int, SurfaceFlow&, KnobValues& own) { own["method"] = "grid"; }))
    EXPECT_NE(said.find("octree"), std::string::npos) << said;
  for (const std::string& said : refusals([](int rank, SurfaceFlow&, KnobValues&own) { own["seed"] = 1 + rank; }))
    EXPECT_NE(said.find("another input"), std::string::npos) << said;
  for (const std::string& said : refusals([](int rank, SurfaceFlow&flow, KnobValues&) {
         if (rank == 1) flow.points[3][0] += 0.01;
       }))
    EXPECT_NE(said.find("another input"), std::string::npos) << said;
  for (const std::string& said : refusals([](int, SurfaceFlow&flow, KnobValues&) {
         const auto points = flow.points;
         flow.times = {0, 1};
         flow.positions = [points](std::size_t step, std::span<double> to) {
           for (std::size_t i = 0; i < to.size(); ++i) to[i] = points[i / 3][i % 3] * (1 + 0.1 * double(step));
         };
       }))
    EXPECT_NE(said.find("moves"), std::string::npos) << said;
}

TEST(FlowOfSeveralProcesses, NeedsARankThatIsThere) {
  struct Beyond final : Processes {
    int rank() const override { return 2; }
    int count() const override { return 2; }
    void sum(std::span<std::uint64_t>) override {}
    void exchange(std::span<const Part>, std::span<const Part>) override {}
  } beyond;
  RunOptions options;
  options.processes = &beyond;
  EXPECT_THROW(Flow(ball(), knobs, options), Error);
}

TEST(MeshOfSeveralProcesses, IsRefused) {
  const std::vector<std::uint8_t> labels(8, 1);
  const VolumeView volume = volume_view(std::span(labels), {2, 2, 2});
  on_processes(2, [&](Processes& processes) {
    RunOptions options;
    options.processes = &processes;
    try {
      Meshing(volume, {}, options);
      ADD_FAILURE() << "a mesh by two processes";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("several processes"), std::string::npos) << error.what();
    }
  });
}

}  // namespace
}  // namespace nacre
