// Nacre: the contents of a file, before they become a surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// One named array of a file: `values[item * components + component]`, where an item is a point, a polygon or anything
/// else.
struct RawArray {
  std::string name;
  int components = 1;
  std::vector<float> values;

  std::size_t items() const { return components > 0 ? values.size() / components : 0; }
};

/// Points, polygons of any size and arrays as a reader found them. Readers do not check them: corners may refer to
/// missing points, points may be NaN, polygons may have no area. `build_surface` handles this once for all
/// formats.
struct RawMesh {
  static constexpr std::uint32_t no_point = std::numeric_limits<std::uint32_t>::max();

  std::vector<Vec3d> points;
  std::vector<std::size_t> offsets{0};      ///< polygon i has the corners [offsets[i], offsets[i + 1])
  std::vector<std::uint32_t> connectivity;  ///< point of each corner; `no_point` if the index in the file was invalid
  std::vector<RawArray> point_arrays;       ///< one item per point
  std::vector<RawArray> cell_arrays;        ///< one item per polygon
  std::vector<RawArray> field_arrays;       ///< any number of items
  std::optional<double> time;               ///< the file's own TimeValue
  std::size_t lines = 0;                    ///< line cells in the file (not kept)
  std::size_t volume_cells = 0;             ///< volume cells in the file (only their outer faces are kept)
  std::vector<std::string> warnings;        ///< full sentences

  std::size_t polygons() const { return offsets.size() - 1; }

  std::span<const std::uint32_t> polygon(std::size_t i) const {
    return {connectivity.data() + offsets[i], offsets[i + 1] - offsets[i]};
  }

  /// Adds a corner to the polygon that `close_polygon` ends. Any index is allowed; a negative one is no point.
  void add_corner(std::int64_t point) {
    connectivity.push_back(point >= 0 && point < std::int64_t(no_point) ? std::uint32_t(point) : no_point);
  }
  void close_polygon() { offsets.push_back(connectivity.size()); }

  /// Adds the triangles of a strip, with equal orientation. Returns how many there are.
  std::size_t add_strip(std::span<const std::int64_t> strip) {
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
      add_corner(strip[i]);
      add_corner(strip[i + 1 + i % 2]);
      add_corner(strip[i + 2 - i % 2]);
      close_polygon();
    }
    return strip.size() < 3 ? 0 : strip.size() - 2;
  }
};

/// Appends `part` to `mesh`: points and polygons of both; of the arrays those that both have, with equal components.
void append(RawMesh& mesh, RawMesh&& part);

}  // namespace nacre
