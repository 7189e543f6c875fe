// Nacre: what flow on many processes would cost, counted on the brick octree of a surface: docs/scaling.md.
//
// bench_ranks MESH|SAMPLE[:SPLITS] [resolution=4096] [ranks=1,2,4,...] [step_cells=8] [streaks=27] [threads=0]
//
// Builds the octree, cuts its bricks into ranges of equal work, finds the halo of every range, and prints what the
// ranks compute, keep and send in a step; then a model of the time of a step from measured costs.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "compute/device/executor_cpu.hpp"
#include "compute/embedding/brick_ranges.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "compute/flow/halo_depths.hpp"
#include "tests/bench/band_input.hpp"

namespace nacre {
namespace {

constexpr double radius = 2.24;

struct Settings {
  std::string mesh;
  int resolution = 4096, streaks = 27, threads = 0;
  double step_cells = 8;
  std::vector<int> ranks{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
};

/// The octree's bricks on the host.
struct Bricks {
  int levels = 0;
  std::vector<std::uint64_t> code, cells, surface;
  std::uint64_t whole_surface = 0;
};

/// What one rank has, per step where it is a flow of bytes.
struct Rank {
  std::uint64_t bricks = 0, surface = 0, cells = 0;
  std::uint64_t halo_bricks = 0, halo_surface = 0, halo_cells = 0;
  std::uint64_t deposit_surface = 0, beside_surface = 0, detail_surface = 0;
  std::uint64_t neighbours = 0;

