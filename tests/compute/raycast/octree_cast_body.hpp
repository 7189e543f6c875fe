// Nacre: test bodies of rays through the octrees.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "compute/embedding/build_brick_octree.hpp"
#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_thesis_octree.hpp"
#include "compute/raycast/render.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"

namespace nacre::test {

template <class View>
struct CastRays {
  View view;
  MeshView mesh;
  const Ray* rays;
  Hit* hits;
  NACRE_HD void operator()(std::int64_t i) const { cast(view, mesh, rays[i], hits[i]); }
};

template <class Backend, class View>
std::vector<Hit> cast_all(Executor<Backend>& exec, const View& view, const MeshView& mesh,
                          const std::vector<Ray>& rays) {
  Arena::Scope scope(exec.arena());
  Array<Ray> in = exec.arena().template temporary<Ray>(rays.size());
  in.upload(rays);
  Array<Hit> out = exec.arena().template temporary<Hit>(rays.size());
  out.upload(std::vector<Hit>(rays.size()));
  exec.for_each(std::int64_t(rays.size()), CastRays<View>{view, mesh, in.data(), out.data()});
  return out.download();
}

/// What the ray meets first among all triangles, in long double. `tolerance` (barycentric) widens them.
struct SlowHit {
  long double t = 1e300L;
  bool seen = false;
  double facing = 1;  ///< cosine between ray and normal
};

inline SlowHit slow_hit(const Mesh& mesh, const Ray& ray, long double tolerance) {
  using V = Vec3<long double>;
  const V o(ray.origin), d(ray.direction);
  SlowHit best;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners c = mesh.corners(i);
    const V a(c.a), b(c.b), e(c.c), n = cross(b - a, e - a);
    const long double nn = dot(n, n), along = dot(n, d);
    if (nn == 0 || along == 0) continue;
    const long double t = dot(n, a - o) / along;
    const V p = o + d * t;
    const long double u = dot(cross(e - b, p - b), n) / nn, v = dot(cross(a - e, p - e), n) / nn, w = 1 - u - v;
    if (t <= 0 || t >= best.t || u < -tolerance || v < -tolerance || w < -tolerance) continue;
    best = {t, true, double(std::abs(along) / std::sqrt(nn * dot(d, d)))};
  }
  return best;
}

/// Rays of all kinds at what lies in [low, high]^3 of a domain of `size` cells.
inline std::vector<Ray> rays_at(double low, double high, double size, int count, unsigned seed) {
  Random random(seed);
  std::vector<Ray> rays;
  const auto sign = [&] { return random() < 0.5 ? -1.0 : 1.0; };
  for (int i = 0; i < count; ++i) {
    const Vec3d target = random.point(low, high);
    Vec3d origin = random.point(-0.5 * size, 1.5 * size);
    switch (i % 8) {
      case 0: origin = random.point(low, high); break;                      // from within
      case 1: origin = target + random.point(-1, 1) * (high - low); break;  // from nearby
      case 2: origin[i / 8 % 3] = target[i / 8 % 3]; break;                 // square to an axis
      case 3: {                                                             // along an axis, between cells
        origin = target;
        for (int axis = 0; axis < 3; ++axis) origin[axis] = std::floor(origin[axis]);
        Vec3d direction;
        direction[i / 8 % 3] = sign();
        if (i & 64) origin = origin - direction * size;
        rays.push_back({origin, direction});
        continue;
      }
      case 4: {  // along a diagonal through corners of cells
        origin = {std::floor(target.x), std::floor(target.y), std::floor(target.z)};
        rays.push_back({origin, {sign(), sign(), i & 64 ? sign() : 0}});
        continue;
      }
      default: break;
    }
    const double scale = i % 5 == 0 ? 1 / length(target - origin) : i % 5 == 1 ? 1e-3 : 1;
    rays.push_back({origin, (target - origin) * scale});
  }
  return rays;
}

/// Rays that pass so close to an edge that the two references disagree say nothing, but must be few.
inline void expect_first_hits(const Mesh& mesh, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                              const std::string& what) {
  std::size_t seen = 0, doubtful = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SlowHit narrow = slow_hit(mesh, rays[i], 0), wide = slow_hit(mesh, rays[i], 2e-5L);
    const double speed = length(rays[i].direction);
    if (narrow.seen != wide.seen || std::abs(double(narrow.t - wide.t)) * speed > 1e-5) {
      ++doubtful;
      continue;
    }
    seen += narrow.seen;
    ASSERT_EQ(hits[i].triangle != none, narrow.seen) << what << ", ray " << i;
    if (!narrow.seen) continue;
    ASSERT_LT(std::abs(double(hits[i].t - narrow.t)) * speed, 1e-4) << what << ", ray " << i;
    const Corners c = mesh.corners(hits[i].triangle);
    const Vec3f w = hits[i].weights;
    const Vec3d p = c.a + (c.b - c.a) * double(w.y) + (c.c - c.a) * double(w.z);
    const BandPoint at = band_point(rays[i].at(hits[i].t));
    ASSERT_LT(length(Vec3d(at.base) + Vec3d(at.local) - p), 1e-3) << what << ", ray " << i;
  }
  EXPECT_GT(seen, rays.size() / 10) << what;
  EXPECT_LT(doubtful, rays.size() / 20) << what;
}

