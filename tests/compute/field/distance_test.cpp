// Nacre: closest interface points on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/distance_body.hpp"
