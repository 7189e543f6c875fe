// Nacre: teams of lanes on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/device/team_body.hpp"
