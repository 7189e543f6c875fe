// Nacre: threads that act as the processes of a run, for tests of what these do together.
#pragma once

#include <functional>
#include <vector>

#include "compute/device/exchange_bytes.hpp"
#include "compute/device/ranks.hpp"
#include "tests/api/thread_processes.hpp"

namespace nacre {

class ThreadRanks final : public Ranks {
 public:
  ThreadRanks(Post& post, int rank) : post_(post), rank_(rank) {}
  int rank() const override { return rank_; }
  int count() const override { return post_.count(); }
  void sum(std::span<std::uint64_t> values) override { post_.sum(values); }

  std::vector<Bytes> exchange(const std::vector<Bytes>& send) override {
    std::vector<std::uint64_t> sizes(send.size() * send.size()), coming;  // from each to each
    for (std::size_t q = 0; q < send.size(); ++q) sizes[std::size_t(rank_) * send.size() + q] = send[q].size();
    sum(sizes);
    for (std::size_t q = 0; q < send.size(); ++q) coming.push_back(sizes[q * send.size() + std::size_t(rank_)]);
    return exchange_bytes(*this, send, coming);
  }
  void begin(std::span<const Part> send, std::span<const Part> receive) override {
    for (const Part& part : send) post_.send(rank_, part.rank, part.bytes);
    coming_.assign(receive.begin(), receive.end());
  }
  void finish() override {
    for (const Part& part : coming_) post_.receive(part.rank, rank_, part.bytes);
  }
  std::uint64_t sent_bytes() const override { return 0; }
  double waited_seconds() const override { return 0; }

 private:
  Post& post_;
  int rank_;
  std::vector<Part> coming_;
};

/// Runs `job(ranks)` as `count` processes.
inline void on_ranks(int count, const std::function<void(Ranks&)>& job) { on_threads<ThreadRanks>(count, job); }

}  // namespace nacre
