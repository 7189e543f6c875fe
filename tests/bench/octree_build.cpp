// Nacre: building the brick octree against exact closest-point queries through Embree over the same cells.
//
// bench_octree_build MESH|SAMPLE[:SPLITS] [resolution=512,1024] [radius=4.47] [threads=0] [runs=3]
//
// MESH is a file that the program reads, SAMPLE a built-in flow sample; SPLITS times every triangle is cut into four.
// The runs alternate, and medians are compared, without and with the making of Embree's tree (ours has the sorting and
// bounding of the triangles in it). Embree is given the cells, an upper bound of their distance (the band's
// radius), and a closest-point function in single precision.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#if NACRE_EMBREE == 4
#include <embree4/rtcore.h>
#elif NACRE_EMBREE == 3
#include <embree3/rtcore.h>
#endif

#include "compute/device/executor_cpu.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "tests/bench/band_input.hpp"

namespace nacre {
namespace {

struct Settings {
  std::string mesh;
  std::vector<int> resolutions{512, 1024};
  double radius = 4.47;
  int threads = 0, runs = 3;
};

#ifdef NACRE_EMBREE
Vec3f closest_point_in_single(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& p) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
              d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const float sum = va + vb + vc;
  return a + ab * (vb / sum) + ac * (vc / sum);
}

struct Query {
  const Vec3f* points;
  const Triangle* triangles;
  Vec3f position, closest;
  std::uint32_t triangle;
};

bool look_at_triangle(RTCPointQueryFunctionArguments* arguments) {
  Query& q = *static_cast<Query*>(arguments->userPtr);
  const Triangle t = q.triangles[arguments->primID];
  const Vec3f p = closest_point_in_single(q.points[t.a], q.points[t.b], q.points[t.c], q.position);
  const float distance = length(p - q.position);
  if (distance >= arguments->query->radius) return false;
  arguments->query->radius = distance;
  q.closest = p;
  q.triangle = arguments->primID;
  return true;
}

/// Embree's tree over the triangles, and what it found for each cell.
class EmbreeQueries {
 public:
  explicit EmbreeQueries(const Surface& s) : points_(s.points.begin(), s.points.end()), triangles_(s.triangles) {
    points_.reserve(points_.size() + 1);  // Embree reads 16 bytes at the last point
  }

  Seconds build(int threads) {
    return measure([&] {
      device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
      scene_ = rtcNewScene(device_);
      RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, points_.data(), 0, sizeof(Vec3f),
                                 points_.size());
      rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles_.data(), 0, sizeof(Triangle),
                                 triangles_.size());
      rtcSetGeometryPointQueryFunction(g, look_at_triangle);
      rtcCommitGeometry(g);
      rtcAttachGeometry(scene_, g);
      rtcReleaseGeometry(g);
      rtcCommitScene(scene_);
    });
  }

  /// Queries every cell of the octree; returns the largest difference of a distance.
  Seconds run(const BrickOctreeView& tree, int threads, std::vector<CellPoint>& out) const {
    tbb::task_arena workers(threads);
    return measure([&] {
      workers.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tree.brick_count), [&](const auto& range) {
          for (std::uint32_t b = range.begin(); b < range.end(); ++b) query_brick(tree, b, out);
        });
      });
    });
  }

  ~EmbreeQueries() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
  }
  EmbreeQueries(const EmbreeQueries&) = delete;

 private:
  void query_brick(const BrickOctreeView& tree, std::uint32_t b, std::vector<CellPoint>& out) const {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const Int3 corner = morton_cell(tree.brick_code[b]) * Int3(BrickOctreeView::width);
    CellIndex cell = tree.brick[b].band.first;
    for (int z = 0; z < 8; ++z)
      for (std::uint64_t rest = tree.brick[b].band.word[z]; rest; rest &= rest - 1) {
        const int k = __builtin_ctzll(rest);
        Query q{points_.data(), triangles_.data(), Vec3f(corner + Int3(k & 7, k >> 3, z)) + Vec3f(0.5f), {}, none};
        RTCPointQuery point{q.position.x, q.position.y, q.position.z, 0, tree.radius + 0.01f};
        rtcPointQuery(scene_, &point, &context, nullptr, &q);
        out[cell++] = CellPoint::pack(Vec3d(q.closest - q.position), tree.quantum, q.triangle);
      }
  }

  std::vector<Vec3f> points_;
  std::vector<Triangle> triangles_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};
