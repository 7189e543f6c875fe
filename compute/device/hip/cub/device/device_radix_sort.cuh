// Nacre: CUB's radix sort by rocPRIM.
#pragma once

#include "compute/device/hip/cub/device/scratch.cuh"

namespace cub {

template <class T>
struct DoubleBuffer : rocprim::double_buffer<T> {
  using rocprim::double_buffer<T>::double_buffer;
  T* Current() const { return this->current(); }
};

struct DeviceRadixSort {
  template <class Key, class Count>
  static cudaError_t SortKeys(void* scratch, std::size_t& bytes, DoubleBuffer<Key>& keys, Count n, int begin_bit,
                              int end_bit, cudaStream_t stream) {
    rocprim::double_buffer<Key>& both = keys;
    return rocprim::radix_sort_keys(scratch, bytes, both, std::size_t(n), unsigned(begin_bit), unsigned(end_bit),
                                    stream);
  }

  template <class Key, class Value, class Count>
  static cudaError_t SortPairs(void* scratch, std::size_t& bytes, DoubleBuffer<Key>& keys, DoubleBuffer<Value>& values,
                               Count n, int begin_bit, int end_bit, cudaStream_t stream) {
    rocprim::double_buffer<Key>& all_keys = keys;
    rocprim::double_buffer<Value>& all_values = values;
    return rocprim::radix_sort_pairs(scratch, bytes, all_keys, all_values, std::size_t(n), unsigned(begin_bit),
                                     unsigned(end_bit), stream);
  }
};

}  // namespace cub
