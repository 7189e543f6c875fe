// Nacre: the topology and the streamlines of the flow at one time: computed, reported, written.
#include "engine/run/flow_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/io/vtp_writer.hpp"
#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/welded.hpp"

namespace nacre {
namespace {

constexpr double least_strength = 1;  // neighbours come nearer by a factor of e, or part by as much

constexpr double least_multiplier = 1e-6;  // of an orbit, for its strength

/// The tangential vectors at a time, on the shape that the surface has then.
class FieldAtTime {
 public:
  FieldAtTime(VectorsInTime& input, double t, PreparedSurface& shape) {
    shape = input.moves() ? input.shape(t) : input.surface();
    std::vector<Vec3f> vectors(shape.points.size());
    input.vectors(t, vectors);
    triangles_ = welded_triangles(shape);
    field_.emplace(shape.points, triangles_, vectors);
  }
  const TangentField& operator()() const { return *field_; }

 private:
  std::vector<Triangle> triangles_;
  std::optional<TangentField> field_;
};

}  // namespace

FlowSkeleton flow_skeleton(VectorsInTime& input, double t, double persistence) {
  FlowSkeleton skeleton;
  const FieldAtTime field(input, t, skeleton.shape);
  skeleton.time = t;
  skeleton.least_persistence = persistence * input.statistics().percentile_98;
  skeleton.topology = find_critical_points(field(), skeleton.least_persistence);
  skeleton.separatrices = separatrices(field(), skeleton.topology.points);
  skeleton.separation = separation_lines(field(), least_strength);
  skeleton.orbits = closed_orbits(field(), skeleton.topology.points, skeleton.separatrices, skeleton.separation);
  return skeleton;
}

std::vector<CriticalPoint> flow_critical_points(VectorsInTime& input, double t, double persistence) {
  PreparedSurface shape;
  const FieldAtTime field(input, t, shape);
  return find_critical_points(field(), persistence * input.statistics().percentile_98).points;
}

FlowStreamlines flow_streamlines(VectorsInTime& input, double t, double spacing, const std::atomic<bool>* stop) {
  FlowStreamlines streamlines;
  const FieldAtTime field(input, t, streamlines.shape);
  streamlines.time = t;
  streamlines.lines =
      even_lines(field(), spacing * Extent(streamlines.shape.points, streamlines.shape.triangles).longest_side(), stop);
  return streamlines;
}

nlohmann::json skeleton_report(const FlowSkeleton& skeleton) {
  const FlowTopology& all = skeleton.topology;
  nlohmann::json points = nlohmann::json::array(), counts = nlohmann::json::object();
  for (const CriticalKind kind : {CriticalKind::saddle, CriticalKind::source, CriticalKind::sink,
                                  CriticalKind::focus_source, CriticalKind::focus_sink, CriticalKind::centre})
    counts[name_of(kind)] = 0;
  for (const CriticalPoint& p : all.points) {
    counts[name_of(p.kind)] = counts[name_of(p.kind)].get<int>() + 1;
    points.push_back({{"kind", name_of(p.kind)},
                      {"index", p.index},
                      {"position", {p.position.x, p.position.y, p.position.z}},
                      {"eigenvalues", {{p.first.real(), p.first.imag()}, {p.second.real(), p.second.imag()}}},
                      {"persistence", p.persistence}});
  }
  double area = 0;
  for (const ZeroRegion& region : all.zero_regions) area += region.area;
  const auto separating = std::count_if(skeleton.separation.begin(), skeleton.separation.end(),
                                        [](const SeparationLine& line) { return line.separation; });
  const auto attracting = std::count_if(skeleton.orbits.begin(), skeleton.orbits.end(),
                                        [](const ClosedOrbit& orbit) { return orbit.attracting; });
  std::map<LineEnd, int> ends;
  for (const SurfaceLine& line : skeleton.separatrices) ++ends[line.end];
  return {{"time", skeleton.time},
          {"least_persistence", skeleton.least_persistence},
          {"points", points},
          {"counts", counts},
          {"cancelled", all.cancelled},
          {"euler_characteristic", all.euler_characteristic},
          {"index_sum", all.point_index},
          {"zero_regions", {{"count", all.zero_regions.size()}, {"area", area}, {"index", all.region_index}}},
          {"rims", {{"count", all.rims}, {"index", all.rim_index}}},
          {"separatrices",
           {{"count", skeleton.separatrices.size()},
            {"to_critical_point", ends[LineEnd::critical_point]},
            {"to_rim", ends[LineEnd::rim]},
            {"to_still_flow", ends[LineEnd::still]},
            {"circling", ends[LineEnd::circling]}}},
          {"separation_lines", separating},
          {"attachment_lines", std::ptrdiff_t(skeleton.separation.size()) - separating},
          {"closed_orbits",
           {{"attracting", attracting}, {"repelling", std::ptrdiff_t(skeleton.orbits.size()) - attracting}}}};
}

void write_skeleton(const std::filesystem::path& file, const FlowSkeleton& skeleton, const std::string& origin) {
  std::vector<Vec3d> points;
  PointArray kind{"kind", 1, {}}, index{"index", 1, {}}, persistence{"persistence", 1, {}}, strength{"strength", 1, {}};
  PointArray real{"eigenvalue_real", 2, {}}, imaginary{"eigenvalue_imaginary", 2, {}};
  const auto add = [&](const Vec3d& p, int k, int i, double persists, double strong, std::complex<double> first,
                       std::complex<double> second) {
    points.push_back(p);
    kind.values.push_back(float(k));
    index.values.push_back(float(i));
    persistence.values.push_back(float(persists));
    strength.values.push_back(float(strong));
    real.values.insert(real.values.end(), {float(first.real()), float(second.real())});
    imaginary.values.insert(imaginary.values.end(), {float(first.imag()), float(second.imag())});
  };
  const std::vector<CriticalPoint>& zeros = skeleton.topology.points;
  for (const CriticalPoint& p : zeros) add(p.position, int(p.kind), p.index, p.persistence, 0, p.first, p.second);
  std::vector<std::uint64_t> starts{points.size()};
  for (const SurfaceLine& line : skeleton.separatrices) {
    for (const Vec3d& p : line.points) add(p, line.forward ? 6 : 7, 0, zeros[line.from].persistence, 0, 0, 0);
    starts.push_back(points.size());
  }
  for (const SeparationLine& line : skeleton.separation) {
    for (const Vec3d& p : line.points) add(p, line.separation ? 8 : 9, 0, 0, line.strength, 0, 0);
    starts.push_back(points.size());
  }
  for (const ClosedOrbit& orbit : skeleton.orbits) {
    const double strong = -std::log(std::max(orbit.multiplier, least_multiplier));
    for (const Vec3d& p : orbit.points) add(p, orbit.attracting ? 10 : 11, 0, 0, strong, 0, 0);
    starts.push_back(points.size());
  }
  if (starts.size() == 1) starts.clear();
  write_vtp_lines(file, points, zeros.size(), starts,
                  std::vector<PointArray>{kind, index, persistence, strength, real, imaginary}, skeleton.time,
                  xml_origin(origin));
}

void write_streamlines(const std::filesystem::path& file, const FlowStreamlines& streamlines,
                       const std::string& origin) {
  std::vector<Vec3d> points;
  PointArray speed{"speed", 1, {}};
  std::vector<std::uint64_t> starts{0};
  for (const EvenLine& line : streamlines.lines) {
    points.insert(points.end(), line.points.begin(), line.points.end());
    speed.values.insert(speed.values.end(), line.speed.begin(), line.speed.end());
    starts.push_back(points.size());
  }
  if (streamlines.lines.empty()) starts.clear();
  write_vtp_lines(file, points, 0, starts, std::vector<PointArray>{speed}, streamlines.time, xml_origin(origin));
}

}  // namespace nacre