template <class Backend>
void expect_exact(Executor<Backend>& exec, const Mesh& mesh, int levels, double low, double high, int rays,
                  const std::string& what) {
  exec.arena().rewind(0);
  const MeshView view = upload(exec, mesh);
  const BrickOctree tree = build_brick_octree(exec, view, std::uint32_t(mesh.triangles.size()), levels, 2.0);
  const std::vector<Ray> all = rays_at(low, high, 8 << levels, rays, 7);
  expect_first_hits(mesh, all, cast_all(exec, tree.view(), view, all), what);
}

template <class Backend>
void BrickOctreeFindsTheFirstTriangle(Executor<Backend>& exec) {
  expect_exact(exec, sphere({32.2, 31.7, 32.4}, 20, 20), 3, 10, 54, 1200, "sphere");
  expect_exact(exec, torus({31.9, 32.3, 32.1}, 18, 6, 20), 3, 8, 56, 1200, "torus");
  expect_exact(exec, box({8, 16, 12}, {40, 48, 36}, 5), 3, 6, 50, 1200, "box on cell faces");
  expect_exact(exec, soup(300, 2, 62, 9, 3), 3, 2, 62, 1200, "soup");
  expect_exact(exec, box({1, 1, 1}, {6, 6.5, 5}, 2), 0, 0, 8, 800, "one brick");
  Mesh sheets;
  for (int k = 0; k < 6; ++k) sheets.add(sheet({8.1, 9.3, 30 + 0.3 * k}, {44, 1, 3}, {-2, 40, 5}, 6));
  expect_exact(exec, sheets, 3, 10, 48, 1200, "folded sheets");
}

/// Long lists: hundreds of triangles in a brick.
template <class Backend>
void BricksWithManyTriangles(Executor<Backend>& exec) {
  const Mesh mesh = sphere({16.3, 15.8, 16.1}, 9, 40);
  const MeshView view = upload(exec, mesh);
  const BrickOctree tree = build_brick_octree(exec, view, std::uint32_t(mesh.triangles.size()), 2, 2.0);
  const std::vector<std::uint64_t> start = tree.list_start.download();
  std::uint64_t longest = 0;
  for (std::size_t b = 0; b + 1 < start.size(); ++b) longest = std::max(longest, start[b + 1] - start[b]);
  ASSERT_GT(longest, 2 * detail::long_list);
  const std::vector<Ray> rays = rays_at(5, 27, 32, 800, 5);
  expect_first_hits(mesh, rays, cast_all(exec, tree.view(), view, rays), "fine sphere");
}

/// Two small bodies at opposite ends of a wide domain.
template <class Backend>
void WideDomainsKeepPrecision(Executor<Backend>& exec) {
  for (const int levels : {10, 17}) {
    const double size = 8 << levels;
    Mesh mesh = sphere(Vec3d(20.3), 12, 10);
    mesh.add(torus(Vec3d(size - 24.7), 14, 5, 10));
    exec.arena().rewind(0);
    const MeshView view = upload(exec, mesh);
    const BrickOctree tree = build_brick_octree(exec, view, std::uint32_t(mesh.triangles.size()), levels, 2.0);
    std::vector<Ray> rays = rays_at(5, 35, size, 600, 11);
    for (const Ray& r : rays_at(size - 40, size - 10, size, 600, 12)) rays.push_back(r);
    Random random(3);
    for (int i = 0; i < 300; ++i) {  // from one body to the other
      const Vec3d from = random.point(0, 2), to = random.point(size - 40, size - 10);
      rays.push_back(i % 2 ? Ray{from, to - from} : Ray{to, from - to});
    }
    expect_first_hits(mesh, rays, cast_all(exec, tree.view(), view, rays), std::to_string(8 << levels));
  }
}

