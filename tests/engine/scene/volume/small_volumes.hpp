// Nacre: small volumes for the tests of materials.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/scene/volume/materials.hpp"

namespace nacre::test {

/// A volume of these values, x fastest.
template <class T>
Volume volume_of(const Int3& dims, std::vector<T> values, const std::string& name = "volume.nrrd") {
  Volume volume;
  volume.name = name;
  volume.dims = dims;
  volume.values = std::move(values);
  return volume;
}

/// Materials of one volume.
inline MeshVolume materials_of(const Volume& volume, const MaterialOptions& options = {},
                               std::vector<std::string>* warnings = nullptr) {
  return make_mesh_volume({&volume, 1}, options, warnings);
}

/// The message with which that fails, empty if it does not.
inline std::string refusal(std::span<const Volume> volumes, const MaterialOptions& options = {}) {
  try {
    make_mesh_volume(volumes, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}
inline std::string refusal(const Volume& volume, const MaterialOptions& options = {}) {
  return refusal({&volume, 1}, options);
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

using Materials = std::vector<std::uint16_t>;
using Labels = std::vector<std::int64_t>;

}  // namespace nacre::test
