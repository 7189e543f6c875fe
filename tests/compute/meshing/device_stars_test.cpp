// Nacre: stars on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/meshing/device_stars_body.hpp"
