// Nacre: where dye is put on a surface.
#include "engine/run/dye_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compute/device/error.hpp"
#include "engine/picture/dye_colours.hpp"
#include "engine/scene/settings/number_list.hpp"

namespace nacre {
namespace {

DyeSource parse_source(const std::string& text) {
  const auto bad = [&](const std::string& why) {
    return Error("`dye` takes no source '" + text + "'", why,
                 "use X,Y,Z,R or X,Y,Z/X,Y,Z,R or X,Y,Z:X,Y,Z or ARRAY or ARRAY=VALUE");
  };
  DyeSource source;
  source.text = text;
  const std::vector<std::string> points = split(text, '/');
  if (parse_numbers(points.back())) {
    for (const std::string& point : points) {
      const auto p = parse_numbers(point);
      const std::size_t wanted = &point == &points.back() ? 4 : 3;
      if (!p || p->size() != wanted)
        throw bad(points.size() == 1 ? "a ball has four numbers" : "a curve has three numbers a point, and a radius");
      source.curve.push_back({(*p)[0], (*p)[1], (*p)[2]});
      if (wanted == 4) source.radius = (*p)[3];
    }
    if (!(source.radius > 0)) throw bad("its radius is not above 0");
    return source;
  }
  const std::vector<std::string> ends = split(text, ':');
  if (ends.size() == 2 && parse_numbers(ends[0]) && parse_numbers(ends[1])) {
    const std::vector<double> a = *parse_numbers(ends[0]), b = *parse_numbers(ends[1]);
    if (a.size() != 3 || b.size() != 3) throw bad("a box has two corners of three numbers");
    source.box = true;
    source.low = min(Vec3d(a[0], a[1], a[2]), Vec3d(b[0], b[1], b[2]));
    source.high = max(Vec3d(a[0], a[1], a[2]), Vec3d(b[0], b[1], b[2]));
    return source;
  }
  const std::size_t sign = text.rfind('=');
  source.array = text.substr(0, sign);
  if (source.array.empty()) throw bad("it names no array");
  if (sign == text.npos) return source;
  const auto value = parse_numbers(text.substr(sign + 1));
  if (!value || value->size() != 1) throw bad("what follows = is no number");
  source.by_value = true;
  source.value = value->front();
  return source;
}

double distance_to_curve(const Vec3d& p, const std::vector<Vec3d>& curve) {
  double least = length(p - curve.front());
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const Vec3d along = curve[k + 1] - curve[k];
    const double square = dot(along, along), share = square > 0 ? dot(p - curve[k], along) / square : 0;
    least = std::min(least, length(p - curve[k] - along * std::clamp(share, 0.0, 1.0)));
  }
  return least;
}

}  // namespace

std::vector<std::vector<DyeSource>> parse_dyes(const std::string& text) {
  std::vector<std::vector<DyeSource>> dyes;
  for (const std::string& dye : split(text, '|')) {
    dyes.emplace_back();
    for (const std::string& part : split(dye, ';')) dyes.back().push_back(parse_source(trimmed(part)));
  }
  if (dyes.size() > most_dyes)
    throw Error(fmt::format("`dye` has {} dyes", dyes.size()), fmt::format("there are {} colours", most_dyes),
                "separate the sources of one dye by ;");
  return dyes;
}

std::vector<std::uint32_t> points_in(const DyeSource& source, const PreparedSurface& shape,
                                     const std::vector<Triangle>& triangles, const Surface& first) {
  const PointArray* array = source.array.empty() ? nullptr : first.find(source.array);
  if (!source.array.empty() && (!array || array->components != 1 || array->size() != shape.points.size()))
    throw Error("`dye`: the surface has no array \"" + source.array + "\" of one number per point");
  double nearest = 1e300;
  std::vector<std::uint32_t> points;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3d& p = shape.points[triangles[t][k]];
      double distance = 0;  // to the source
      if (!source.curve.empty()) distance = std::max(0.0, distance_to_curve(p, source.curve) - source.radius);
      if (source.box) distance = length(p - min(max(p, source.low), source.high));
      if (array) {
        const double value = array->values[shape.triangles[t][k]];
        distance = (source.by_value ? value == source.value : value != 0 && !std::isnan(value)) ? 0 : 1e300;
      }
      nearest = std::min(nearest, distance);
      if (distance == 0) points.push_back(triangles[t][k]);
    }
  if (points.empty())
    throw Error("`dye`: no point of the surface lies in the source '" + source.text + "'",
                array ? "no point has such a value" : fmt::format("the nearest is {:.3g} away from it", nearest),
                array ? "" : "move it, or make it larger");
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace nacre
