// Nacre: a fitted camera sees everything, and leaves free what is to be kept free.
#include "compute/raycast/camera.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace nacre {
namespace {

/// Where a point is seen: from (0, 0), left above, to (1, 1).
Vec3d seen_at(const Camera& camera, const Vec3d& p, double aspect) {
  const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward), d = p - camera.eye;
  const double away = camera.orthographic ? 1 : dot(d, forward) / length(camera.target - camera.eye);
  return {0.5 + dot(d, right) / (away * camera.height * aspect), 0.5 - dot(d, up) / (away * camera.height), 0};
}

struct Seen {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
};

Seen seen_box(const Camera& camera, const std::vector<Vec3d>& points, double aspect) {
  Seen seen;
  for (const Vec3d& p : points) {
    const Vec3d at = seen_at(camera, p, aspect);
    seen.left = std::min(seen.left, at.x), seen.right = std::max(seen.right, at.x);
    seen.top = std::min(seen.top, at.y), seen.bottom = std::max(seen.bottom, at.y);
  }
  return seen;
}

std::vector<Vec3d> box(const Vec3d& low, const Vec3d& high) {
  std::vector<Vec3d> corners;
  for (int k = 0; k < 8; ++k)
    corners.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  return corners;
}

constexpr std::pair<int, int> sizes[] = {{1024, 768}, {320, 900}, {1900, 300}, {300, 300}, {16, 1000}};
constexpr const char* views[] = {"iso", "+x", "-x", "+y", "-y", "+z", "-z"};

TEST(FitCamera, TheCornersOfABoxLieInThePictureAndFillIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0.01, 5);
  for (int trial = 0; trial < 40; ++trial) {
    const Vec3d low{any(random), -any(random), any(random)};
    const auto corners = box(low, low + Vec3d(any(random), any(random), any(random)));
    for (const auto& [width, height] : sizes)
      for (const bool orthographic : {false, true})
        for (const char* view : views) {
          const double aspect = double(width) / height;
          Camera from = fit_camera(view, corners, width, height);
          from.orthographic = orthographic;
          const Seen seen = seen_box(fit_camera(from, corners, width, height), corners, aspect);
          EXPECT_GT(std::min(seen.left, seen.top), 0.03) << view << " " << width << " x " << height;
          EXPECT_LT(std::max(seen.right, seen.bottom), 0.97) << view << " " << width << " x " << height;
          EXPECT_GT(std::max(seen.right - seen.left, seen.bottom - seen.top), 0.85) << "no smaller than it need be";
        }
  }
}

TEST(FitCamera, NothingLiesUnderWhatIsKeptFree) {
  const KeptFree kept{0.88, 0.1, 0.7};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(0.05, 5);
  int beside = 0, trials = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto corners = box({-1, -1, -1}, {any(random), any(random), any(random)});
    for (const auto& [width, height] : sizes)
      for (const bool orthographic : {false, true}) {
        Camera from = fit_camera("iso", corners, width, height);
        from.orthographic = orthographic;
        const double aspect = double(width) / height;
        const Camera plain = fit_camera(from, corners, width, height),
                     camera = fit_camera(from, corners, width, height, kept);
        const Seen seen = seen_box(camera, corners, aspect);
        EXPECT_TRUE(seen.right < kept.left || seen.bottom < kept.top || seen.top > kept.bottom);
        EXPECT_GT(std::min(seen.left, seen.top), 0.03);
        EXPECT_LT(std::max(seen.right, seen.bottom), 0.97);
        if (!(camera == plain)) {
          ++beside;
          EXPECT_GT(seen_box(plain, corners, aspect).right, kept.left - 0.01) << "it would have reached there";
          EXPECT_GT(std::max((seen.right - seen.left) / kept.left, seen.bottom - seen.top), 0.85);
        }
        ++trials;
      }
  }
  EXPECT_GT(beside, trials / 10);
  EXPECT_LT(beside, trials - trials / 10);
}

TEST(FitCamera, KeepsWhereItLooksAndHow) {
  Camera from;
  from.eye = {3, 4, 5};
  from.target = {9, 9, 9};
  from.up = {0, 1, 0};
  from.orthographic = true;
  const Camera camera = fit_camera(from, box({0, 0, 0}, {2, 1, 1}), 400, 300);
  EXPECT_NEAR(length(camera.forward() - from.forward()), 0, 1e-12);
  EXPECT_TRUE(camera.orthographic);
  EXPECT_EQ(camera.up, from.up);
}

TEST(FitCamera, OfNothingOrAPointIsFinite) {
  for (const std::vector<Vec3d>& points : {std::vector<Vec3d>{}, {{1, 2, 3}}}) {
    const Camera camera = fit_camera("iso", points, 400, 300, {0.8, 0, 1});
    EXPECT_GT(camera.height, 0);
    EXPECT_TRUE(std::isfinite(camera.eye.x + camera.eye.y + camera.eye.z + camera.height));
  }
}

TEST(Camera, IsDecidedByItsOutermostPoints) {
  std::vector<Vec3d> points;
  for (int k = 0; k < 500; ++k) points.emplace_back(std::sin(3.1 * k), 2 * std::cos(1.7 * k), std::sin(0.9 * k * k));
  Vec3d lower(1e300), upper(-1e300);
  for (const Vec3d& p : points) lower = min(lower, p), upper = max(upper, p);
  for (const char* view : {"iso", "+x", "-z"}) {
    std::vector<Vec3d> few;  // of either half of the points
    for (const auto& half : {std::span(points).first(200), std::span(points).subspan(200)})
      for (const Vec3d& p : outermost(preset_camera(view), half, lower, upper)) few.push_back(p);
    EXPECT_LT(few.size(), 30u);
    EXPECT_EQ(fit_camera(view, few, 300, 200), fit_camera(view, points, 300, 200)) << view;
  }
}

}  // namespace
}  // namespace nacre
