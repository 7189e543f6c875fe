// Nacre: what happens at points of the surface through the times of the data.
#include "engine/run/flow_probes.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "compute/device/error.hpp"
#include "compute/raycast/triangle_tree.hpp"
#include "engine/scene/settings/number_list.hpp"
#include "engine/scene/surface/extent.hpp"

namespace nacre {
namespace {

constexpr int analytic_times = 65;
constexpr double farthest = 0.1;  ///< from the surface, of its diagonal

Vec3d parse_point(const std::string& text) {
  const auto p = parse_numbers(text);
  if (!p || p->size() != 3)
    throw Error("`probe` takes no point '" + text + "'", "a point has three numbers",
                "use X,Y,Z, and semicolons between several");
  return {(*p)[0], (*p)[1], (*p)[2]};
}

std::vector<double> times_of(const VectorsInTime& input) {
  if (!input.array().starts_with('@') || !(input.end() > input.start())) return input.series().times;
  std::vector<double> times;
  for (int k = 0; k < analytic_times; ++k)
    times.push_back(input.start() + (input.end() - input.start()) * k / (analytic_times - 1));
  return times;
}

}  // namespace

std::vector<Vec3d> parse_probes(const std::string& text) {
  std::vector<Vec3d> points;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) points.push_back(parse_point(part));
  return points;
}

std::vector<FlowProbe> flow_probes(VectorsInTime& input, const std::string& text, const std::atomic<bool>* stop) {
  if (input.moves() && input.series().motion->groups > 1)
    throw Error("`probe` needs the same triangles in all steps", "those of " + input.series().name + " change");
  const std::vector<Triangle>& triangles = input.surface().triangles;
  const std::vector<Vec3d> first = input.points(input.start());
  const TriangleTree tree(first, triangles);
  const double diagonal = Extent(first, triangles).diagonal();
  std::vector<FlowProbe> probes;
  std::vector<Vec3d> weights;
  for (const Vec3d& asked : parse_probes(text)) {
    const auto hit = tree.closest(asked);
    const double distance = hit ? length(hit->position - asked) : 1e300;
    if (!(distance <= farthest * diagonal))
      throw Error(fmt::format("`probe`: the point {:g},{:g},{:g} is not on the surface", asked.x, asked.y, asked.z),
                  fmt::format("its nearest point is {:.3g} away", distance));
    probes.push_back({asked, hit->position, hit->triangle, {}, {}, {}, {}});
    weights.push_back(tree.weights_at(hit->triangle, hit->position));
  }
  if (probes.empty()) return probes;
  std::vector<Vec3f> vectors(first.size());
  for (const double t : times_of(input)) {
    if (stop && *stop) throw Interrupted();
    input.vectors(t, vectors);
    const std::vector<Vec3d> shape = input.points(t);
    const std::vector<float> scalar = input.colored() ? input.scalar(t) : std::vector<float>();
    for (std::size_t k = 0; k < probes.size(); ++k) {
      FlowProbe& probe = probes[k];
      const Triangle& tri = triangles[probe.triangle];
      const Vec3f vector = interpolate<Vec3f>(vectors, tri, weights[k]);
      const Vec3f normal(normalized(cross(shape[tri.b] - shape[tri.a], shape[tri.c] - shape[tri.a])));
      probe.times.push_back(t);
      probe.vectors.push_back(vector);
      probe.speeds.push_back(length(vector - normal * dot(vector, normal)));
      if (!scalar.empty()) probe.scalars.push_back(interpolate<float>(scalar, tri, weights[k]));
    }
  }
  return probes;
}

nlohmann::json probes_report(const std::vector<FlowProbe>& probes, const std::string& color) {
  nlohmann::json all = nlohmann::json::array();
  for (const FlowProbe& probe : probes) {
    nlohmann::json vectors = nlohmann::json::array();
    for (const Vec3f& v : probe.vectors) vectors.push_back({v.x, v.y, v.z});
    nlohmann::json one = {{"asked", {probe.asked.x, probe.asked.y, probe.asked.z}},
                          {"position", {probe.position.x, probe.position.y, probe.position.z}},
                          {"triangle", probe.triangle},
                          {"times", probe.times},
                          {"vectors", std::move(vectors)},
                          {"speeds", probe.speeds}};
    if (!probe.scalars.empty()) one["colors"] = {{"array", color}, {"values", probe.scalars}};
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace nacre
