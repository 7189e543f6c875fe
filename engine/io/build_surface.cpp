// Nacre: triangulates, drops unusable triangles, moves every array to the points.
#include "engine/io/build_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compute/device/error.hpp"
#include "engine/io/triangulate.hpp"

namespace nacre {
namespace {

// Height over longest edge below which a triangle has no usable normal, even in double precision.
constexpr double flatness = 1e-12;

/// Why triangles were dropped, each with a count.
struct Losses {
  std::size_t triangles = 0;  ///< all triangles of the file
  std::size_t no_point = 0;
  std::size_t not_finite = 0;
  std::size_t no_area = 0;
  std::size_t short_polygons = 0;

  void report(std::vector<std::string>& warnings, const std::string& name) const {
    const auto say = [&](std::size_t count, const char* why) {
      if (count == 0) return;
      warnings.push_back(
          fmt::format("{}: {} of {} triangles dropped: {}.", name, with_commas(count), with_commas(triangles), why));
    };
    say(no_point, "point index out of range");
    say(not_finite, "NaN or infinite point");
    say(no_area, "zero area");
    if (short_polygons > 0)
      warnings.push_back(
          fmt::format("{}: {} faces with fewer than 3 corners dropped.", name, with_commas(short_polygons)));
  }
};

bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
  return length(cross(ab, ac)) > flatness * longest;
}

/// Usable triangles, and the polygon that each came from.
struct Triangulation {
  std::vector<Triangle> triangles;
  std::vector<std::size_t> polygon;
  Losses losses;
};

Triangulation triangulate_all(const RawMesh& mesh) {
  std::vector<bool> finite(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) finite[i] = is_finite(mesh.points[i]);

  Triangulation result;
  result.triangles.reserve(mesh.polygons());
  result.polygon.reserve(mesh.polygons());
  std::vector<Triangle> pieces;
  for (std::size_t i = 0; i < mesh.polygons(); ++i) {
    const auto corners = mesh.polygon(i);
    if (corners.size() < 3) {
      ++result.losses.short_polygons;
      continue;
    }
    const std::size_t expected = corners.size() - 2;
    result.losses.triangles += expected;
    const auto outside = [&](std::uint32_t corner) { return corner >= mesh.points.size(); };
    const auto lost = [&](std::uint32_t corner) { return !finite[corner]; };
    if (std::any_of(corners.begin(), corners.end(), outside)) {
      result.losses.no_point += expected;
      continue;
    }
    if (std::any_of(corners.begin(), corners.end(), lost)) {
      result.losses.not_finite += expected;
      continue;
    }
    pieces.clear();
    triangulate(corners, mesh.points, pieces);
    result.losses.no_area += expected - pieces.size();
    for (const Triangle& t : pieces) {
      if (!has_area(mesh.points[t.a], mesh.points[t.b], mesh.points[t.c])) {
        ++result.losses.no_area;
        continue;
      }
      result.triangles.push_back(t);
      result.polygon.push_back(i);
    }
  }
  return result;
}

/// Sets values that are not finite to 0, in arrays that can only colour to NaN, and reports how many items had one.
void clean(RawArray& array, const std::string& name, std::vector<std::string>& warnings) {
  const bool colours = array.components == 1;
  std::size_t bad_items = 0;
  for (std::size_t i = 0; i < array.items(); ++i) {
    bool bad = false;
    for (int c = 0; c < array.components; ++c) {
      float& value = array.values[i * array.components + c];
      if (std::isfinite(value)) continue;
      value = colours ? std::numeric_limits<float>::quiet_NaN() : 0;
      bad = true;
    }
    bad_items += bad;
  }
  if (bad_items > 0)
    warnings.push_back(fmt::format("{}: array '{}' is NaN or infinite at {} of {} positions, {}.", name, array.name,
                                   with_commas(bad_items), with_commas(array.items()),
                                   colours ? "drawn in the colour of NaN" : "set to 0"));
}

/// Means over the adjacent triangles, weighted by area, of arrays on polygons.
class CellsToPoints {
 public:
  CellsToPoints(const RawMesh& mesh, const Triangulation& kept)
      : kept_(kept), areas_(kept.triangles.size()), weights_(mesh.points.size()) {
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      const Triangle& t = kept.triangles[i];
      const Vec3d& a = mesh.points[t.a];
      areas_[i] = length(cross(mesh.points[t.b] - a, mesh.points[t.c] - a));
      for (int k = 0; k < 3; ++k) weights_[t[k]] += areas_[i];
    }
  }

  RawArray operator()(const RawArray& cells) const {
    const std::size_t components = cells.components;
    std::vector<double> sums(weights_.size() * components);
    for (std::size_t i = 0; i < areas_.size(); ++i)
      for (int k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < components; ++c)
          sums[kept_.triangles[i][k] * components + c] += areas_[i] * cells.values[kept_.polygon[i] * components + c];
    RawArray points{cells.name, cells.components, std::vector<float>(sums.size())};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double weight = weights_[i / components];
      points.values[i] = weight > 0 ? float(sums[i] / weight) : 0.0f;
    }
    return points;
  }

 private:
  const Triangulation& kept_;
  std::vector<double> areas_;
  std::vector<double> weights_;
};

