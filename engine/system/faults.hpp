// Nacre: faults that hardware rarely gives, on demand: the hook by which tests see that the program bears them.
#pragma once

#include <string_view>

namespace nacre {

/// Has this fault been asked for? The environment's NACRE_FAULTS lists NAME (every time that it is asked about) or NAME@K
/// (the K-th time only), with commas between: lost-context@20,other-device,out-of-memory@2. Without it: never.
bool fault_due(std::string_view name);

}  // namespace nacre
