// Nacre: particles that move within their rings of triangles, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/ring_smoothing_body.hpp"

namespace nacre::test {
namespace {

double inverse_mean_ratio(double x, double y, double u) {
  const Vec3d a(-u / 2, 0, 0), b(u / 2, 0, 0), p(x, y, 0);
  const double sides = dot(a - b, a - b) + dot(p - a, p - a) + dot(p - b, p - b);
  return sides / (4 * std::sqrt(3.0) * 0.5 * length(cross(a - p, b - p)));
}

TEST(InverseMeanRatio, DerivativesAreThoseOfTheFormula) {
  EXPECT_NEAR(inverse_mean_ratio(0, std::sqrt(0.75), 1), 1, 1e-12);
  for (const auto& [x, y, u] : {std::array{0.3, 0.7, 1.1}, {-0.8, 0.4, 0.6}, {0.0, 2.0, 1.0}}) {
    const auto f = [u = u](double s, double t) { return inverse_mean_ratio(s, t, u); };
    const detail::InverseMeanRatio d{float(x), float(y), float(u)};
    const double e = 1e-4;
    EXPECT_NEAR(d.fx, (f(x + e, y) - f(x - e, y)) / (2 * e), 1e-4);
    EXPECT_NEAR(d.fy, (f(x, y + e) - f(x, y - e)) / (2 * e), 1e-4);
    EXPECT_NEAR(d.fxx, (f(x + e, y) - 2 * f(x, y) + f(x - e, y)) / (e * e), 1e-3);
    EXPECT_NEAR(d.fyy, (f(x, y + e) - 2 * f(x, y) + f(x, y - e)) / (e * e), 1e-3);
    EXPECT_NEAR(d.fxy, (f(x + e, y + e) - f(x + e, y - e) - f(x - e, y + e) + f(x - e, y - e)) / (4 * e * e), 1e-3);
    EXPECT_GT(double(d.fxx) * d.fyy - double(d.fxy) * d.fxy, 0) << "convex";
  }
}

}  // namespace
}  // namespace nacre::test
