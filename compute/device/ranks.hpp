// Nacre: the processes that work on one run together, as the numerics see them; who carries their messages is not known
// here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

/// Processes 0 .. count() - 1, of which this is one. All of them call the same members in the same order; every call
/// waits for those that it exchanges with. Throws Interrupted when the user asks to stop, Error where a message fails.
class Ranks {
 public:
  using Bytes = std::vector<std::byte>;

  /// A part of an exchange whose length both sides know.
  struct Part {
    int rank;  ///< the other one
    std::span<std::byte> bytes;
  };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int count() const = 0;
  bool first() const { return rank() == 0; }

  /// Replaces each entry by its sum over all processes; 64-bit integers, so that the sum is exact in any order.
  virtual void sum(std::span<std::uint64_t> values) = 0;
  /// Sends `send[q]` to process q, for all q; returns what came from each.
  virtual std::vector<Bytes> exchange(const std::vector<Bytes>& send) = 0;
  /// Begins the same with neighbours alone, into memory that is there; at most one part for each process on either
  /// side. Until `finish` returns, the memory is not touched and no other exchange begins.
  virtual void begin(std::span<const Part> send, std::span<const Part> receive) = 0;
  /// Lets messages move on; called now and then by who works meanwhile.
  virtual void progress() {}
  virtual void finish() = 0;
  void exchange(std::span<const Part> send, std::span<const Part> receive) {
    begin(send, receive);
    finish();
  }

  /// What this process has sent so far, and how long it has waited for others.
  virtual std::uint64_t sent_bytes() const = 0;
  virtual double waited_seconds() const = 0;
};

}  // namespace nacre
