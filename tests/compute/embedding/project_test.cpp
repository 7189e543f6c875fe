// Nacre: the WENO4 projection on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/embedding/project_body.hpp"
