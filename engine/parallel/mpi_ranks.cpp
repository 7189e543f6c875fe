// Nacre: the processes of one run, by MPI.
#include "engine/parallel/mpi_ranks.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "compute/device/error.hpp"
#include "compute/device/exchange_bytes.hpp"

namespace nacre {
namespace {

constexpr int tag = 27;
constexpr std::size_t most_bytes = std::size_t(1) << 30;  // of one message: MPI counts in int

void check(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw Error(std::string("the processes cannot ") + what, std::string(text, std::size_t(length)));
}

class MpiRanks final : public Ranks {
 public:
  explicit MpiRanks(const std::atomic<bool>* stop) : stop_(stop) {
    int provided = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "join each other");
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
  }
  ~MpiRanks() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  std::uint64_t sent_bytes() const override { return sent_; }
  double waited_seconds() const override { return waited_; }

  void sum(std::span<std::uint64_t> values) override {
    if (count_ == 1) return;
    MPI_Request request;
    check(MPI_Iallreduce(MPI_IN_PLACE, values.data(), int(values.size()), MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD,
                         &request),
          "add up their numbers");
    wait({&request, 1}, "add up their numbers");
    sent_ += values.size_bytes();
  }

  std::vector<Bytes> exchange(const std::vector<Bytes>& send) override {
    std::vector<std::uint64_t> out(static_cast<std::size_t>(count_)), in(out.size());
    for (std::size_t q = 0; q < out.size(); ++q) out[q] = send[q].size();
    MPI_Request request;
    check(MPI_Ialltoall(out.data(), 1, MPI_UINT64_T, in.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD, &request),
          "tell each other what comes");
    wait({&request, 1}, "tell each other what comes");
    return exchange_bytes(*this, send, in);
  }

  void begin(std::span<const Part> send, std::span<const Part> receive) override {
    const auto each_piece = [](const Part& part, const auto& visit) {
      for (std::size_t at = 0; at < part.bytes.size(); at += most_bytes)
        visit(part.bytes.data() + at, int(std::min(most_bytes, part.bytes.size() - at)));
    };
    for (const Part& part : receive)
      each_piece(part, [&](std::byte* data, int size) {
        check(MPI_Irecv(data, size, MPI_BYTE, part.rank, tag, MPI_COMM_WORLD, &requests_.emplace_back()), "receive");
      });
    for (const Part& part : send)
      each_piece(part, [&](std::byte* data, int size) {
        check(MPI_Isend(data, size, MPI_BYTE, part.rank, tag, MPI_COMM_WORLD, &requests_.emplace_back()), "send");
        sent_ += std::uint64_t(size);
      });
  }

  void progress() override {
    int done = 0;
    check(MPI_Testall(int(requests_.size()), requests_.data(), &done, MPI_STATUSES_IGNORE), exchanging);
  }

  void finish() override {
    wait(requests_, exchanging);
    requests_.clear();
  }

 private:
  static constexpr const char* exchanging = "exchange what they have";

  /// Until all are done; looks at the user's wish to stop meanwhile, and leaves the processor to others.
  void wait(std::span<MPI_Request> requests, const char* what) {
    const auto begun = std::chrono::steady_clock::now();
    auto pause = std::chrono::microseconds(1);
    for (int done = 0;;) {
      check(MPI_Testall(int(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE), what);
      if (done) break;
      check_stop(stop_);
      if (std::chrono::steady_clock::now() - begun < std::chrono::microseconds(200)) {
        std::this_thread::yield();
        continue;
      }
      std::this_thread::sleep_for(pause);
      pause = std::min(pause * 2, std::chrono::microseconds(1000));
    }
    waited_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }

  const std::atomic<bool>* stop_;
  int rank_ = 0, count_ = 1;
  std::uint64_t sent_ = 0;
  double waited_ = 0;
  std::vector<MPI_Request> requests_;  ///< of the exchange that has begun
};

}  // namespace

std::unique_ptr<Ranks> join_mpi_ranks(const std::atomic<bool>* stop) { return std::make_unique<MpiRanks>(stop); }

void end_mpi_ranks(int status) {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status);
}

}  // namespace nacre