/// The thesis octree knows one plane per cell: no holes, and within a cell of the surface.
template <class Backend>
void ThesisOctreeLeavesNoHoles(Executor<Backend>& exec) {
  for (const int n : {12, 60}) {  // triangles larger and smaller than cells
    const Mesh mesh = torus({31.9, 32.3, 32.1}, 18, 6.5, n);
    exec.arena().rewind(0);
    const MeshView view = upload(exec, mesh);
    const ThesisOctree tree = build_thesis_octree(exec, view, std::uint32_t(mesh.triangles.size()), 3, 2.0, false);
    const std::vector<Ray> rays = rays_at(8, 56, 64, 2000, 9);
    const std::vector<Hit> hits = cast_all(exec, tree.view(), view, rays);
    std::size_t seen = 0, close = 0, wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const SlowHit slow = slow_hit(mesh, rays[i], 1e-6L);
      wrong += !slow.seen && hits[i].triangle != none;  // beside the silhouette
      if (!slow.seen || slow.facing < 0.2) continue;
      ++seen;
      ASSERT_NE(hits[i].triangle, none) << n << ", ray " << i;
      const double off = (hits[i].t - double(slow.t)) * length(rays[i].direction);
      ASSERT_LT(off, 1.5) << n << ", ray " << i;  // behind the surface: there is a hole in it
      close += std::abs(off) * slow.facing < 0.3;
    }
    ASSERT_GT(seen, 600u);
    EXPECT_GT(double(close), 0.97 * double(seen)) << n;
    EXPECT_LT(wrong, rays.size() / 40) << n;
  }
}

template <class Backend, class Target>
std::vector<std::uint8_t> plain_picture(Executor<Backend>& exec, const Target& target, const MeshView& mesh,
                                        const Vec3d& middle) {
  constexpr int size = 160;
  RenderPixel<Target> pixel;
  pixel.scene.target = target;
  pixel.scene.mesh = mesh;
  pixel.scene.light = normalized(Vec3f(0.3f, -0.5f, 0.8f));
  pixel.scene.background = Vec3f(1.0f);
  const Vec3d forward = normalized(Vec3d(-0.6, 0.7, -0.5)), right = normalized(cross(forward, Vec3d(0, 0, 1)));
  pixel.camera = {middle - forward * 300.0, forward, right * 30.0, cross(right, forward) * 30.0, 300, false};
  pixel.width = pixel.height = size;
  pixel.samples = 2;
  pixel.reach = 100;
  Arena::Scope scope(exec.arena());
  Array<std::uint32_t> pixels = exec.arena().template temporary<std::uint32_t>(size * size);
  pixel.pixels = pixels.data();
  exec.for_each(size * size, pixel);
  std::vector<std::uint8_t> bytes(4 * size * size);
  exec.device().copy_to_host(bytes.data(), pixels.data(), bytes.size());
  return bytes;
}

/// Share of pixels that differ by more than `most` levels in any channel.
inline double share_off(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int most) {
  double off = 0;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    int difference = 0;
    for (std::size_t k = i; k < i + 4; ++k) difference = std::max(difference, std::abs(a[k] - b[k]));
    off += difference > most;
  }
  return off / double(a.size() / 4);
}

/// The same scene through the grid and through both octrees.
template <class Backend>
void OctreesShowWhatTheGridShows(Executor<Backend>& exec) {
  Mesh sheets;
  for (int k = 0; k < 6; ++k) sheets.add(sheet({12.1, 13.3, 28 + 0.3 * k}, {38, 1, 3}, {-2, 38, 5}, 6));
  const Mesh meshes[] = {sphere(Vec3d(32.2), 21, 24), torus(Vec3d(31.9), 18, 6.5, 24), sheets};
  for (const Mesh& mesh : meshes) {
    exec.arena().rewind(0);
    MeshView view = upload(exec, mesh);
    std::vector<Vec3f> normals;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      normals.insert(normals.end(), 3, Vec3f(detail::plane_normal(mesh.corners(t))));
    const Array<Vec3f> corner_normals = exec.arena().template permanent_copy<Vec3f>(normals);
    view.corner_normals = corner_normals.data();
    const auto triangles = std::uint32_t(mesh.triangles.size());
    const ClosestPointGrid grid = build_closest_point_grid(exec, view, triangles, Int3(16), 4, 3.0f);
    const BrickOctree brick = build_brick_octree(exec, view, triangles, 3, 3.0);
    const ThesisOctree source = build_thesis_octree(exec, view, triangles, 3, 3.0, false);
    const Vec3d middle(32.0);
    const auto expected = plain_picture(exec, GridTarget{grid.view(), {}}, view, middle);
    ASSERT_GT(share_off(expected, std::vector<std::uint8_t>(expected.size(), 255), 10), 0.15);
    EXPECT_LT(share_off(expected, plain_picture(exec, BandTarget<BrickOctreeView>{brick.view()}, view, middle), 2),
              0.001);
    EXPECT_LT(share_off(expected, plain_picture(exec, BandTarget<ThesisOctreeView>{source.view()}, view, middle), 20),
              0.1);
  }
}

NACRE_DEVICE_TEST(OctreeCast, BrickOctreeFindsTheFirstTriangle)
NACRE_DEVICE_TEST(OctreeCast, BricksWithManyTriangles)
NACRE_DEVICE_TEST(OctreeCast, WideDomainsKeepPrecision)
NACRE_DEVICE_TEST(OctreeCast, ThesisOctreeLeavesNoHoles)
NACRE_DEVICE_TEST(OctreeCast, OctreesShowWhatTheGridShows)

}  // namespace nacre::test
