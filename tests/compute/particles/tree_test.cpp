// Nacre: the tree of particles on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/tree_body.hpp"
