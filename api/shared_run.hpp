// Nacre: the processes of a library user, as the engine sees them.
#pragma once

#include "compute/device/ranks.hpp"
#include "include/nacre/processes.hpp"

namespace nacre {

/// Counts what is sent, and how long it takes. Throws Error where rank and count do not fit each other.
class RanksOfCaller final : public Ranks {
 public:
  explicit RanksOfCaller(Processes& processes);

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  void sum(std::span<std::uint64_t> values) override;
  std::vector<Bytes> exchange(const std::vector<Bytes>& send) override;
  void begin(std::span<const Part> send, std::span<const Part> receive) override;
  void finish() override;
  std::uint64_t sent_bytes() const override { return sent_; }
  double waited_seconds() const override { return waited_; }

 private:
  Processes& processes_;
  int rank_, count_;
  std::uint64_t sent_ = 0;
  double waited_ = 0;
  std::vector<Processes::Part> to_, from_;  ///< of the exchange that has begun
};

}  // namespace nacre
