// Nacre: threads that act as the processes of a shared run, without MPI.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "include/nacre/processes.hpp"

namespace nacre {

/// What all of them share.
class Post {
 public:
  explicit Post(int count) : count_(count) {}
  int count() const { return count_; }

  /// The sum of what all have handed in.
  void sum(std::span<std::uint64_t> numbers) {
    std::unique_lock lock(mutex_);
    const std::uint64_t round = round_;
    if (there_++ == 0) sum_.assign(numbers.size(), 0);
    for (std::size_t k = 0; k < numbers.size(); ++k) sum_[k] += numbers[k];
    if (there_ == count_) {
      result_ = sum_;
      there_ = 0;
      ++round_;
      changed_.notify_all();
    } else {
      changed_.wait(lock, [&] { return round_ != round; });
    }
    std::copy(result_.begin(), result_.end(), numbers.begin());
  }

  void send(int from, int to, std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex_);
    letters_[{from, to}].emplace_back(bytes.begin(), bytes.end());
    changed_.notify_all();
  }

  void receive(int from, int to, std::span<std::byte> bytes) {
    std::unique_lock lock(mutex_);
    auto& box = letters_[{from, to}];
    changed_.wait(lock, [&] { return !box.empty(); });
    if (box.front().size() != bytes.size()) std::terminate();  // both sides have to agree
    std::memcpy(bytes.data(), box.front().data(), bytes.size());
    box.erase(box.begin());
  }

 private:
  int count_, there_ = 0;
  std::uint64_t round_ = 0;
  std::vector<std::uint64_t> sum_, result_;
  std::map<std::pair<int, int>, std::vector<std::vector<std::byte>>> letters_;
  std::mutex mutex_;
  std::condition_variable changed_;
};

class ThreadProcesses final : public Processes {
 public:
  ThreadProcesses(Post& post, int rank) : post_(post), rank_(rank) {}
  int rank() const override { return rank_; }
  int count() const override { return post_.count(); }
  void sum(std::span<std::uint64_t> numbers) override { post_.sum(numbers); }
  void exchange(std::span<const Part> send, std::span<const Part> receive) override {
    for (const Part& part : send) post_.send(rank_, part.rank, part.bytes);
    for (const Part& part : receive) post_.receive(part.rank, rank_, part.bytes);
  }

 private:
  Post& post_;
  int rank_;
};

/// Runs `job(own)` on `count` threads, each with an `Own` of its number, and returns when all have ended. `job` must
/// not throw.
template <class Own, class Job>
void on_threads(int count, const Job& job) {
  Post post(count);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank)
    threads.emplace_back([&post, &job, rank] {
      Own own(post, rank);
      job(own);
    });
  for (std::thread& thread : threads) thread.join();
}

/// Runs `job(processes)` as `count` processes.
inline void on_processes(int count, const std::function<void(Processes&)>& job) {
  on_threads<ThreadProcesses>(count, job);
}

}  // namespace nacre
