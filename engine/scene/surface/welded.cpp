// Nacre: triangles whose points at one position are one point.
#include "engine/scene/surface/welded.hpp"

#include "engine/scene/surface/winding.hpp"

namespace nacre {

std::vector<Triangle> welded_triangles(const PreparedSurface& surface) {
  const std::vector<std::uint32_t> same = first_at_position(surface.points);
  std::vector<std::uint32_t> second(surface.points.size(), none);  // the first of the second sheet, by position
  std::vector<Triangle> triangles = surface.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const bool on_second = !surface.second_sheet.empty() && surface.second_sheet[t] != 0;
    const auto number = [&](std::uint32_t point) {
      if (!on_second) return same[point];
      std::uint32_t& first = second[same[point]];
      return first = first == none ? point : first;
    };
    triangles[t] = {number(triangles[t].a), number(triangles[t].b), number(triangles[t].c)};
  }
  return triangles;
}

}  // namespace nacre
