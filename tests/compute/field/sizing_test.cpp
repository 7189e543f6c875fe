// Nacre: the sizing field on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/sizing_body.hpp"
