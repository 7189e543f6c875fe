// Nacre: device memory that grows in place: addresses are reserved at once, memory is taken piece by piece.
#pragma once

#include <cstddef>
#include <vector>

namespace nacre {

/// Address space on the current CUDA device, and the memory behind those parts of it that were committed.
class CudaReservation {
 public:
  /// Throws Error where the device or its driver cannot do this: then memory must be allocated whole.
  CudaReservation(int device, std::size_t bytes);
  /// Nothing may use the memory any more.
  ~CudaReservation();
  CudaReservation(const CudaReservation&) = delete;
  CudaReservation& operator=(const CudaReservation&) = delete;

  void* data() const { return reinterpret_cast<void*>(address_); }
  /// Puts memory behind bytes `from` to `to`, in pieces; those that have some keep it. Returns how many bytes were
  /// taken. Throws Error, and keeps what it got so far, where the device has no more.
  std::size_t commit(std::size_t from, std::size_t to);
  std::size_t committed_bytes() const { return committed_; }
  /// In the pieces that lie between bytes `from` and `to` as a whole.
  std::size_t committed_bytes(std::size_t from, std::size_t to) const {
    std::size_t bytes = 0;
    for (std::size_t k = (from + piece_bytes_ - 1) / piece_bytes_; (k + 1) * piece_bytes_ <= to; ++k)
      bytes += piece_[k] ? piece_bytes_ : 0;
    return bytes;
  }

 private:
  void take(std::size_t piece);

  int device_;
  std::size_t piece_bytes_ = 0, bytes_ = 0, committed_ = 0;
  unsigned long long address_ = 0;
  std::vector<unsigned long long> piece_;  ///< the driver's handles; 0 where there is none
};

}  // namespace nacre
