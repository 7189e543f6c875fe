// Nacre: local contrast on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/flow/contrast_body.hpp"
