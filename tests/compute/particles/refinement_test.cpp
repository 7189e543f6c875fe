// Nacre: fewer particles first, and all of them from these, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/refinement_body.hpp"
