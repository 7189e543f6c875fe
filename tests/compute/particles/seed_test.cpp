// Nacre: the first particles on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/seed_body.hpp"
