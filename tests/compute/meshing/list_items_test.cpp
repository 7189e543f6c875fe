// Nacre: items and rims on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/meshing/list_items_body.hpp"
