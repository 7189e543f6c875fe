// Nacre: whether the GPU can run the code of this build.
#pragma once

namespace nacre {

/// False where the current GPU is of an architecture that this build has neither code nor a portable form for.
bool cuda_code_runs();

}  // namespace nacre
