// Nacre: streamlines that lie evenly on a surface.
#include "compute/topology/even_lines.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <unordered_map>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

/// Points of lines in cubes as wide as the distances that are asked for.
class Samples {
 public:
  explicit Samples(double width) : width_(width) {}

  void add(const Vec3d& p, const Vec3d& normal) { cubes_[key(cube(p))].push_back({p, normal}); }

  /// Whether a sample that faces alike is nearer than `distance`, at most the width.
  bool near(const Vec3d& p, const Vec3d& normal, double distance) const {
    const Int3 at = cube(p);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const auto found = cubes_.find(key({at.x + x, at.y + y, at.z + z}));
          if (found == cubes_.end()) continue;
          for (const Sample& s : found->second)
            if (dot(s.normal, normal) > 0 && length(s.p - p) < distance) return true;
        }
    return false;
  }

 private:
  struct Sample {
    Vec3d p, normal;
  };
  Int3 cube(const Vec3d& p) const {
    return {int(std::floor(p.x / width_)), int(std::floor(p.y / width_)), int(std::floor(p.z / width_))};
  }
  static std::uint64_t key(const Int3& c) {
    const auto part = [](int i) { return std::uint64_t(i + (1 << 20)) & 0x1fffff; };
    return part(c.x) << 42 | part(c.y) << 21 | part(c.z);
  }

  double width_;
  std::unordered_map<std::uint64_t, std::vector<Sample>> cubes_;
};

class EvenLines {
 public:
  EvenLines(const TangentField& field, double spacing, const std::atomic<bool>* stop)
      : field_(field), spacing_(spacing), stop_(stop), tracer_(field, {}, 4 * field_.diagonal()), samples_(spacing) {}

  std::vector<EvenLine> all() {
    for (std::uint32_t t = 0; t < field_.triangles(); ++t) {
      const Vec3d middle =
          (field_.corner_point(3 * t) + field_.corner_point(3 * t + 1) + field_.corner_point(3 * t + 2)) / 3.0;
      try_seed(t, Vec3d(1.0 / 3), middle);
      while (!waiting_.empty()) {
        const SurfaceLine line = std::move(waiting_.front());
        waiting_.pop_front();
        for (std::size_t i = 0; i < line.points.size(); ++i)
          for (const double side : {spacing_, -spacing_}) {
            const LineTracer::Beside seed = tracer_.beside(line.triangles[i], line.points[i], side);
            if (seed.triangle != none) try_seed(seed.triangle, seed.weights, seed.position);
          }
      }
    }
    return std::move(lines_);
  }

 private:
  Vec3d normal(std::uint32_t t) const { return field_.frame(t)[2]; }

  void try_seed(std::uint32_t triangle, const Vec3d& weights, const Vec3d& position) {
    if (stop_ && *stop_) throw Interrupted();
    // A seed at the spacing beside a line that curves is a little nearer in space.
    if (samples_.near(position, normal(triangle), 0.9 * spacing_)) return;
    // Points of the line itself count once it has gone so far from them that it must have turned.
    Samples own(spacing_);
    std::vector<std::pair<double, std::size_t>> recent;
    std::size_t counted = 0;
    double gone_before = 0;
    const auto may_go_on = [&](const SurfaceLine& line, double gone) {
      const Vec3d p = line.points.back(), n = normal(line.triangles.back());
      recent.emplace_back(gone_before + gone, line.points.size() - 1);
      while (counted < recent.size() && recent[counted].first < gone_before + gone - 2 * spacing_) {
        const std::size_t i = recent[counted++].second;
        own.add(line.points[i], normal(line.triangles[i]));
      }
      return !samples_.near(p, n, 0.5 * spacing_) && !own.near(p, n, 0.5 * spacing_);
    };
    SurfaceLine back = tracer_.trace(triangle, weights, false, may_go_on);
    for (std::size_t i = 0; i < back.points.size(); ++i)
      if (length(back.points[i] - position) > 2 * spacing_) own.add(back.points[i], normal(back.triangles[i]));
    recent.clear();
    counted = 0;
    SurfaceLine line = tracer_.trace(triangle, weights, true, may_go_on);
    std::reverse(back.points.begin(), back.points.end());
    std::reverse(back.triangles.begin(), back.triangles.end());
    line.points.insert(line.points.begin(), back.points.begin(), back.points.end() - 1);
    line.triangles.insert(line.triangles.begin(), back.triangles.begin(), back.triangles.end() - 1);
    double whole = 0;
    for (std::size_t i = 1; i < line.points.size(); ++i) whole += length(line.points[i] - line.points[i - 1]);
    if (whole < spacing_) return;
    EvenLine result;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      samples_.add(line.points[i], normal(line.triangles[i]));
      result.speed.push_back(float(tracer_.speed(line.triangles[i], line.points[i])));
    }
    fill_gaps(line);
    result.points = line.points;
    lines_.push_back(std::move(result));
    waiting_.push_back(std::move(line));
  }

  /// Samples between points that are far apart: where triangles are larger than the spacing.
  void fill_gaps(const SurfaceLine& line) {
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const Vec3d a = line.points[i - 1], d = line.points[i] - a;
      const int pieces = int(std::min(1e5, length(d) / (0.25 * spacing_)));
      for (int k = 1; k < pieces; ++k) samples_.add(a + d * (double(k) / pieces), normal(line.triangles[i]));
    }
  }

  const TangentField& field_;
  double spacing_;
  const std::atomic<bool>* stop_;
  LineTracer tracer_;
  Samples samples_;
  std::deque<SurfaceLine> waiting_;
  std::vector<EvenLine> lines_;
};

}  // namespace

std::vector<EvenLine> even_lines(const TangentField& field, double spacing, const std::atomic<bool>* stop) {
  return EvenLines(field, spacing, stop).all();
}

}  // namespace nacre
