// Nacre: checks the size and orientation that the file of a volume states, before anything is allocated.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// Sets the number of voxels along each axis. Throws Error if one is below 2 (not a volume) or beyond 32 bits, or if
/// `bytes_per_voxel` times all is more than the memory of this machine.
void set_dims(Volume& volume, const std::array<std::int64_t, 3>& dims, std::size_t bytes_per_voxel,
              const std::filesystem::path& path);

/// Sets spacing and axes from the displacements in the world from one voxel to the next along each axis. Displacements
/// nearly at right angles (cosine below 1e-3) are made orthogonal. Throws Error if one is zero or not a number, or if
/// two are further from a right angle.
void set_steps(Volume& volume, const std::array<Vec3d, 3>& steps, const std::filesystem::path& path);

/// The largest cosine between two of the displacements: 0 if all are at right angles.
double shear_of(const std::array<Vec3d, 3>& steps);

/// Throws Error if a file of `stored` bytes cannot contain `needed` bytes, packed at most `ratio` to one.
void check_stored(std::uintmax_t stored, std::uintmax_t needed, double ratio, const std::filesystem::path& path);

/// Warns, unless `packed`, that `file` is not packed although its name or its header (`what_says_so`) says it is.
void warn_unless_packed(Volume& volume, bool packed, const std::filesystem::path& file, const char* what_says_so);

/// Warns if `more` than the values is stored: perhaps the header gives a wrong size or type.
void warn_of_rest(Volume& volume, bool more);

/// The best ratio of gzip, for zeros: 1032 bytes from one.
inline constexpr std::size_t largest_gzip_ratio = 1100;

/// Calls `use(zero)` with a zero of the type of `bytes` bytes and returns true; false if there is no such type.
template <class Use>
bool with_number_type(bool real, bool is_signed, int bytes, Use use) {
  if (real) {
    if (bytes == 4) return use(float{}), true;
    if (bytes == 8) return use(double{}), true;
    return false;
  }
  switch (bytes) {
    case 1: return is_signed ? use(std::int8_t{}) : use(std::uint8_t{}), true;
    case 2: return is_signed ? use(std::int16_t{}) : use(std::uint16_t{}), true;
    case 4: return is_signed ? use(std::int32_t{}) : use(std::uint32_t{}), true;
    case 8: return is_signed ? use(std::int64_t{}) : use(std::uint64_t{}), true;
    default: return false;
  }
}

/// Reverses the byte order of every number.
template <class T>
void swap_bytes(std::vector<T>& values) {
  if constexpr (sizeof(T) > 1)
    for (T& value : values) {
      char* bytes = reinterpret_cast<char*>(&value);
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    }
}

}  // namespace nacre