  /// Sent and received in a step: deposits back to their owners (crossed and ended), crossed around, values, streaks
  /// before smoothing and after it.
  double bytes() const {
    return 16.0 * deposit_surface + 8.0 * beside_surface + 4.0 * halo_surface + 8.0 * beside_surface;
  }
  /// Five exchanges with each neighbour.
  double messages() const { return 5.0 * double(neighbours); }
  /// Arena at its largest: 12 bytes a cell and 8 of vectors, 24 + 12 + 12 + 12 + 4 of a surface cell, some 340 a brick.
  double memory() const {
    return 20.0 * double(cells + halo_cells) + 72.0 * double(surface + halo_surface) +
           340.0 * double(bricks + halo_bricks);
  }
};

/// A machine on which each rank runs: seconds of a step for a surface cell, and what the cells of the halo take, which
/// are computed again (their vectors and what streaks read); latency of a message; bytes a second of a rank.
struct Machine {
  const char* name;
  double surface_cell, halo_cell, latency, bandwidth;
};

// One core: train at 4096, 4.58 s a step on two threads (2026-11-26), is 1.15e-6 s of a core for a surface cell. The
// halo has a third of that (vectors and segments of streamlines, neither particles nor streaks). 96 cores: as 82, an
// assumption. H200: the floor of tests/gpu/check.sh, 25 ms for 66 million cells. The network: 400 Gb/s a node.
constexpr std::array<Machine, 3> machines{{{"core", 1.15e-6, 3.8e-7, 2e-6, 50e9 / 96},
                                           {"96 cores", 1.15e-6 / 82, 3.8e-7 / 82, 5e-6, 50e9},
                                           {"H200", 1.2e-9, 4e-10, 1e-5, 50e9}}};

Bricks build(const Settings& settings) {
  Surface surface = load_surface(settings.mesh);
  Bricks bricks;
  bricks.levels = fit(surface, settings.resolution, radius);
  const auto device = make_cpu_device(settings.threads);
  Executor<Cpu> exec(*device);
  Arena& arena = exec.arena();
  const MeshView mesh{arena.permanent_copy<Vec3d>(surface.points).data(),
                      arena.permanent_copy<Triangle>(surface.triangles).data(), nullptr};
  const BrickOctree tree =
      build_brick_octree(exec, mesh, std::uint32_t(surface.triangles.size()), bricks.levels, radius);
  bricks.code = tree.brick_code.download();
  for (const OctreeBrick& brick : tree.brick.download()) {
    bricks.cells.push_back(detail::cells_of(brick.band));
    bricks.surface.push_back(detail::cells_of(brick.surface));
  }
  for (const std::uint64_t n : bricks.surface) bricks.whole_surface += n;
  std::printf("%s, %zu triangles, %d^3: %llu cells, %llu surface cells, %zu bricks\n", settings.mesh.c_str(),
              surface.triangles.size(), settings.resolution, static_cast<unsigned long long>(tree.cells),
              static_cast<unsigned long long>(bricks.whole_surface), bricks.code.size());
  return bricks;
}

/// Calls visit(brick) for the bricks outside of first .. last - 1 and within `depth` of them.
template <class Visit>
void each_around(const Bricks& all, std::size_t first, std::size_t last, int depth, const Visit& visit) {
  const std::span own(all.code.data() + first, last - first);
  std::size_t b = 0;
  for (const std::uint64_t code : codes_around(own, depth, all.levels)) {
    b = std::size_t(std::lower_bound(all.code.begin() + std::ptrdiff_t(b), all.code.end(), code) - all.code.begin());
    if (b == all.code.size()) return;
    if (all.code[b] == code && (b < first || b >= last)) visit(b);
  }
}

Rank count(const Bricks& all, const std::vector<std::size_t>& begin, std::size_t r, const HaloDepths& depths) {
  const std::size_t first = begin[r], last = begin[r + 1];
  Rank rank;
  rank.bricks = last - first;
  for (std::size_t b = first; b < last; ++b) rank.surface += all.surface[b], rank.cells += all.cells[b];
  std::size_t owner_before = begin.size();
  each_around(all, first, last, depths.whole, [&](std::size_t b) {
    ++rank.halo_bricks;
    rank.halo_surface += all.surface[b];
    rank.halo_cells += all.cells[b];
    const auto owner = std::size_t(std::upper_bound(begin.begin(), begin.end(), b) - begin.begin());
    rank.neighbours += owner != owner_before;  // bricks ascend, and so do their owners
    owner_before = owner;
  });
  each_around(all, first, last, depths.deposits, [&](std::size_t b) { rank.deposit_surface += all.surface[b]; });
  each_around(all, first, last, depths.beside, [&](std::size_t b) { rank.beside_surface += all.surface[b]; });
  return rank;
}

/// Largest of all ranks and their mean.
struct Spread {
  double largest = 0, mean = 0;
};

template <class Get>
Spread spread_of(const std::vector<Rank>& ranks, const Get& get) {
  Spread s;
  for (const Rank& rank : ranks) {
    s.largest = std::max(s.largest, double(get(rank)));
    s.mean += double(get(rank)) / double(ranks.size());
  }
  return s;
}

double seconds(const Rank& rank, const Machine& machine, std::size_t ranks) {
  const double work = double(rank.surface) * machine.surface_cell + double(rank.halo_surface) * machine.halo_cell;
  const double sums = 2 * std::ceil(std::log2(double(ranks))) * machine.latency;
  return work + sums + rank.messages() * machine.latency + rank.bytes() / machine.bandwidth;
}

void print(const Bricks& all, int parts, const std::vector<Rank>& ranks) {
  const Spread own = spread_of(ranks, [](const Rank& r) { return r.surface; });
  const Spread halo = spread_of(ranks, [](const Rank& r) { return r.halo_surface; });
  const Spread near = spread_of(ranks, [](const Rank& r) { return r.neighbours; });
  const Spread bytes = spread_of(ranks, [](const Rank& r) { return r.bytes(); });
  const Spread memory = spread_of(ranks, [](const Rank& r) { return r.memory(); });
  std::printf("| %d | %.0f | %.3f | %.2f | %.2f | %.1f | %.0f | %.2f | %.2f | %.1f |", parts, own.mean,
              own.largest / std::max(1.0, own.mean), halo.mean / std::max(1.0, own.mean),
              halo.largest / std::max(1.0, own.mean), near.mean, near.largest, bytes.mean / 1e6, bytes.largest / 1e6,
              memory.largest / 1e6);
  for (const Machine& machine : machines) {
    double slowest = 0;
    for (const Rank& rank : ranks) slowest = std::max(slowest, seconds(rank, machine, ranks.size()));
    const double alone = double(all.whole_surface) * machine.surface_cell / parts;
    std::printf(" %.0f |", 100 * alone / slowest);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void bench(const Settings& settings) {
  const Bricks all = build(settings);
  const HaloDepths depths = HaloDepths::of(radius, settings.step_cells, settings.streaks);
  std::printf("halo of %d bricks; deposits reach %d, crossing paths %d\n\n", depths.whole, depths.deposits,
              depths.beside);
  std::printf(
      "| ranks | surface cells of a rank | largest / mean | halo / own, mean | largest | neighbours, mean | largest |"
      " MB sent a step, mean | largest | memory, MB |");
  for (const Machine& machine : machines) std::printf(" efficiency, %%: %s |", machine.name);
  std::printf("\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const int parts : settings.ranks) {
    const std::vector<std::size_t> begin = cut_by_work(all.surface, parts);
    std::vector<Rank> ranks(static_cast<std::size_t>(parts));
    tbb::parallel_for(std::size_t(0), ranks.size(), [&](std::size_t r) { ranks[r] = count(all, begin, r, depths); });
    print(all, parts, ranks);
  }
}

Settings parse(int count, char** words) {
  Settings s;
  s.mesh = words[1];
  for (int k = 2; k < count; ++k) {
    const std::string word = words[k], key = word.substr(0, word.find('='));
    const std::string value = word.size() > key.size() ? word.substr(key.size() + 1) : "";
    if (key == "ranks") {
      s.ranks.clear();
      std::istringstream list(value);
      for (std::string item; std::getline(list, item, ',');) s.ranks.push_back(std::max(1, std::stoi(item)));
    } else if (key == "resolution") {
      s.resolution = std::stoi(value);
    } else if (key == "step_cells") {
      s.step_cells = std::stod(value);
    } else if (key == "streaks") {
      s.streaks = std::stoi(value);
    } else if (key == "threads") {
      s.threads = std::stoi(value);
    } else {
      throw Error("no setting '" + key + "'", "", "use resolution, ranks, step_cells, streaks or threads");
    }
  }
  return s;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  if (argc < 2) throw nacre::Error("no mesh", "", "name a file or a sample, such as train");
  nacre::bench(nacre::parse(argc, argv));
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_ranks: %s\n", e.what());
  return 2;
}
