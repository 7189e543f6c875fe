// Nacre: how large boundaries are, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/boundary_area_body.hpp"
