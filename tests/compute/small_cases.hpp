// Nacre: fewer and smaller cases for a device that is slow.
#pragma once

#include <cstdlib>

namespace nacre::test {

/// NACRE_TEST_SMALL=1 asks for them: the emulated device takes a thousand times as long as a GPU.
inline bool small_cases() { return std::getenv("NACRE_TEST_SMALL") != nullptr; }

}  // namespace nacre::test
