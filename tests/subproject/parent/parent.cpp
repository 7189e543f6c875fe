// Nacre: a program of another project that uses the numerics.
#include "compute/device/device.hpp"

int main() { return nacre::make_cpu_device(1) ? 0 : 1; }
