// Nacre: the built-in flows on analytic surfaces, by name.
#include "engine/scene/samples/samples.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/samples/sample_kit.hpp"
#include "engine/scene/settings/edit_distance.hpp"

namespace nacre {
namespace {

constexpr int max_detail = 1024;  // millions of triangles: more would only fill memory

const std::vector<SampleDefinition>& definitions() {
  static const std::vector<SampleDefinition> all{
      sphere_sample(),   sphere_rotation_sample(), torus_sample(),      train_sample(),
      aircraft_sample(), cylinder_sample(),        delta_wing_sample(), pulse_sample()};
  return all;
}

[[noreturn]] void throw_unknown(const std::string& name) {
  if (is_phantom(name)) throw Error(fmt::format("the sample '{}' is a volume", name), "", "nacre mesh takes it");
  std::string known, closest;
  std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const SampleDefinition& definition : definitions()) {
    known += (known.empty() ? "" : ", ") + definition.info.name;
    const std::size_t distance = edit_distance(name, definition.info.name);
    if (distance < best) best = distance, closest = definition.info.name;
  }
  const std::string advice = closest.empty() ? "" : fmt::format("did you mean '{}'?", closest);
  throw Error(fmt::format("there is no sample '{}'", name), "the samples are " + known, advice);
}

PointArray velocity_array(const SampleShape& shape, const SampleField& field) {
  PointArray velocity{"velocity", 3, std::vector<float>(shape.points.size() * 3)};
  tbb::parallel_for(std::size_t(0), shape.points.size(), [&](std::size_t i) {
    const Vec3d v = tangential(field(shape.points[i], shape.normals[i]), shape.normals[i]);
    for (int axis = 0; axis < 3; ++axis) velocity.values[3 * i + axis] = float(v[axis]);
  });
  return velocity;
}

/// A step of a shape that moves: the material's flow as it is there, and the velocity of the material itself.
Surface moved_surface(const SampleShape& shape, const SampleDefinition& definition, double time) {
  constexpr double dt = 1e-5, ds = 1e-5;
  const SampleField field = definition.flow(time);
  const std::size_t n = shape.points.size();
  Surface surface{std::vector<Vec3d>(n), shape.triangles, {}};
  PointArray velocity{"velocity", 3, std::vector<float>(3 * n)};
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const Vec3d p = shape.points[i], v = tangential(field(p, shape.normals[i]), shape.normals[i]);
    surface.points[i] = definition.position(p, time);
    const Vec3d own = (definition.position(p, time + dt) - definition.position(p, time - dt)) / (2 * dt);
    const Vec3d along = (definition.position(p + v * ds, time) - definition.position(p - v * ds, time)) / (2 * ds);
    for (int axis = 0; axis < 3; ++axis) velocity.values[3 * i + axis] = float((own + along)[axis]);
  });
  surface.arrays.push_back(std::move(velocity));
  return surface;
}

}  // namespace

const SampleDefinition& sample_definition(const std::string& name) {
  for (const SampleDefinition& definition : definitions())
    if (definition.info.name == name) return definition;
  throw_unknown(name);
}

std::vector<SampleInfo> samples() {
  std::vector<SampleInfo> infos;
  for (const SampleDefinition& definition : definitions()) infos.push_back(definition.info);
  return infos;
}

SurfaceSeries make_sample(const std::string& name, int detail) {
  const SampleDefinition& definition = sample_definition(name);
  if (detail == 0) detail = definition.default_detail;
  if (detail < definition.min_detail || detail > max_detail)
    throw Error(fmt::format("the sample '{}' cannot be made with detail {}", name, detail), "",
                fmt::format("choose from {} to {}, or 0 for its default of {}", definition.min_detail, max_detail,
                            definition.default_detail));

  const auto shape = std::make_shared<const SampleShape>(definition.shape(detail));
  SurfaceSeries series;
  series.name = name;
  for (int k = 0; k < definition.steps; ++k) series.times.push_back(double(k) / definition.steps);
  series.moves = bool(definition.position);
  series.load = [shape, &definition, flow = definition.flow, times = series.times, name](std::size_t step) {
    if (step >= times.size())
      throw Error(fmt::format("the sample '{}' has no time step {}", name, step),
                  fmt::format("it has {}, counted from 0", times.size()));
    if (definition.position) return moved_surface(*shape, definition, times[step]);
    return Surface{shape->points, shape->triangles, {velocity_array(*shape, flow(times[step]))}};
  };
  return series;
}

}  // namespace nacre
