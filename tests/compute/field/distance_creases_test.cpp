// Nacre: signed distances whose creases lie near the interface, on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/field/distance_creases_body.hpp"
