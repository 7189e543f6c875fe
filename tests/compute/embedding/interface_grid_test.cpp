// Nacre: the embedding of interfaces on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/embedding/interface_grid_body.hpp"
