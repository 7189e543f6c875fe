// Nacre: what wall shear stress does over a cycle: its mean, how it oscillates, how long it leaves blood in place.
#include "engine/scene/surface/haemodynamics.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

std::string upper_case(std::string text) {
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// The vectors at a time as the material sees them, as long as they are.
std::vector<Vec3f> stress_at(VectorsInTime& input, double t) {
  std::vector<Vec3f> vectors(input.surface().points.size());
  input.vectors(t, vectors);
  if (!input.moves()) return vectors;
  std::vector<Vec3f> turned(vectors.size());
  input.material_vectors(t, turned);
  for (std::size_t i = 0; i < turned.size(); ++i) turned[i] = normalized(turned[i]) * length(vectors[i]);
  return turned;
}

}  // namespace

void ShearIntegral::add(double seconds, std::span<const Vec3f> from, std::span<const Vec3f> to) {
  time_ += seconds;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const Vec3d a(from[i]), b(to[i]);
    sum_[i] += (a + b) * (0.5 * seconds);
    magnitude_[i] += (length(a) + 2 * length(a + b) + length(b)) * (seconds / 6);
  }
}

Haemodynamics ShearIntegral::result() const {
  Haemodynamics all;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const double net = length(sum_[i]), whole = std::max(magnitude_[i], net);
    all.tawss.push_back(time_ > 0 ? float(whole / time_) : 0.0f);
    all.osi.push_back(whole > 0 ? float(0.5 * (1 - net / whole)) : 0.0f);
    all.rrt.push_back(net > 0 ? float(time_ / net) : std::numeric_limits<float>::quiet_NaN());
  }
  return all;
}

Haemodynamics haemodynamics(VectorsInTime& input) {
  if (input.moves() && input.series().motion->groups > 1)
    throw Error("means over time need the same triangles in all steps", "those of " + input.series().name + " change");
  const std::vector<double>& times = input.series().times;
  ShearIntegral integral(input.surface().points.size());
  std::vector<Vec3f> before = stress_at(input, times.front());
  if (times.size() == 1 && !(input.end() > input.start())) integral.add(1, before, before);
  const auto go_to = [&](double from, double to) {
    std::vector<Vec3f> next = stress_at(input, to);
    integral.add(to - from, before, next);
    before = std::move(next);
  };
  for (std::size_t k = 1; k < times.size(); ++k) go_to(times[k - 1], times[k]);
  if (input.end() - times.back() > 1e-9 * (input.end() - input.start())) go_to(times.back(), input.end());
  return integral.result();
}

const std::vector<std::string>& haemodynamic_names() {
  static const std::vector<std::string> names{"TAWSS", "OSI", "RRT"};
  return names;
}

bool is_haemodynamic(const std::string& name) {
  const std::vector<std::string>& names = haemodynamic_names();
  return std::find(names.begin(), names.end(), upper_case(name)) != names.end();
}

const std::vector<float>& haemodynamic_array(const Haemodynamics& all, const std::string& name) {
  const std::string upper = upper_case(name);
  return upper == "TAWSS" ? all.tawss : upper == "OSI" ? all.osi : all.rrt;
}

}  // namespace nacre
