// Nacre: what the tests of closed meshes measure.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Defects and sizes of a triangle mesh; all defects are 0 for a closed, consistently wound 2-manifold.
struct MeshCheck {
  std::size_t open_half_edges = 0;       ///< half-edges without an opposite one
  std::size_t repeated_half_edges = 0;   ///< half-edges that more than one triangle has
  std::size_t pinched_points = 0;        ///< points whose triangles form more than one fan, or none
  std::size_t degenerate_triangles = 0;  ///< triangles with a repeated corner or without area
  long euler = 0;
  double volume = 0;
  double least_angle = 180;  ///< degrees
  double mean_edge = 0;
};

inline double least_angle(const std::vector<Vec3d>& points, const Triangle& t) {
  double least = 180;
  for (int k = 0; k < 3; ++k) {
    const Vec3d u = normalized(points[t[(k + 1) % 3]] - points[t[k]]);
    const Vec3d v = normalized(points[t[(k + 2) % 3]] - points[t[k]]);
    least = std::min(least, std::acos(std::clamp(dot(u, v), -1.0, 1.0)) * 180 / std::numbers::pi);
  }
  return least;
}

/// Number of points whose triangles are not one closed fan. `corners` holds (point, next corner, last corner), sorted.
inline std::size_t count_pinched(const std::vector<std::array<std::uint32_t, 3>>& corners, std::size_t points) {
  std::size_t round = 0;  // points with one closed fan
  for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
    while (end < corners.size() && corners[end][0] == corners[begin][0]) ++end;
    std::size_t steps = 0;
    std::uint32_t at = corners[begin][1];
    do {
      std::size_t i = begin;
      while (i < end && corners[i][1] != at) ++i;
      if (i == end) break;
      at = corners[i][2];
      ++steps;
    } while (at != corners[begin][1] && steps <= end - begin);
    round += steps == end - begin && at == corners[begin][1];
  }
  return points - round;
}

inline MeshCheck check_mesh(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles) {
  MeshCheck check;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> half_edges;
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (const Triangle& t : triangles) {
    const Vec3d area = cross(points[t.b] - points[t.a], points[t.c] - points[t.a]);
    check.degenerate_triangles += t.a == t.b || t.b == t.c || t.c == t.a || !(length(area) > 0);
    check.volume += dot(points[t.a], cross(points[t.b], points[t.c])) / 6;
    check.least_angle = std::min(check.least_angle, least_angle(points, t));
    for (int k = 0; k < 3; ++k) {
      half_edges.push_back({t[k], t[(k + 1) % 3]});
      check.mean_edge += length(points[t[k]] - points[t[(k + 1) % 3]]) / double(triangles.size() * 3);
      corners.push_back({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  }
  std::sort(half_edges.begin(), half_edges.end());
  check.repeated_half_edges = half_edges.end() - std::unique(half_edges.begin(), half_edges.end());
  half_edges.resize(half_edges.size() - check.repeated_half_edges);
  for (const auto& [from, to] : half_edges)
    check.open_half_edges += !std::binary_search(half_edges.begin(), half_edges.end(), std::pair{to, from});
  std::sort(corners.begin(), corners.end());
  check.pinched_points = count_pinched(corners, points.size());
  check.euler = long(points.size()) - long((half_edges.size() + check.open_half_edges) / 2) + long(triangles.size());
  return check;
}

}  // namespace nacre
