// Nacre: tests of pictures of triangles.
#include "compute/raycast/mesh_picture.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace nacre {
namespace {

using Rgb = std::array<float, 3>;

const std::vector<Vec3d> square_points{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
const std::vector<Triangle> square{{0, 1, 2}, {0, 2, 3}};

MeshPictureOptions looking_down() {
  MeshPictureOptions options;
  options.camera.eye = {0, 0, 10};
  options.camera.up = {0, 1, 0};
  options.camera.height = 4;
  options.camera.orthographic = true;
  options.width = 80;
  options.height = 40;
  options.edges = false;
  return options;
}

struct Picture {
  MeshPictureOptions options;
  std::vector<std::uint8_t> bytes;
  const std::uint8_t* at(int x, int y) const { return &bytes[(std::size_t(y) * options.width + x) * 4]; }
};

Picture draw(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles, const std::vector<Rgb>& colours,
             const MeshPictureOptions& options) {
  return {options, mesh_picture(points, triangles, colours, options)};
}

TEST(MeshPicture, ASquareCoversItsPixelsAndNoOthers) {
  const Picture p = draw(square_points, square, {{1, 0, 0}, {1, 0, 0}}, looking_down());
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 80; ++x) {  // 10 pixels a unit: the square is 20 pixels wide in the middle
      const bool in = x >= 30 && x < 50 && y >= 10 && y < 30;
      EXPECT_EQ(p.at(x, y)[0] > 100, true) << x << ' ' << y;
      EXPECT_EQ(p.at(x, y)[1], in ? 0 : 255) << x << ' ' << y;
      EXPECT_EQ(p.at(x, y)[3], 255);
    }
}

TEST(MeshPicture, APerspectiveCameraSeesTheSameSizeAtItsTarget) {
  MeshPictureOptions options = looking_down();
  options.camera.orthographic = false;
  const Picture p = draw(square_points, square, {{1, 0, 0}, {1, 0, 0}}, options);
  EXPECT_EQ(p.at(31, 11)[1], 0);
  EXPECT_EQ(p.at(28, 11)[1], 255);
  options.camera.eye = {0, 0, 5};
  options.camera.target = {0, 0, -5};  // now the square is at half the distance: twice as large
  const Picture near = draw(square_points, square, {{1, 0, 0}, {1, 0, 0}}, options);
  EXPECT_EQ(near.at(21, 1)[1], 0);
  EXPECT_EQ(near.at(18, 1)[1], 255);
}

TEST(MeshPicture, TheNearerTriangleIsSeenInWhateverOrder) {
  std::vector<Vec3d> points = square_points;
  for (const Vec3d& p : square_points) points.push_back(p * 0.5 + Vec3d(0, 0, 1));
  const std::vector<Triangle> far_first{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const std::vector<Triangle> near_first{{4, 5, 6}, {4, 6, 7}, {0, 1, 2}, {0, 2, 3}};
  const Rgb red{1, 0, 0}, blue{0, 0, 1};
  const Picture a = draw(points, far_first, {red, red, blue, blue}, looking_down());
  const Picture b = draw(points, near_first, {blue, blue, red, red}, looking_down());
  EXPECT_EQ(a.bytes, b.bytes);
  EXPECT_GT(a.at(40, 20)[2], 100);
  EXPECT_EQ(a.at(40, 20)[0], 0);
  EXPECT_GT(a.at(32, 12)[0], 100);
}

TEST(MeshPicture, EdgesAreDarkerThanFacets) {
  MeshPictureOptions options = looking_down();
  options.edges = true;
  const Picture p = draw(square_points, square, {{1, 1, 1}, {1, 1, 1}}, options);
  EXPECT_LT(p.at(40, 20)[0], p.at(45, 25)[0]) << "the diagonal runs through the middle";
  EXPECT_LT(p.at(30, 20)[0], p.at(35, 20)[0]);
}

TEST(MeshPicture, TransparentMeansNoBackgroundAtAll) {
  MeshPictureOptions options = looking_down();
  options.transparent = true;
  const Picture p = draw(square_points, square, {{1, 1, 1}, {1, 1, 1}}, options);
  EXPECT_EQ(p.at(0, 0)[3], 0);
  EXPECT_EQ(p.at(40, 20)[3], 255);
}

TEST(MeshPicture, WhatIsBehindTheEyeOrHasNoAreaIsLeftOut) {
  MeshPictureOptions options = looking_down();
  options.camera.orthographic = false;
  const std::vector<Vec3d> points{{-1, -1, 20}, {1, -1, 20}, {1, 1, 20}, {0, 0, 0}, {0, 0, 0}, {1, 1, 0}};
  const Picture p = draw(points, {{0, 1, 2}, {3, 4, 5}}, {{1, 0, 0}, {1, 0, 0}}, options);
  for (int i = 0; i < 80 * 40; ++i) EXPECT_EQ(p.bytes[std::size_t(i) * 4 + 1], 255);
  EXPECT_EQ(draw({}, {}, {}, options).bytes.size(), 80u * 40 * 4);
}

TEST(MeshPicture, OneAndTwoThreadsGiveTheSameBytes) {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  std::vector<Rgb> colours;
  for (std::uint32_t n = 0; n < 3000; ++n) {
    const double a = 0.1 * n, b = 0.37 * n;
    for (int k = 0; k < 3; ++k) points.push_back({std::sin(a + k), std::cos(b + k), std::sin(0.7 * n + k)});
    triangles.push_back({3 * n, 3 * n + 1, 3 * n + 2});
    colours.push_back({float(n % 7) / 7, 0.5f, 0.2f});
  }
  const Picture two = draw(points, triangles, colours, looking_down());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(two.bytes, draw(points, triangles, colours, looking_down()).bytes);
}

}  // namespace
}  // namespace nacre
