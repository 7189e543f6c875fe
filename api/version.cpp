// Nacre: the version of the library.
#include "include/nacre/version.hpp"

namespace nacre {

const char* library_version() noexcept { return NACRE_VERSION_STRING; }

}  // namespace nacre
