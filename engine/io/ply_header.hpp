// Nacre: the header of a PLY file: its elements and their properties.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace nacre {

enum class PlyType { none, int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size in bytes; 0 for `none`.
std::size_t ply_size(PlyType type);
inline bool ply_is_real(PlyType type) { return type == PlyType::float32 || type == PlyType::float64; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::none;
  PlyType count_type = PlyType::none;  ///< type of the length before a list; `none` for a single number

  bool is_list() const { return count_type != PlyType::none; }
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of the property of that name, or -1.
  int find(std::string_view name) const;
};

struct PlyHeader {
  enum class Encoding { ascii, little, big } encoding = Encoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;  ///< where the data begin
};

/// Reads the header of `bytes`. Throws Error if it is damaged.
PlyHeader read_ply_header(std::string_view bytes, const std::filesystem::path& path);

}  // namespace nacre
