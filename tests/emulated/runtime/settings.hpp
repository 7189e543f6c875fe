// Nacre: what the environment says about the emulated device, and how it ends the program.
#pragma once

#include <cstddef>
#include <string>

namespace emulated {

struct Settings {
  unsigned seed = 1;           ///< NACRE_EMULATED_SEED: of the order in which lanes and blocks run
  bool ordered = false;        ///< NACRE_EMULATED_ORDERED=1: by their numbers, as a check of this emulation itself
  std::size_t memory = 0;      ///< NACRE_EMULATED_MIB: device memory, in bytes; 1400 MiB unless told
  bool teams_ordered = false;  ///< NACRE_EMULATED_TEAMS_ORDERED=1: ThreadSanitizer looks for races within teams alone
  bool screen = false;         ///< NACRE_EMULATED_SCREEN=1: a screen hangs on it, and kernels have little time
};

/// Read once.
const Settings& settings();

/// The program has done what would hang, crash or go unnoticed on a GPU: says so and aborts.
[[noreturn]] void broken(const std::string& what, const std::string& where = {});

}  // namespace emulated
