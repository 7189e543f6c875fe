// Nacre: rays through the octrees on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/raycast/octree_cast_body.hpp"
