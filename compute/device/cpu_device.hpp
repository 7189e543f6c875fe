// Nacre: the CPU as a device.
#pragma once

#include <atomic>
#include <map>
#include <mutex>

#include "compute/device/device.hpp"
#include "compute/device/worker_arena.hpp"

namespace nacre {

class CpuDevice final : public Device {
 public:
  CpuDevice(int threads, bool remote);
  ~CpuDevice() override;

  std::string backend() const override { return "cpu"; }
  std::string name() const override;
  int threads() const override { return threads_; }
  void* allocate(std::size_t bytes) override;
  void deallocate(void* block, std::size_t bytes) noexcept override;
  bool shares_host_memory() const override { return !remote_; }
  void give_back(void* block, std::size_t from, std::size_t to) override;
  void copy_to_device(void* to, const void* host, std::size_t bytes) override;
  void copy_to_host(void* host, const void* from, std::size_t bytes) override;
  void fill(void* to, unsigned char value, std::size_t bytes) override;
  void synchronize() override {}
  std::size_t available_bytes() const override;
  std::size_t arena_bytes() const override;
  std::size_t peak_bytes() const override;

  bool remote() const { return remote_; }
  tbb::task_arena& workers() { return workers_.get(); }

  /// While one lives, a remote device's memory is open to its kernels.
  class Access {
   public:
    explicit Access(CpuDevice& device) : device_(device) { device_.open(); }
    ~Access() { device_.close(); }
    Access(const Access&) = delete;
    Access& operator=(const Access&) = delete;

   private:
    CpuDevice& device_;
  };

 private:
  void open();
  void close();
  void protect(int protection);

  int threads_;
  bool remote_;
  WorkerArena workers_;
  std::mutex mutex_;
  int open_ = 0;
  std::map<void*, std::size_t> blocks_;
};

}  // namespace nacre
