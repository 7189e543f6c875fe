// Nacre: diffusion by the closest point method on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/flow/surface_diffusion_body.hpp"
