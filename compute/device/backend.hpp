// Nacre: the two backends, and what a function needs to compile for both.
#pragma once

#if defined(__CUDACC__)
#define NACRE_HD __host__ __device__
#define NACRE_HD_INLINE __host__ __device__ __forceinline__
#else
#define NACRE_HD
#define NACRE_HD_INLINE inline __attribute__((always_inline))
#endif

namespace nacre {

struct Cpu {};   ///< oneTBB threads of this machine
struct Cuda {};  ///< one NVIDIA GPU

}  // namespace nacre
