// Nacre: faults on demand that hardware rarely gives: tests use them to check that the program survives them.
#pragma once

#include <string_view>

namespace nacre {

/// Whether this fault has been requested. The environment variable NACRE_FAULTS lists NAME (every time that it is asked
/// for) or NAME@K (the K-th time only), separated by commas: lost-context@20,other-device,out-of-memory@2. Without it:
/// never.
bool fault_due(std::string_view name);

}  // namespace nacre
