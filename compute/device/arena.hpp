// Nacre: the memory pool of sec. 5.3: one block, permanent data from the head, temporaries from the tail.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compute/device/array.hpp"
#include "compute/device/device.hpp"
#include "compute/device/error.hpp"

namespace nacre {

/// One block of a device. Permanent arrays grow from its head, temporary ones from its tail, so that the two are never
/// interleaved; both ends are stacks. Nothing is allocated inside a step. Sort and scan take their scratch from the
/// tail.
class Arena {
 public:
  Arena(Device& device, std::size_t bytes)
      : device_(device),
        capacity_(bytes / 256 * 256),
        block_(static_cast<std::uint8_t*>(device.reserve(capacity_))),
        tail_(capacity_) {}
  ~Arena() { device_.release(block_, capacity_); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// `count` elements that last until `rewind`. Throws Error when the block is full.
  template <class T>
  Array<T> permanent(std::size_t count) {
    const std::size_t start = head_;
    require(count, sizeof(T));
    const std::size_t end = start + aligned(count * sizeof(T));
    device_.commit(block_, start, end);
    head_ = end;
    note_peak();
    return {device_, reinterpret_cast<T*>(block_ + start), count};
  }

  /// `permanent`, filled with a copy of `host`.
  template <class T>
  Array<T> permanent_copy(std::span<const T> host) {
    Array<T> array = permanent<T>(host.size());
    array.upload(host);
    return array;
  }

  /// Gives the permanent array that was made last another length; what it holds stays. Throws Error, and leaves the
  /// array as it was, when the block is full.
  template <class T>
  void resize_last(Array<T>& array, std::size_t count) {
    const std::size_t start = std::size_t(reinterpret_cast<std::uint8_t*>(array.data()) - block_), head = head_;
    assert(start + aligned(array.bytes()) == head_);
    head_ = start;
    const bool enough = fits(count, sizeof(T));
    head_ = head;
    if (!enough) require(count, sizeof(T));
    const std::size_t end = start + aligned(count * sizeof(T));
    device_.commit(block_, start, end);
    head_ = end;
    note_peak();
    array = {device_, array.data(), count};
  }

  /// `count` elements that last until the innermost Scope ends.
  template <class T>
  Array<T> temporary(std::size_t count) {
    require(count, sizeof(T));
    const std::size_t start = tail_ - aligned(count * sizeof(T));
    device_.commit(block_, start, tail_);
    tail_ = start;
    note_peak();
    return {device_, reinterpret_cast<T*>(block_ + tail_), count};
  }

  /// Gives the temporaries made during its life back.
  class Scope {
   public:
    explicit Scope(Arena& arena) : arena_(arena), tail_(arena.tail_) {}
    ~Scope() { arena_.tail_ = tail_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Arena& arena_;
    std::size_t tail_;
  };

  std::size_t mark() const { return head_; }       ///< where the head is now
  void rewind(std::size_t mark) { head_ = mark; }  ///< drops every permanent array made after `mark`
  /// Lets others have the memory of what was dropped. It comes back when it is used again.
  void give_back() { device_.give_back(block_, head_, tail_); }
  std::size_t free_bytes() const { return tail_ - head_; }
  /// As far as the device has memory for it now: for estimates that are made before the work.
  std::size_t room_bytes() const { return device_.obtainable_bytes(block_, head_, tail_); }
  std::size_t peak_bytes() const { return peak_; }
  Device& device() const { return device_; }

  /// What an array of so many bytes takes.
  static std::size_t aligned(std::size_t bytes) { return (bytes + 255) / 256 * 256; }

 private:
  bool fits(std::size_t count, std::size_t size) const {
    return count <= free_bytes() / size && aligned(count * size) <= free_bytes();
  }

  void require(std::size_t count, std::size_t size) const {
    if (!fits(count, size))
      throw Error("not enough memory on the device",
                  std::to_string((count >> 10) * size >> 10) + " MiB asked, " + std::to_string(free_bytes() >> 20) +
                      " MiB free",
                  device_.too_small("lower the resolution"));
  }

  void note_peak() { peak_ = std::max(peak_, capacity_ - free_bytes()); }

  Device& device_;
  std::size_t capacity_;
  std::uint8_t* block_;
  std::size_t head_ = 0;
  std::size_t tail_;
  std::size_t peak_ = 0;
};

}  // namespace nacre
