// Nacre: memory of the emulated device, and what it says about itself.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include "tests/emulated/runtime/settings.hpp"
#include "tests/emulated/runtime/stream.hpp"

using namespace emulated;

namespace {

constexpr std::size_t page = 4096;
constexpr int rubbish = 0xcb;  // what memory holds at first

struct Memory {
  std::map<void*, std::size_t> blocks;
  std::size_t used = 0;
};
Memory& memory() {
  static Memory all;
  return all;
}

constexpr std::size_t piece = std::size_t(16) << 20;

/// A file of rubbish that blocks are mapped from: pages are copied when they are first written, so that a large block whose
/// most is not touched costs nothing.
int rubbish_file() {
  static const int file = [] {
    const int made = memfd_create("rubbish", 0);
    if (made < 0 || ftruncate(made, piece) != 0) broken("no memory to fill new blocks from");
    void* all = mmap(nullptr, piece, PROT_READ | PROT_WRITE, MAP_SHARED, made, 0);
    if (all == MAP_FAILED) broken("no memory to fill new blocks from");
    std::memset(all, rubbish, piece);
    munmap(all, piece);
    return made;
  }();
  return file;
}

std::size_t mapped_bytes(std::size_t bytes) { return (bytes + page - 1) / page * page + page; }

}  // namespace

cudaError_t cudaSetDevice(int device) { return device == 0 ? cudaSuccess : fail(cudaErrorInvalidDevice); }

cudaError_t cudaGetDevice(int* device) {
  *device = 0;
  return cudaSuccess;
}

cudaError_t cudaGetDeviceCount(int* count) {
  *count = 1;
  return cudaSuccess;
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
  if (device != 0) return fail(cudaErrorInvalidDevice);
  *properties = {};
  std::snprintf(properties->name, sizeof properties->name, "emulated, seed %u", settings().seed);
  properties->major = 9;
  properties->multiProcessorCount = 4;
  return cudaSuccess;
}

cudaError_t cudaDeviceSynchronize() {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  run_all_streams();
  return cudaSuccess;
}

cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) {
  const std::scoped_lock held(lock());
  *total = settings().memory;
  *free = *total - memory().used;
  return cudaSuccess;
}

/// What lies behind a block cannot be touched.
cudaError_t cudaMalloc(void** block, std::size_t bytes) {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  if (bytes > settings().memory - memory().used) return fail(cudaErrorMemoryAllocation);
  const std::size_t mapped = mapped_bytes(bytes);
  void* const start = mmap(nullptr, mapped, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (start == MAP_FAILED) return fail(cudaErrorMemoryAllocation);
  for (std::size_t at = 0; at < mapped - page; at += piece)
    if (mmap(static_cast<char*>(start) + at, std::min(piece, mapped - page - at), PROT_READ | PROT_WRITE,
             MAP_PRIVATE | MAP_FIXED | MAP_NORESERVE, rubbish_file(), 0) == MAP_FAILED)
      broken("a block cannot be mapped");
  *block = start;
  memory().blocks[*block] = bytes;
  memory().used += bytes;
  return cudaSuccess;
}

/// Waits for all that may still use the block.
cudaError_t cudaFree(void* block) {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureUnsupported);
  run_all_streams();
  if (!block) return cudaSuccess;
  const auto found = memory().blocks.find(block);
  if (found == memory().blocks.end()) broken("memory is given back that was not allocated, or twice");
  memory().used -= found->second;
  munmap(block, mapped_bytes(found->second));
  memory().blocks.erase(found);
  return cudaSuccess;
}

/// Goes through the default stream, which a capture forbids and which our own streams do not wait for.
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind) {
  const std::scoped_lock held(lock());
  if (this_thread_captures()) return fail(cudaErrorStreamCaptureImplicit);
  std::memmove(to, from, bytes);
  return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream) {
  if (this_thread_captures() && kind != cudaMemcpyDeviceToDevice) return fail(cudaErrorStreamCaptureUnsupported);
  if (kind != cudaMemcpyHostToDevice) return enqueue(stream, "copy", [=] { std::memmove(to, from, bytes); });
  const auto* first = static_cast<const char*>(from);
  return enqueue(stream, "upload", [to, staged = std::vector<char>(first, first + bytes)] {
    std::copy(staged.begin(), staged.end(), static_cast<char*>(to));
  });
}

cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes, cudaStream_t stream) {
  return enqueue(stream, "fill", [=] { std::memset(to, value, bytes); });
}
