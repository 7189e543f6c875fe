// Nacre: error messages that several files of this folder share.
#pragma once

#include <cstddef>
#include <string>

#include "compute/device/error.hpp"

namespace nacre {

/// There is no context to draw with; says why, and what can be done.
Error opengl_missing(const std::string& why);

/// Throws Error if the driver has run out of memory since the last call; `bytes` is the size that was requested.
void require_gl_memory(std::size_t bytes);

}  // namespace nacre
