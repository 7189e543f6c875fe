// Nacre: the version of the library. CMake reads it from here.
#pragma once

#include "export.hpp"

#define NACRE_VERSION_MAJOR 0
#define NACRE_VERSION_MINOR 1
#define NACRE_VERSION_PATCH 0
#define NACRE_VERSION_STRING "0.1.0"

namespace nacre {

/// Version of the library that is linked, "MAJOR.MINOR.PATCH"; the macros are those of the headers. Versions are
/// semantic: a program that compiles against one compiles against every later one with the same major number (before
/// 1.0: the same minor number). A stable binary interface is not promised.
NACRE_API const char* library_version() noexcept;

}  // namespace nacre
