// Nacre: errors that several files of this folder tell in the same words.
#pragma once

#include <cstddef>
#include <string>

#include "compute/device/error.hpp"

namespace nacre {

/// That there is no context to draw with, why, and what can be done.
Error opengl_missing(const std::string& why);

/// Throws Error where the driver has run out of memory since the last call; `bytes` is what was asked for.
void require_gl_memory(std::size_t bytes);

}  // namespace nacre
