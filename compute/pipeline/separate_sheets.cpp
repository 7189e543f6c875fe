// Nacre: two sheets in one place are embedded apart.
#include "compute/pipeline/separate_sheets.hpp"

#include <algorithm>

nacre::SeparatedSheets nacre::separate_sheets(const FlowMesh& mesh, double gap) {
  SeparatedSheets apart;
  const auto is_second = [&](std::size_t t) { return mesh.second_sheet[t] != 0; };
  if (std::none_of(mesh.second_sheet.begin(), mesh.second_sheet.end(), [](std::uint8_t second) { return second != 0; }))
    return apart;
  Vec3d low(1e300), high(-1e300), second_low(1e300);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3d& p = mesh.points[mesh.triangles[t][k]];
      low = min(low, p), high = max(high, p);
      if (is_second(t)) second_low = min(second_low, p);
    }
  const Vec3d size = high - low;
  const int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  apart.shift[axis] = high[axis] - second_low[axis] + gap;
  apart.points.assign(mesh.points.begin(), mesh.points.end());
  apart.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  std::vector<std::uint32_t> moved(mesh.points.size(), none);
  const auto move = [&](std::uint32_t p) {
    if (moved[p] == none) {
      moved[p] = std::uint32_t(apart.points.size());
      apart.points.push_back(mesh.points[p] + apart.shift);
      apart.source.push_back(p);
    }
    return moved[p];
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_second(t)) {
      const Triangle& was = mesh.triangles[t];
      apart.triangles[t] = {move(was.a), move(was.b), move(was.c)};
    }
  return apart;
}
