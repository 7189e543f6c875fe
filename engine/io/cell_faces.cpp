// Nacre: the faces of tetrahedra.
#include "engine/io/cell_faces.hpp"

#include <algorithm>
#include <tuple>

namespace nacre {
namespace {

struct FaceOfCell {
  std::array<std::uint32_t, 3> key;
  std::uint32_t cell;
  std::uint8_t face;
};

}  // namespace

std::vector<CellFace> cell_faces(std::span<const std::array<std::uint32_t, 4>> cells) {
  const auto corners_of = [&](const FaceOfCell& half) {
    std::array<std::uint32_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = cells[half.cell][std::size_t(tetrahedron_faces[half.face][k])];
    return corners;
  };
  std::vector<FaceOfCell> halves(4 * cells.size());
  for (std::size_t i = 0; i < halves.size(); ++i) {
    halves[i] = {{}, std::uint32_t(i / 4), std::uint8_t(i % 4)};
    halves[i].key = corners_of(halves[i]);
    std::sort(halves[i].key.begin(), halves[i].key.end());
  }
  std::sort(halves.begin(), halves.end(),
            [](const FaceOfCell& a, const FaceOfCell& b) { return std::tie(a.key, a.cell) < std::tie(b.key, b.cell); });
  std::vector<CellFace> faces;
  faces.reserve(halves.size() / 2);
  for (std::size_t i = 0; i < halves.size(); ++i) {
    const FaceOfCell& half = halves[i];
    const bool shared = i + 1 < halves.size() && halves[i + 1].key == half.key;
    faces.push_back({corners_of(half), half.cell, shared ? halves[i + 1].cell : no_cell, half.face,
                     shared ? halves[i + 1].face : std::uint8_t(0)});
    i += shared;
  }
  std::sort(faces.begin(), faces.end(), [](const CellFace& a, const CellFace& b) {
    const bool a_outside = a.neighbour == no_cell, b_outside = b.neighbour == no_cell;
    return std::tie(a_outside, a.owner, a.neighbour, a.owner_face) <
           std::tie(b_outside, b.owner, b.neighbour, b.owner_face);
  });
  return faces;
}

}  // namespace nacre
