// Nacre: what wall shear stress does over a cycle: its mean, how it oscillates, how long it leaves blood in place.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// One number per point each.
///
///     TAWSS = 1/T  integral of |tau| dt                                    time-averaged wall shear stress
///     OSI   = 1/2 (1 - |integral of tau dt| / integral of |tau| dt)        oscillatory shear index, 0 to 1/2
///     RRT   = 1 / ((1 - 2 OSI) TAWSS)                                      relative residence time
///
/// OSI as in X. He and D. N. Ku, J. Biomech. Eng. 118 (1996), after D. N. Ku, D. P. Giddens, C. K. Zarins and S.
/// Glagov, Arteriosclerosis 5 (1985), whose index had another sign convention; RRT as in H. A. Himburg et al., Am. J.
/// Physiol. Heart 286 (2004). OSI is 0 where tau is zero all the time; RRT is NaN where the mean of tau vanishes.
struct Haemodynamics {
  std::vector<float> tawss, osi, rrt;
};

/// Adds up a vector in time, which is linear between the times that are given.
class ShearIntegral {
 public:
  explicit ShearIntegral(std::size_t points) : sum_(points), magnitude_(points) {}
  /// The interval of `seconds` between two moments. Simpson's rule for both integrals: with the same weights, so that
  /// the first is never longer than the second.
  void add(double seconds, std::span<const Vec3f> from, std::span<const Vec3f> to);
  Haemodynamics result() const;

 private:
  double time_ = 0;
  std::vector<Vec3d> sum_;
  std::vector<double> magnitude_;
};

/// Over all steps of `input`; with a period also from the last step to the first. On a surface that moves the vectors
/// count as its material sees them: a wall that turns does not make a stress oscillate, and their magnitude stays. One
/// step alone is a steady flow. Throws Error where the triangles change.
Haemodynamics haemodynamics(VectorsInTime& input);

/// The names of the three as arrays: TAWSS, OSI, RRT; whether a name is one of them, in any case; and that array.
const std::vector<std::string>& haemodynamic_names();
bool is_haemodynamic(const std::string& name);
const std::vector<float>& haemodynamic_array(const Haemodynamics& all, const std::string& name);

}  // namespace nacre
