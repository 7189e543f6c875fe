// Nacre: tightening on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/tighten_body.hpp"
