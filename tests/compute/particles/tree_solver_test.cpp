// Nacre: the tree solver on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/tree_solver_body.hpp"
