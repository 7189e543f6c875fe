// Nacre: the linear vector field that fits best around a point of a surface.
#pragma once

#include <complex>
#include <cstdint>
#include <span>

#include "compute/topology/tangent_field.hpp"

namespace nacre {

/// v = J (x - zero) in the plane of one triangle.
struct LinearFit {
  bool found = false;          ///< there is a zero within the triangles
  std::uint32_t triangle = 0;  ///< in which it lies
  Vec3d weights;
  double determinant = 0;
  std::complex<double> first, second;  ///< eigenvalues; the first has the larger real part, or the imaginary part > 0
  double real_error = 0;               ///< standard error of half the trace
  Vec3d first_axis, second_axis;       ///< eigenvectors of real eigenvalues, unit

  /// Whether it has the index, and lies where it was looked for.
  bool good(int index) const { return found && (index > 0 ? determinant > 0 : determinant < 0); }
};

/// Fitted by least squares to the vectors of all vertices of `triangles`, which are turned into the plane of triangle
/// `centre` with their normals. One triangle alone: its linear interpolation.
LinearFit fit_linear(const TangentField& field, std::uint32_t centre, std::span<const std::uint32_t> triangles);
inline LinearFit fit_linear(const TangentField& field, std::uint32_t centre,
                            std::initializer_list<std::uint32_t> triangles) {
  return fit_linear(field, centre, std::span<const std::uint32_t>(triangles.begin(), triangles.size()));
}

}  // namespace nacre