bool has_array(const std::vector<RawArray>& arrays, const std::string& name) {
  return std::any_of(arrays.begin(), arrays.end(), [&](const RawArray& array) { return array.name == name; });
}

void keep_arrays_of_right_size(std::vector<RawArray>& arrays, std::size_t items, const std::string& name,
                               std::vector<std::string>& warnings) {
  std::erase_if(arrays, [&](const RawArray& array) {
    if (array.components > 0 && array.values.size() == items * array.components) return false;
    warnings.push_back(fmt::format("{}: array '{}' dropped: it has {} entries where {} belong.", name, array.name,
                                   with_commas(array.items()), with_commas(items)));
    return true;
  });
}

/// Point arrays of the file, then its cell arrays moved to the points; if both have a name, it means the point array.
void gather_arrays(RawMesh& mesh, const Triangulation& kept, const std::string& name,
                   std::vector<std::string>& warnings) {
  keep_arrays_of_right_size(mesh.point_arrays, mesh.points.size(), name, warnings);
  keep_arrays_of_right_size(mesh.cell_arrays, mesh.polygons(), name, warnings);
  std::erase_if(mesh.cell_arrays, [&](const RawArray& array) { return has_array(mesh.point_arrays, array.name); });
  for (RawArray& array : mesh.point_arrays) clean(array, name, warnings);
  if (mesh.cell_arrays.empty()) return;
  const CellsToPoints move(mesh, kept);
  for (RawArray& array : mesh.cell_arrays) {
    clean(array, name, warnings);
    mesh.point_arrays.push_back(move(array));
  }
}

/// New number of each point that a triangle uses, in the old order; `no_point` for the others.
std::vector<std::uint32_t> number_used_points(const std::vector<Triangle>& triangles, std::size_t points,
                                              std::size_t& used) {
  std::vector<std::uint32_t> number(points, RawMesh::no_point);
  for (const Triangle& t : triangles) number[t.a] = number[t.b] = number[t.c] = 0;
  used = 0;
  for (std::uint32_t& entry : number)
    if (entry == 0) entry = std::uint32_t(used++);
  return number;
}

Surface compact(RawMesh& mesh, std::vector<Triangle>&& triangles) {
  std::size_t used = 0;
  const auto number = number_used_points(triangles, mesh.points.size(), used);
  Surface surface;
  surface.triangles = std::move(triangles);
  if (used == mesh.points.size()) {
    surface.points = std::move(mesh.points);
    for (RawArray& array : mesh.point_arrays)
      surface.arrays.push_back({std::move(array.name), array.components, std::move(array.values)});
    return surface;
  }
  for (Triangle& t : surface.triangles) t = {number[t.a], number[t.b], number[t.c]};
  surface.points.resize(used);
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] != RawMesh::no_point) surface.points[number[i]] = mesh.points[i];
  for (RawArray& array : mesh.point_arrays) {
    PointArray kept{std::move(array.name), array.components, std::vector<float>(used * array.components)};
    for (std::size_t i = 0; i < number.size(); ++i)
      if (number[i] != RawMesh::no_point)
        std::copy_n(&array.values[i * array.components], array.components, &kept.values[number[i] * array.components]);
    surface.arrays.push_back(std::move(kept));
  }
  return surface;
}

[[noreturn]] void fail_without_triangles(const RawMesh& mesh, const Losses& losses, const std::string& name) {
  std::string why = "the file is empty of geometry";
  if (losses.triangles > 0 || losses.short_polygons > 0) {
    std::vector<std::string> reasons;
    losses.report(reasons, "all");
    why = fmt::format("none of its {} faces can be used: ", with_commas(mesh.polygons()));
    for (const std::string& reason : reasons) why += (&reason == &reasons[0] ? "" : " ") + reason.substr(5);
    why.pop_back();
  } else if (mesh.lines > 0) {
    why = fmt::format("it holds {} lines and no faces", with_commas(mesh.lines));
  } else if (!mesh.points.empty()) {
    why = fmt::format("it holds {} points and no faces", with_commas(mesh.points.size()));
  }
  throw Error(name + " has no triangles", why, "a surface of triangles or polygons is needed");
}

}  // namespace

std::string with_commas(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::ptrdiff_t at = std::ptrdiff_t(digits.size()) - 3; at > 0; at -= 3) digits.insert(at, ",");
  return digits;
}

Surface build_surface(RawMesh mesh, const std::string& name, std::vector<std::string>& warnings,
                      const std::vector<Vec3d>* moved, bool part) {
  Triangulation kept = triangulate_all(mesh);
  if (kept.triangles.empty() && !part) fail_without_triangles(mesh, kept.losses, name);
  for (const std::string& warning : mesh.warnings) warnings.push_back(name + ": " + warning);
  kept.losses.report(warnings, name);
  gather_arrays(mesh, kept, name, warnings);
  if (moved) mesh.points = *moved;
  return compact(mesh, std::move(kept.triangles));
}

}  // namespace nacre
