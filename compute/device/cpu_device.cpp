// Nacre: the CPU as a device: memory by mmap, workers by oneTBB.
#include "compute/device/cpu_device.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

std::size_t meminfo_bytes(const std::string& key) {
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;)
    if (word == key + ":") {
      std::size_t kib = 0;
      file >> kib;
      return kib * 1024;
    }
  return std::size_t(sysconf(_SC_PHYS_PAGES)) * std::size_t(sysconf(_SC_PAGE_SIZE));
}

/// Of files that were read or written once: the kernel gives it back before it refuses anything.
std::size_t cgroup_cached_bytes() {
  std::ifstream file("/sys/fs/cgroup/memory.stat");
  std::size_t bytes = 0;
  for (std::string word; file >> word >> bytes;)
    if (word == "inactive_file") return bytes;
  return 0;
}

std::size_t cgroup_free_bytes() {
  auto number = [](const char* path) {
    std::ifstream file(path);
    std::size_t value = 0;
    return (file >> value) ? value : std::numeric_limits<std::size_t>::max();
  };
  const std::size_t limit = number("/sys/fs/cgroup/memory.max");
  const std::size_t used = number("/sys/fs/cgroup/memory.current");
  if (std::max(limit, used) == std::numeric_limits<std::size_t>::max()) return limit;
  return limit - std::min(limit, used - std::min(used, cgroup_cached_bytes()));
}

/// An address-space limit (ulimit -v) also bounds what may be reserved.
std::size_t address_space_bytes() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<std::size_t>::max();
  return limit.rlim_cur;
}

}  // namespace

CpuDevice::CpuDevice(int threads, bool remote)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()), remote_(remote), workers_(threads_) {}

CpuDevice::~CpuDevice() {
  for (auto [block, bytes] : blocks_) munmap(block, bytes);
}

std::string CpuDevice::name() const {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "CPU";
}

void* CpuDevice::allocate(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 1);
  void* block = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (block == MAP_FAILED)
    throw Error("not enough memory", "asked for " + std::to_string(bytes >> 20) + " MiB", "lower the resolution");
  madvise(block, bytes, MADV_HUGEPAGE);  // random look-ups into large grids miss the TLB otherwise
  std::scoped_lock lock(mutex_);
  blocks_[block] = bytes;
  if (remote_ && open_ == 0) mprotect(block, bytes, PROT_NONE);
  return block;
}

void CpuDevice::deallocate(void* block, std::size_t bytes) noexcept {
  std::scoped_lock lock(mutex_);
  blocks_.erase(block);
  munmap(block, std::max<std::size_t>(bytes, 1));
}

void CpuDevice::give_back(void* block, std::size_t from, std::size_t to) {
  constexpr std::size_t page = std::size_t(2) << 20;  // a huge one
  const auto begin = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t first = (begin + from + page - 1) / page * page, last = (begin + to) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
}

void CpuDevice::copy_to_device(void* to, const void* host, std::size_t bytes) {
  Recording::forbid("a copy to the device");
  Access access(*this);
  if (bytes) std::memcpy(to, host, bytes);
}

void CpuDevice::copy_to_host(void* host, const void* from, std::size_t bytes) {
  Recording::forbid("a copy to the host");
  Access access(*this);
  if (bytes) std::memcpy(host, from, bytes);
}

void CpuDevice::fill(void* to, unsigned char value, std::size_t bytes) {
  Recording::forbid("a fill at once");
  Access access(*this);
  // By all threads: what is written for the first time is cleared before, huge page by huge page.
  constexpr std::size_t piece = std::size_t(2) << 20;
  if (bytes < 2 * piece) {
    if (bytes) std::memset(to, value, bytes);
    return;
  }
  workers().execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bytes, piece), [&](const auto& part) {
      std::memset(static_cast<char*>(to) + part.begin(), value, part.size());
    });
  });
}

std::size_t CpuDevice::available_bytes() const { return std::min(meminfo_bytes("MemAvailable"), cgroup_free_bytes()); }

std::size_t CpuDevice::arena_bytes() const {
  return std::min(available_bytes() / 10 * 9, address_space_bytes() / 2);  // committed page by page, when touched
}

std::size_t CpuDevice::peak_bytes() const {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::size_t(usage.ru_maxrss) * 1024;
}

void CpuDevice::open() {
  if (!remote_) return;
  std::scoped_lock lock(mutex_);
  if (open_++ == 0) protect(PROT_READ | PROT_WRITE);
}

void CpuDevice::close() {
  if (!remote_) return;
  std::scoped_lock lock(mutex_);
  if (--open_ == 0) protect(PROT_NONE);
}

void CpuDevice::protect(int protection) {
  for (auto [block, bytes] : blocks_) mprotect(block, bytes, protection);
}

std::unique_ptr<Device> make_cpu_device(int threads, bool remote) {
  return std::make_unique<CpuDevice>(threads, remote);
}

#if !NACRE_HAS_CUDA
int cuda_device_count() { return 0; }

std::string why_no_cuda() { return {}; }

std::unique_ptr<Device> make_cuda_device(std::size_t, int) {
  throw Error("no CUDA backend", "this build has none", "use `device` cpu, or build with a CUDA toolkit");
}
#endif

std::unique_ptr<Device> make_device(const std::string& request, int threads) {
  if (request == "cpu") return make_cpu_device(threads);
  if (request == "cuda") return make_cuda_device();
  if (request.rfind("cuda:", 0) == 0) {
    const std::string digits = request.substr(5);
    if (!digits.empty() && digits.size() < 4 && digits.find_first_not_of("0123456789") == std::string::npos)
      return make_cuda_device(0, std::stoi(digits));
  }
  if (request != "auto") throw Error("no device '" + request + "'", "", "use auto, cpu, cuda or cuda:NUMBER");
  return cuda_device_count() > 0 ? make_cuda_device() : make_cpu_device(threads);
}

}  // namespace nacre
