// Nacre: memory of the emulated device, and what it says about itself.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include "compute/device/cuda_reservation.hpp"
#include "compute/device/error.hpp"
#include "tests/emulated/runtime/settings.hpp"
#include "tests/emulated/runtime/stream.hpp"

using namespace emulated;

namespace {

constexpr std::size_t page = 4096;
constexpr int rubbish = 0xcb;  // what memory holds at first
constexpr std::size_t piece = std::size_t(16) << 20;

struct Memory {
  std::map<void*, std::size_t> blocks;
  std::size_t used = 0;
};
Memory& memory() {
  static Memory all;
  return all;
}

/// A file of rubbish that blocks are mapped from: pages are copied when they are first written, so that a large block
/// whose most is not touched costs nothing.
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

bool& draws_screen() {
  static bool draws = settings().screen;
  return draws;
}

std::size_t whole_pages(std::size_t bytes) { return (bytes + page - 1) / page * page; }

/// Addresses that cannot be touched, and a page behind them.
char* reserve_addresses(std::size_t bytes) {
  void* start = mmap(nullptr, whole_pages(bytes) + page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return start == MAP_FAILED ? nullptr : static_cast<char*>(start);
}
void give_addresses_back(void* start, std::size_t bytes) { munmap(start, whole_pages(bytes) + page); }

/// Puts rubbish behind reserved addresses; false where that is more than the device has.
bool take_memory(char* start, std::size_t bytes) {
  if (bytes > settings().memory - memory().used) return false;
  for (std::size_t at = 0; at < bytes; at += piece)
    if (mmap(start + at, whole_pages(std::min(piece, bytes - at)), PROT_READ | PROT_WRITE,
             MAP_PRIVATE | MAP_FIXED | MAP_NORESERVE, rubbish_file(), 0) == MAP_FAILED)
      broken("memory cannot be mapped");
  memory().used += bytes;
  return true;
}

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

void emulated::draw_screen(bool draws) { draws_screen() = draws; }

cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int device) {
  if (device != 0 || attribute != cudaDevAttrKernelExecTimeout) return fail(cudaErrorInvalidValue);
  *value = draws_screen();
  return cudaSuccess;
}

cudaError_t cudaDriverGetVersion(int* version) {
  *version = 13000;
  return cudaSuccess;
}

cudaError_t cudaRuntimeGetVersion(int* version) { return cudaDriverGetVersion(version); }

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
  if (bytes > settings().memory) return fail(cudaErrorMemoryAllocation);
  char* const start = reserve_addresses(bytes);
  if (!start) return fail(cudaErrorMemoryAllocation);
  if (!take_memory(start, bytes)) {
    give_addresses_back(start, bytes);
    return fail(cudaErrorMemoryAllocation);
  }
  memory().blocks[start] = bytes;
  *block = start;
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
  give_addresses_back(block, found->second);
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

namespace nacre {

// In position of compute/device/cuda_reservation.cpp, in smaller pieces: what touches memory that was not asked for,
// crashes.
CudaReservation::CudaReservation(int device, std::size_t bytes) : device_(device), piece_bytes_(std::size_t(1) << 16) {
  const std::scoped_lock held(lock());
  piece_.resize((bytes + piece_bytes_ - 1) / piece_bytes_);
  bytes_ = piece_.size() * piece_bytes_;
  char* const start = reserve_addresses(bytes_);
  if (!start) throw Error("no addresses");
  address_ = reinterpret_cast<unsigned long long>(start);
}

CudaReservation::~CudaReservation() {
  const std::scoped_lock held(lock());
  run_all_streams();
  memory().used -= committed_;
  give_addresses_back(data(), bytes_);
}

std::size_t CudaReservation::commit(std::size_t from, std::size_t to) {
  const std::size_t before = committed_;
  for (std::size_t k = from / piece_bytes_; k * piece_bytes_ < to; ++k)
    if (!piece_[k]) take(k);
  return committed_ - before;
}

void CudaReservation::take(std::size_t k) {
  const std::scoped_lock held(lock());
  if (!take_memory(static_cast<char*>(data()) + k * piece_bytes_, piece_bytes_))
    throw Error("not enough memory on the GPU", "", "lower the resolution, or use `device` cpu");
  piece_[k] = 1;
  committed_ += piece_bytes_;
}

}  // namespace nacre
