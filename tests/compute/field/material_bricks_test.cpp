// Nacre: the bricks of materials on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/material_bricks_body.hpp"
