// Nacre: CUB's reduction on an emulated device.
#pragma once

#include <algorithm>

#include "cub/device/scratch.cuh"

namespace cub {

struct DeviceReduce {
  /// In tiles, so that what is merged is not merged in the order of the elements. CUB launches one kernel for one tile,
  /// two for more: graphs differ in shape.
  template <class In, class T, class Count, class Merge>
  static cudaError_t Reduce(void* scratch, std::size_t& bytes, In in, T* out, Count n, Merge merge, T identity,
                            cudaStream_t stream) {
    constexpr Count tile = 4096;
    if (emulated_detail::asks_for_size(scratch, bytes, std::size_t(n))) return cudaSuccess;
    return emulated::enqueue(stream, n <= tile ? "reduce in one" : "reduce in two", [=, bytes = bytes] {
      emulated_detail::use_scratch(scratch, bytes);
      T all = identity;
      for (Count first = 0; first < n; first += tile) {
        T part = in[first];
        for (Count i = first + 1; i < std::min<Count>(n, first + tile); ++i) part = merge(part, in[i]);
        all = merge(all, part);
      }
      *out = all;
    });
  }
};

}  // namespace cub
