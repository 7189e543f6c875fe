// Nacre: the memory pool on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/device/arena_body.hpp"
