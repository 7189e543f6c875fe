// Nacre: the outer surface of volume cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

/// Collects the faces of volume cells (and free faces) and keeps the outer ones: those that belong to one cell only.
class FaceCollector {
 public:
  /// A face of volume cell `cell`, corners in the order that makes it face outwards.
  void add(std::span<const std::int64_t> corners, std::size_t cell) { add(corners, cell, false); }
  /// A face that is a cell by itself: always kept, and used instead of an equal outer face.
  void add_free(std::span<const std::int64_t> corners, std::size_t cell) { add(corners, cell, true); }

  /// Calls `use(corners, cell)` for each outer face, in the order in which they were added.
  template <class Use>
  void for_each_outer(Use use) const {
    const std::vector<bool> outer = find_outer();
    for (std::size_t i = 0; i < outer.size(); ++i)
      if (outer[i]) use(std::span(corners_).subspan(offsets_[i], offsets_[i + 1] - offsets_[i]), cells_[i]);
  }

 private:
  void add(std::span<const std::int64_t> corners, std::size_t cell, bool free);
  std::vector<bool> find_outer() const;

  std::vector<std::int64_t> corners_;
  std::vector<std::size_t> offsets_{0};
  std::vector<std::size_t> cells_;
  std::vector<bool> free_;
};

/// Faces of a linear volume cell of that VTK type, each a list of corner numbers within the cell; empty if `type` is
/// not a volume cell. Higher-order cells begin with the corners of the linear one and have its faces.
std::span<const std::vector<int>> volume_cell_faces(int type);

/// How many corners outline a 2-D cell of that VTK type with `count` points; 0 if it is not a 2-D cell.
std::size_t flat_cell_corners(int type, std::size_t count);

}  // namespace nacre
