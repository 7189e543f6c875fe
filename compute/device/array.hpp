// Nacre: typed memory on one device.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "compute/device/device.hpp"

namespace nacre {

/// `size` elements on a device, inside an Arena's block (which owns them). The host may not look at the elements:
/// `upload`, `download` and `seen_by_host` are the only ways across.
template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Array() = default;
  Array(Device& device, T* data, std::size_t size) : device_(&device), data_(data), size_(size) {}

  T* data() const { return data_; }  ///< for kernels only
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  explicit operator bool() const { return data_ != nullptr; }

  void upload(std::span<const T> host) {
    assert(host.size() <= size_);
    if (!host.empty()) device_->copy_to_device(data_, host.data(), host.size_bytes());
  }

  std::vector<T> download() const { return download(0, size_); }

  std::vector<T> download(std::size_t first, std::size_t count) const {
    assert(first + count <= size_);
    if (count == 0) return {};
    if (device_->shares_host_memory()) {
      Recording::forbid("a copy to the host");
      return {data_ + first, data_ + first + count};
    }
    std::vector<T> host(count);
    device_->copy_to_host(host.data(), data_ + first, count * sizeof(T));
    return host;
  }

  /// The first `count` as they are now: where the host shares the memory in place, which kernels may change; else a
  /// copy, in `copy`.
  std::span<T> seen_by_host(std::size_t count, std::vector<T>& copy) const {
    assert(count <= size_);
    if (count == 0) return {};
    if (device_->shares_host_memory()) {
      Recording::forbid("a look from the host");
      return {data_, count};
    }
    copy.resize(count);
    device_->copy_to_host(copy.data(), data_, count * sizeof(T));
    return copy;
  }

  void fill_bytes(unsigned char value) {
    if (size_) device_->fill(data_, value, bytes());
  }

 private:
  Device* device_ = nullptr;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace nacre
