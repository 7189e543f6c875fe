// Nacre: the refined grid on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/embedding/refined_grid_body.hpp"
