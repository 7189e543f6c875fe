// Nacre: signed distances whose ridges lie near the interface, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/distance_ridges_body.hpp"
