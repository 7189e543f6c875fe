// Nacre: closed orbits of the flow, which others wind towards or away from.
#include "compute/topology/closed_orbits.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace nacre {
namespace {

constexpr int most_corrections = 6;
constexpr double slowest = 0.97;  // what winds more slowly than that does not count: it may be around a centre
constexpr double closed = 1e-3;   // an orbit's gap, as a share of its length
constexpr double common = 0.3;    // of the triangles of two lines: they are one orbit

/// Where lines cross a triangle, seen from a point in it: `side` is to the left of the flow.
struct Section {
  std::uint32_t triangle;
  Vec3d point, along, side;  // along: the way of the line, with or against the flow
  double reach;

  /// The offset, to the left, at which the piece from `a` to `b` crosses; none: it does not.
  std::optional<double> crossing(const Vec3d& a, const Vec3d& b) const {
    const double da = dot(a - point, along), db = dot(b - point, along);
    if (!(da < 0 && db >= 0)) return {};
    const Vec3d q = a + (b - a) * (da / (da - db));
    if (length(q - point) > reach) return {};
    return dot(q - point, side);
  }
};

class OrbitFinder {
 public:
  OrbitFinder(const TangentField& field, std::span<const CriticalPoint> points, double longest)
      : field_(field), tracer_(field, points, longest) {}

  /// The orbit that a line which circles winds towards.
  void add(const SurfaceLine& line) {
    if (line.end != LineEnd::circling || line.points.size() < 8) return;
    const std::optional<Section> section = section_of(line);
    if (!section) return;
    std::vector<double> offsets;
    for (std::size_t i = 1; i < line.points.size(); ++i)
      if (const auto offset = section->crossing(line.points[i - 1], line.points[i])) offsets.push_back(*offset);
    if (offsets.size() >= 3) find_fixed_point(*section, offsets.back(), line.forward);
  }

  std::vector<ClosedOrbit> take() { return std::move(orbits_); }
  const LineTracer& tracer() const { return tracer_; }

 private:
  struct Round {
    SurfaceLine line;
    double offset = 0;
    double length = 0;
  };

  /// Through the middle of the line's last visit of the triangle that it has visited most often.
  std::optional<Section> section_of(const SurfaceLine& line) const {
    std::unordered_map<std::uint32_t, int> visits;
    std::uint32_t often = none;
    int most = 0;
    for (std::size_t i = 1; i < line.triangles.size(); ++i) {
      const std::uint32_t t = line.triangles[i];
      if (t == line.triangles[i - 1]) continue;
      if (const int count = ++visits[t]; count > most) most = count, often = t;
    }
    if (most < 3) return {};
    std::size_t at = line.triangles.size() - 2;
    while (at > 1 && line.triangles[at] != often) --at;
    const Vec3d along = line.points[at + 1] - line.points[at - 1];
    if (!(length(along) > 0)) return {};
    const auto frame = field_.frame(often);
    const Vec3d u = normalized(along), left = cross(frame[2], line.forward ? u : -u);
    if (!(length(left) > 0.1)) return {};
    double edge = 0;
    for (std::uint32_t c = 3 * often; c < 3 * often + 3; ++c)
      edge = std::max(edge, length(field_.corner_point(TangentField::next(c)) - field_.corner_point(c)));
    return Section{often, line.points[at], u, normalized(left), 1.5 * edge};
  }

  /// Once round, from an offset on the section.
  std::optional<Round> round(const Section& section, double offset, bool forward) const {
    const LineTracer::Beside beside = tracer_.beside(section.triangle, section.point, offset);
    if (beside.triangle == none) return {};
    Round result;
    std::optional<double> end;
    std::size_t seen = 1;
    double gone = 0;
    result.line = tracer_.trace(beside.triangle, beside.weights, forward, [&](const SurfaceLine& line, double) {
      for (; seen < line.points.size(); ++seen) {
        const Vec3d &a = line.points[seen - 1], &b = line.points[seen];
        const auto crossing = section.crossing(a, b);
        if (crossing && gone > 2 * section.reach) {
          end = crossing;
          return false;
        }
        gone += length(b - a);
      }
      return true;
    });
    if (!end) return {};
    result.offset = *end;
    result.length = gone;
    return result;
  }

  /// By Newton's method on the map from an offset to that of the next passage.
  void find_fixed_point(const Section& section, double offset, bool forward) {
    const double aside = 0.1 * section.reach;
    for (int k = 0; k < most_corrections; ++k) {
      if (!(std::fabs(offset) < 4 * section.reach)) return;
      std::optional<Round> made = round(section, offset, forward);
      const std::optional<Round> beside = round(section, offset + aside, forward);
      if (!made || !beside) return;
      const double multiplier = (beside->offset - made->offset) / aside, gap = made->offset - offset;
      if (!(multiplier > -slowest && multiplier < slowest)) return;
      if (std::fabs(gap) < 0.01 * closed * made->length)
        return keep(std::move(made->line), std::max(multiplier, 0.0), forward);
      offset += gap / (1 - multiplier);
    }
  }

  /// Unless it is there already.
  void keep(SurfaceLine line, double multiplier, bool forward) {
    const std::unordered_set<std::uint32_t> triangles(line.triangles.begin(), line.triangles.end());
    for (const auto& other : triangles_of_) {
      std::size_t shared = 0;
      for (const std::uint32_t t : triangles) shared += other.count(t);
      if (double(shared) > common * double(std::min(triangles.size(), other.size()))) return;
    }
    triangles_of_.push_back(triangles);
    line.points.push_back(line.points.front());
    orbits_.push_back({std::move(line.points), forward, multiplier});
  }

  const TangentField& field_;
  LineTracer tracer_;
  std::vector<ClosedOrbit> orbits_;
  std::vector<std::unordered_set<std::uint32_t>> triangles_of_;
};

}  // namespace

std::vector<ClosedOrbit> closed_orbits(const TangentField& field, std::span<const CriticalPoint> points,
                                       std::span<const SurfaceLine> separatrices,
                                       std::span<const SeparationLine> separation) {
  if (field.vertices() == 0) return {};
  OrbitFinder finder(field, points, 40 * field.diagonal());
  for (const SurfaceLine& line : separatrices) finder.add(line);
  const Vec3d middle(1.0 / 3);
  for (const CriticalPoint& point : points) {
    if (point.index < 0 || point.kind == CriticalKind::centre) continue;
    const std::uint32_t beside = field.twin(3 * point.triangle);
    if (beside == none) continue;
    finder.add(finder.tracer().trace(beside / 3, middle, point.first.real() + point.second.real() > 0));
  }
  for (const SeparationLine& line : separation)
    finder.add(finder.tracer().trace(line.triangles[line.triangles.size() / 2], middle, line.separation));
  return finder.take();
}

}  // namespace nacre
