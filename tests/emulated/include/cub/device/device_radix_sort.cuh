// Nacre: CUB's radix sort on an emulated device.
#pragma once

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "cub/device/scratch.cuh"

namespace cub {

template <class T>
struct DoubleBuffer {
  T* d_buffers[2];
  int selector = 0;
  DoubleBuffer(T* current, T* alternate) : d_buffers{current, alternate} {}
  T* Current() const { return d_buffers[selector]; }
  T* Alternate() const { return d_buffers[1 - selector]; }
};

namespace emulated_detail {

/// Puts values[order[i]] into `to`, and rubbish into the other buffer, as a sort of several passes leaves it.
template <class T, class Order>
void deliver(T* in, T* other, bool into_other, const Order& order) {
  if (!in) return;
  std::vector<T> sorted(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = in[order[i]];
  T* const to = into_other ? other : in;
  std::memset(static_cast<void*>(into_other ? in : other), 0xee, order.size() * sizeof(T));
  std::copy(sorted.begin(), sorted.end(), to);
}

template <class Key, class Value, class Count>
cudaError_t radix_sort(void* scratch, std::size_t& bytes, DoubleBuffer<Key>& keys, DoubleBuffer<Value>& values, Count n,
                       int begin_bit, int end_bit, cudaStream_t stream) {
  if (asks_for_size(scratch, bytes, std::size_t(n))) return cudaSuccess;
  Key *const key = keys.Current(), *const other_key = keys.Alternate();
  Value *const value = values.Current(), *const other_value = values.Alternate();
  const bool into_other = (end_bit - begin_bit + 7) / 8 % 2 == 1;  // passes of 8 bits, each into the other buffer
  if (into_other) keys.selector ^= 1, values.selector ^= 1;
  return emulated::enqueue(stream, "sort", [=, bytes = bytes] {
    use_scratch(scratch, bytes);
    const int bits = end_bit - begin_bit;
    const Key mask = (bits >= 64 ? ~Key(0) : (Key(1) << bits) - 1) << begin_bit;
    std::vector<std::size_t> order(std::size_t(n), 0);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return (key[a] & mask) < (key[b] & mask); });
    deliver(value, other_value, into_other, order);
    deliver(key, other_key, into_other, order);
  });
}

}  // namespace emulated_detail

struct DeviceRadixSort {
  template <class Key, class Count>
  static cudaError_t SortKeys(void* scratch, std::size_t& bytes, DoubleBuffer<Key>& keys, Count n, int begin_bit,
                              int end_bit, cudaStream_t stream) {
    DoubleBuffer<char> no_values(nullptr, nullptr);
    return emulated_detail::radix_sort(scratch, bytes, keys, no_values, n, begin_bit, end_bit, stream);
  }

  template <class Key, class Value, class Count>
  static cudaError_t SortPairs(void* scratch, std::size_t& bytes, DoubleBuffer<Key>& keys, DoubleBuffer<Value>& values,
                               Count n, int begin_bit, int end_bit, cudaStream_t stream) {
    return emulated_detail::radix_sort(scratch, bytes, keys, values, n, begin_bit, end_bit, stream);
  }
};

}  // namespace cub