#endif

void bench(const Settings& settings, Surface surface, int resolution) {
  const int levels = fit(surface, resolution, settings.radius);
  const auto device = make_cpu_device(settings.threads);
  Executor<Cpu> exec(*device);
  Arena& arena = exec.arena();
  const auto triangles = std::uint32_t(surface.triangles.size());
  const MeshView mesh{arena.permanent_copy<Vec3d>(surface.points).data(),
                      arena.permanent_copy<Triangle>(surface.triangles).data(), nullptr};
  const std::size_t mark = arena.mark();
  BrickOctree tree;
  std::vector<double> wall, processor, other_wall, other_processor, other_tree;
#ifdef NACRE_EMBREE
  std::vector<CellPoint> found;
  double worst = 0;
#endif
  for (int run = 0; run < settings.runs; ++run) {
    arena.rewind(mark);
    const Seconds ours = measure([&] { tree = build_brick_octree(exec, mesh, triangles, levels, settings.radius); });
    wall.push_back(ours.wall);
    processor.push_back(ours.processor);
#ifdef NACRE_EMBREE
    EmbreeQueries embree(surface);
    other_tree.push_back(embree.build(device->threads()).processor);
    found.resize(tree.cells);
    const Seconds theirs = embree.run(tree.view(), device->threads(), found);
    other_wall.push_back(theirs.wall);
    other_processor.push_back(theirs.processor);
    const std::vector<CellPoint> own = tree.point.download();
    for (std::size_t c = 0; c < own.size(); c += 101)
      worst = std::max(worst, std::fabs(double(length(own[c].offset(tree.quantum))) -
                                        double(length(found[c].offset(tree.quantum)))));
#endif
  }
  const double cells = double(tree.cells), ours = median(processor);
  std::printf("%s, %u triangles, %d^3: %.2f M cells in %u bricks, %.1f bytes per cell\n", settings.mesh.c_str(),
              triangles, resolution, cells * 1e-6, tree.brick_count, double(tree.bytes()) / cells);
  std::printf("  octree %8.3f s wall, %8.3f s processor, %6.1f ns processor per cell\n", median(wall), ours,
              1e9 * ours / cells);
#ifdef NACRE_EMBREE
  const double theirs = median(other_processor);
  std::printf("  Embree %8.3f s wall, %8.3f s processor, %6.1f ns processor per cell; its tree %.3f s beside\n",
              median(other_wall), theirs, 1e9 * theirs / cells, median(other_tree));
  std::printf(
      "  Embree / octree: %.2f wall, %.2f processor, %.2f with its tree; distances differ by at most %.1e cells\n",
      median(other_wall) / median(wall), theirs / ours, (theirs + median(other_tree)) / ours, worst);
#else
  std::printf("  built without Embree: nothing to compare with\n");
#endif
  std::fflush(stdout);
}

Settings parse(int count, char** words) {
  Settings s;
  s.mesh = words[1];
  for (int k = 2; k < count; ++k) {
    const std::string word = words[k], key = word.substr(0, word.find('=')), value = word.substr(key.size() + 1);
    if (key == "resolution") {
      s.resolutions.clear();
      std::istringstream list(value);
      for (std::string item; std::getline(list, item, ',');) s.resolutions.push_back(std::stoi(item));
    } else if (key == "radius") {
      s.radius = std::stod(value);
    } else if (key == "threads") {
      s.threads = std::stoi(value);
    } else if (key == "runs") {
      s.runs = std::max(1, std::stoi(value));
    } else {
      throw Error("no setting '" + key + "'", "", "use resolution, radius, threads or runs");
    }
  }
  return s;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  if (argc < 2) throw nacre::Error("no mesh", "", "name a file or a sample, such as train");
  const nacre::Settings settings = nacre::parse(argc, argv);
  const nacre::Surface surface = nacre::load_surface(settings.mesh);
  for (const int resolution : settings.resolutions) nacre::bench(settings, surface, resolution);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_octree_build: %s\n", e.what());
  return 2;
}
