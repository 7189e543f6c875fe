// Nacre: the values of a volume, which are not changed any more: in memory, or in a file that is mapped.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "compute/field/material_array.hpp"

namespace nacre {

/// Of each value of one or two bytes, by its bits: how many voxels have it, and how many of these have the same value
/// as the voxel before them in their row.
struct ValueCounts {
  std::vector<std::size_t> voxels, repeated;
};

/// Counted when first asked for; shared by the copies of an array.
struct KeptCounts {
  std::once_flag once;
  ValueCounts counts;
};

template <class T>
class VoxelArray {
 public:
  VoxelArray() : VoxelArray(std::vector<T>()) {}
  VoxelArray(std::vector<T> own) {  // NOLINT: a conversion
    auto held = std::make_shared<OwnBytes>(std::move(own));
    size_ = held->values.size();
    data_ = held->values.data();
    held_ = std::move(held);
  }
  /// `held` begins with `size` of them.
  VoxelArray(std::shared_ptr<const HeldBytes> held, std::size_t size)
      : held_(std::move(held)), data_(reinterpret_cast<const T*>(held_->data())), size_(size) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T* data() const { return data_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  const std::shared_ptr<const HeldBytes>& held() const { return held_; }
  void let_go(std::size_t first, std::size_t last) const { held_->let_go(first * sizeof(T), last * sizeof(T)); }
  KeptCounts& kept_counts() const { return *counts_; }
  friend bool operator==(const VoxelArray& a, const VoxelArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  struct OwnBytes : HeldBytes {
    explicit OwnBytes(std::vector<T> own) : values(std::move(own)) {}
    const std::byte* data() const override { return reinterpret_cast<const std::byte*>(values.data()); }
    std::vector<T> values;
  };

  std::shared_ptr<const HeldBytes> held_;
  const T* data_ = nullptr;
  std::size_t size_ = 0;
  std::shared_ptr<KeptCounts> counts_ = std::make_shared<KeptCounts>();
};

}  // namespace nacre
