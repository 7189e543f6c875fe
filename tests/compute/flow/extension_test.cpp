// Nacre: the equivalence of gradients on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/flow/extension_body.hpp"
