// Nacre: flow maps on a surface, and the finite-time Lyapunov exponents that follow from them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Vectors on a surface over an interval of time.
struct FlowOnSurface {
  std::span<const Vec3d> points;  ///< at the beginning; points at one position have one index (TangentField)
  std::span<const Triangle> triangles;
  /// At least two, ascending or descending: from the beginning to the end. Vectors are linear in time between two.
  std::vector<double> times;
  /// Fills one vector per point, world units per unit of time: on a surface that moves, relative to the material and
  /// pulled back to `points`.
  std::function<void(double time, std::span<Vec3f> vectors)> vectors;
  std::function<std::vector<Vec3d>(double time)> shape = {};  ///< where the points are at a time; empty: they stay
};

/// One number for each vertex (TangentField: a point of the surface, once for each fan of triangles around it).
struct FlowMap {
  std::vector<std::uint32_t> vertex;  ///< of each corner of the triangles
  std::vector<Vec3d> end;             ///< where the flow takes it, on the surface as it is at the end
  std::vector<double> ftle;           ///< 1 / unit of time; NaN where it is not known
  std::vector<double> time;           ///< over how long that was measured, >= 0
  std::size_t left = 0;               ///< vertices that the flow takes over a rim; they end there
};

/// The flow map takes each vertex from the first of the times to the last: a pathline, backward where times descend.
/// Particles go along the surface by the midpoint rule, in steps of at most 0.4 edges, straight over the triangles
/// (SurfaceWalk). They leave over a rim where the flow across its edge, in the mean of both ends, is more than
/// `outflow_share` of the mean speed there; elsewhere they slide along it.
///
/// The deformation gradient F is fitted by least squares to the ends of a vertex and its neighbours, in the tangent
/// planes at the beginning and at the end; differences keep the length that they have in space. With T the time,
///
///     FTLE = 1 / |T| ln sqrt(largest eigenvalue of F^T F)
///
/// as G. Haller, Distinguished material surfaces and coherent structures in three-dimensional fluid flows (Physica D
/// 149, 2001), and on surfaces F. Lekien and S. D. Ross, The computation of finite-time Lyapunov exponents on
/// unstructured meshes and for non-Euclidean manifolds (Chaos 20, 2010). Where the vertex or a neighbour leaves, the
/// last of the times before counts; the exponent is NaN where that is the first. The same to the byte for any number of
/// threads. Throws Interrupted where `stop` is set.
FlowMap flow_map(const FlowOnSurface& flow, const std::atomic<bool>* stop = nullptr);

inline constexpr double outflow_share = 0.02;

}  // namespace nacre
