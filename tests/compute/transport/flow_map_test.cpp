// Nacre: flow maps and Lyapunov exponents on planes and spheres where they are known.
#include "compute/transport/flow_map.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "compute/device/error.hpp"
#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

using TimeField = std::function<Vec3d(const Vec3d& point, double time)>;

std::vector<double> even_times(double from, double to, int intervals) {
  std::vector<double> times;
  for (int k = 0; k <= intervals; ++k) times.push_back(from + (to - from) * k / intervals);
  return times;
}

FlowOnSurface flow_on(const Shape& shape, std::vector<double> times, const TimeField& field) {
  FlowOnSurface flow{shape.points, shape.triangles, std::move(times), {}};
  flow.vectors = [&shape, field](double t, std::span<Vec3f> out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = Vec3f(field(shape.points[i], t));
  };
  return flow;
}

/// The point of each vertex of a map.
std::vector<std::uint32_t> map_points(const Shape& shape, const FlowMap& map) {
  std::vector<std::uint32_t> points(map.end.size());
  for (std::size_t c = 0; c < map.vertex.size(); ++c) points[map.vertex[c]] = shape.triangles[c / 3][int(c % 3)];
  return points;
}

TEST(FlowMap, ASaddleStretchesByItsEigenvalueOutOverARim) {
  const Shape plate = square(20);
  for (const double end : {1.5, -1.5}) {
    const FlowMap map =
        flow_map(flow_on(plate, even_times(0, end, 30), [](const Vec3d& p, double) { return Vec3d(p.x, -p.y, 0); }));
    const std::vector<std::uint32_t> points = map_points(plate, map);
    std::size_t whole = 0, cut = 0;
    for (std::size_t v = 0; v < map.end.size(); ++v) {
      const Vec3d& p = plate.points[points[v]];
      ASSERT_EQ(std::isnan(map.ftle[v]), map.time[v] == 0);
      if (map.time[v] > 0) {
        ASSERT_NEAR(map.ftle[v], 1, 0.005);
      }
      if (map.time[v] == 1.5) {
        ++whole;
        ASSERT_NEAR(map.end[v].x, p.x * std::exp(end), 0.003);
        ASSERT_NEAR(map.end[v].y, p.y * std::exp(-end), 0.003);
      } else {
        ++cut;
      }
    }
    EXPECT_GT(whole, 40u);
    EXPECT_GT(cut, 200u);
    EXPECT_GT(map.left, 200u);
  }
}

TEST(FlowMap, ARigidRotationStretchesNothingAndComesRound) {
  const Shape sphere = divided_sphere(5);
  const FlowMap map = flow_map(flow_on(sphere, {0, std::numbers::pi, 2 * std::numbers::pi},
                                       [](const Vec3d& p, double) { return Vec3d(-p.y, p.x, 0); }));
  EXPECT_EQ(map.left, 0u);
  const std::vector<std::uint32_t> points = map_points(sphere, map);
  double sum = 0;
  for (std::size_t v = 0; v < map.end.size(); ++v) {
    ASSERT_NEAR(map.ftle[v], 0, 0.03);
    ASSERT_LT(length(map.end[v] - sphere.points[points[v]]), 0.03);
    sum += map.ftle[v];
  }
  EXPECT_LT(sum / double(map.end.size()), 0.005);
}

TEST(FlowMap, VectorsAreInterpolatedInTime) {
  // The angular velocity grows as t: half a turn in all, and a turn back against time.
  const Shape sphere = divided_sphere(4);
  const TimeField faster = [](const Vec3d& p, double t) { return Vec3d(-p.y, p.x, 0) * (2 * std::numbers::pi * t); };
  const FlowMap map = flow_map(flow_on(sphere, {0, 1}, faster)), back = flow_map(flow_on(sphere, {1, 0}, faster));
  const std::vector<std::uint32_t> points = map_points(sphere, map);
  for (std::size_t v = 0; v < map.end.size(); ++v) {
    const Vec3d& p = sphere.points[points[v]];
    ASSERT_LT(length(map.end[v] - Vec3d(-p.x, -p.y, p.z)), 0.03);
    ASSERT_LT(length(back.end[v] - Vec3d(-p.x, -p.y, p.z)), 0.03);
  }
}

TEST(FlowMap, ASurfaceThatGrowsStretchesAtRest) {
  const Shape sphere = divided_sphere(3);
  FlowOnSurface flow = flow_on(sphere, even_times(0, 2, 4), [](const Vec3d&, double) { return Vec3d(); });
  flow.shape = [&sphere](double t) {
    std::vector<Vec3d> points = sphere.points;
    for (Vec3d& p : points) p *= 1 + t;
    return points;
  };
  const FlowMap map = flow_map(flow);
  for (const double each : map.ftle) ASSERT_NEAR(each, std::log(3.0) / 2, 1e-9);
}

