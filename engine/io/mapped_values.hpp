// Nacre: values of large volumes that stay in their file, which the system reads as they are looked at.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "engine/scene/volume/voxel_array.hpp"
#include "engine/system/mapped_file.hpp"

namespace nacre {

/// How the values of a volume come into memory.
enum class Values { read, mapped };

/// Fewer bytes are read: that takes no time, and such a file may change meanwhile.
inline constexpr std::size_t worth_mapping = std::size_t(64) << 20;

/// Whether `count` values of `size` bytes at this place of a file may stay there.
inline bool can_map(Values how, std::size_t offset, std::size_t count, std::size_t size) {
  return how == Values::mapped && count * size >= worth_mapping && offset % size == 0;
}

template <class T>
VoxelArray<T> mapped_values(const std::filesystem::path& file, std::size_t offset, std::size_t count) {
  return {std::make_shared<MappedFile>(file, offset, count * sizeof(T)), count};
}

}  // namespace nacre
