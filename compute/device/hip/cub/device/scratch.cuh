// Nacre: what rocPRIM says, where CUB's calls are asked for.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>
#include <rocprim/rocprim.hpp>