/// The double gyre of S. C. Shadden, F. Lekien and J. E. Marsden (Physica D 212, 2005) on 0..2 x 0..1, and that domain
/// on the unit sphere: 0.6 radians of longitude to a unit, and the same of latitude about the equator.
constexpr double gyre_scale = 0.6;
struct Gyre {
  double u, v;
};
Gyre gyre(double x, double y, double t) {
  const double e = 0.25 * std::sin(2 * std::numbers::pi * t / 10), a = e, b = 1 - 2 * e, f = a * x * x + b * x;
  return {-std::numbers::pi * 0.1 * std::sin(std::numbers::pi * f) * std::cos(std::numbers::pi * y),
          std::numbers::pi * 0.1 * std::cos(std::numbers::pi * f) * std::sin(std::numbers::pi * y) * (2 * a * x + b)};
}
Vec3d on_globe(double x, double y) {
  const double l = gyre_scale * (x - 1), b = gyre_scale * (y - 0.5);
  return {std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b)};
}
std::pair<double, double> on_map(const Vec3d& p) {
  return {std::atan2(p.y, p.x) / gyre_scale + 1, std::asin(p.z / length(p)) / gyre_scale + 0.5};
}
Vec3d gyre_on_globe(const Vec3d& p, double t) {
  const auto [x, y] = on_map(p);
  const Gyre v = gyre(x, y, t);
  const double l = gyre_scale * (x - 1), b = gyre_scale * (y - 0.5);
  return Vec3d(-std::cos(b) * std::sin(l), std::cos(b) * std::cos(l), 0) * (gyre_scale * v.u) +
         Vec3d(-std::sin(b) * std::cos(l), -std::sin(b) * std::sin(l), std::cos(b)) * (gyre_scale * v.v);
}
/// By small differences of pathlines of the gyre itself, Runge-Kutta of fourth order.
double gyre_ftle(double x, double y, double from, double to) {
  const auto end = [&](double px, double py) {
    const int steps = 400;
    const double dt = (to - from) / steps;
    for (int k = 0; k < steps; ++k) {
      const double t = from + dt * k;
      const Gyre a = gyre(px, py, t), b = gyre(px + 0.5 * dt * a.u, py + 0.5 * dt * a.v, t + 0.5 * dt),
                 c = gyre(px + 0.5 * dt * b.u, py + 0.5 * dt * b.v, t + 0.5 * dt),
                 d = gyre(px + dt * c.u, py + dt * c.v, t + dt);
      px += dt / 6 * (a.u + 2 * b.u + 2 * c.u + d.u);
      py += dt / 6 * (a.v + 2 * b.v + 2 * c.v + d.v);
    }
    return on_globe(px, py);
  };
  constexpr double d = 1e-5;
  const Vec3d by_x = (end(x + d, y) - end(x - d, y)) / (2 * d * gyre_scale * std::cos(gyre_scale * (y - 0.5)));
  const Vec3d by_y = (end(x, y + d) - end(x, y - d)) / (2 * d * gyre_scale);
  const double p = dot(by_x, by_x), q = dot(by_y, by_y), r = dot(by_x, by_y);
  return 0.5 * std::log(0.5 * (p + q) + std::hypot(0.5 * (p - q), r)) / std::fabs(to - from);
}

Shape gyre_patch(int n) {
  Shape s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= 2 * n; ++i) s.points.push_back(on_globe(double(i) / n, double(j) / n));
  const auto at = [n](int i, int j) { return std::uint32_t(j * (2 * n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const bool turned_over = (i + j) % 2 == 1;
      s.triangles.push_back({at(i, j), at(i + 1, j), turned_over ? at(i, j + 1) : at(i + 1, j + 1)});
      s.triangles.push_back({turned_over ? at(i + 1, j) : at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return s;
}

/// Mean difference from the exact exponent over some 600 vertices, as a share of its mean.
double gyre_error(int n, double to) {
  const Shape patch = gyre_patch(n);
  const FlowMap map = flow_map(flow_on(patch, even_times(0, to, 64), gyre_on_globe));
  EXPECT_EQ(map.left, 0u) << "the gyre keeps within its walls";
  const std::vector<std::uint32_t> points = map_points(patch, map);
  double sum = 0, whole = 0;
  for (std::size_t v = 0; v < map.end.size(); v += map.end.size() / 600 | 1) {  // odd, as rows are
    const auto [x, y] = on_map(patch.points[points[v]]);
    const double exact = gyre_ftle(x, y, 0, to);
    sum += std::fabs(map.ftle[v] - exact);
    whole += exact;
  }
  return sum / whole;
}

TEST(FlowMap, TheDoubleGyreOnASphereConverges) {
  for (const double to : {5.0, -10.0}) {
    const double coarse = gyre_error(16, to), middle = gyre_error(32, to), fine = gyre_error(64, to);
    EXPECT_LT(middle, 0.65 * coarse) << coarse;
    EXPECT_LT(fine, 0.65 * middle) << middle;
    EXPECT_LT(fine, to > 0 ? 0.06 : 0.16);
  }
}

TEST(FlowMap, BytesDoNotDependOnThreads) {
  const Shape patch = gyre_patch(16);
  const FlowOnSurface flow = flow_on(patch, even_times(0, 10, 16), gyre_on_globe);
  const FlowMap many = flow_map(flow);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const FlowMap alone = flow_map(flow);
  EXPECT_EQ(many.ftle, alone.ftle);
  EXPECT_TRUE(many.end == alone.end);
}

TEST(FlowMap, CanBeStopped) {
  const Shape patch = gyre_patch(8);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(flow_map(flow_on(patch, {0, 1}, gyre_on_globe), &stop), Interrupted);
}

}  // namespace
}  // namespace nacre::test
