// Nacre: reserved addresses and the memory behind them, by the driver's virtual memory management.
#if NACRE_HAS_CUDA

#include "compute/device/cuda_reservation.hpp"

#if NACRE_HIP

#include "compute/device/error.hpp"

namespace nacre {

CudaReservation::CudaReservation(int device, std::size_t) : device_(device) {
  throw Error("no addresses without memory", "HIP 5 does not reserve them on every card");
}
CudaReservation::~CudaReservation() = default;
std::size_t CudaReservation::commit(std::size_t, std::size_t) { return 0; }

}  // namespace nacre

#else

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <algorithm>
#include <string>

#include "compute/device/cuda_check.hpp"

namespace nacre {
namespace {

constexpr std::size_t least_piece = std::size_t(64) << 20;

/// The driver's function of that name: the program does not link the driver, which a machine without a GPU lacks.
/// Throws Error where it has none.
template <class Function>
Function* driver_function(const char* name) {
  void* found = nullptr;
  cudaDriverEntryPointQueryResult result{};
#if CUDART_VERSION >= 12050
  const cudaError_t status = cudaGetDriverEntryPointByVersion(name, &found, 12000, cudaEnableDefault, &result);
#else
  const cudaError_t status = cudaGetDriverEntryPoint(name, &found, cudaEnableDefault, &result);
#endif
  cuda_check(status, name);
  if (result != cudaDriverEntryPointSuccess || !found) throw Error(std::string("the GPU's driver has no ") + name);
  return reinterpret_cast<Function*>(found);
}

struct Driver {
  decltype(cuMemGetAllocationGranularity)* granularity =
      driver_function<decltype(cuMemGetAllocationGranularity)>("cuMemGetAllocationGranularity");
  decltype(cuMemAddressReserve)* reserve = driver_function<decltype(cuMemAddressReserve)>("cuMemAddressReserve");
  decltype(cuMemAddressFree)* free = driver_function<decltype(cuMemAddressFree)>("cuMemAddressFree");
  decltype(cuMemCreate)* create = driver_function<decltype(cuMemCreate)>("cuMemCreate");
  decltype(cuMemRelease)* release = driver_function<decltype(cuMemRelease)>("cuMemRelease");
  decltype(cuMemMap)* map = driver_function<decltype(cuMemMap)>("cuMemMap");
  decltype(cuMemUnmap)* unmap = driver_function<decltype(cuMemUnmap)>("cuMemUnmap");
  decltype(cuMemSetAccess)* set_access = driver_function<decltype(cuMemSetAccess)>("cuMemSetAccess");
};

const Driver& driver() {
  static const Driver functions;
  return functions;
}

void driver_check(CUresult status, const char* what) {
  if (status != CUDA_SUCCESS)
    throw Error(std::string("CUDA: ") + what + " failed", "driver's error " + std::to_string(int(status)));
}

CUmemAllocationProp properties(int device) {
  CUmemAllocationProp wanted{};
  wanted.type = CU_MEM_ALLOCATION_TYPE_PINNED;
  wanted.location.type = CU_MEM_LOCATION_TYPE_DEVICE;
  wanted.location.id = device;
  return wanted;
}

}  // namespace

CudaReservation::CudaReservation(int device, std::size_t bytes) : device_(device) {
  const CUmemAllocationProp wanted = properties(device);
  std::size_t granularity = 0;
  driver_check(driver().granularity(&granularity, &wanted, CU_MEM_ALLOC_GRANULARITY_RECOMMENDED), "asking for a page");
  piece_bytes_ = (least_piece + granularity - 1) / granularity * granularity;
  piece_.resize((bytes + piece_bytes_ - 1) / piece_bytes_);
  bytes_ = piece_.size() * piece_bytes_;
  CUdeviceptr address = 0;
  driver_check(driver().reserve(&address, bytes_, 0, 0, 0), "reserving addresses");
  address_ = address;
}

CudaReservation::~CudaReservation() {
  for (std::size_t k = 0; k < piece_.size(); ++k) {
    if (!piece_[k]) continue;
    driver().unmap(address_ + k * piece_bytes_, piece_bytes_);
    driver().release(piece_[k]);
  }
  driver().free(address_, bytes_);
}

std::size_t CudaReservation::commit(std::size_t from, std::size_t to) {
  const std::size_t before = committed_;
  for (std::size_t k = from / piece_bytes_; k * piece_bytes_ < to; ++k)
    if (!piece_[k]) take(k);
  return committed_ - before;
}

void CudaReservation::take(std::size_t piece) {
  const CUmemAllocationProp wanted = properties(device_);
  CUmemGenericAllocationHandle handle = 0;
  if (driver().create(&handle, piece_bytes_, &wanted, 0) != CUDA_SUCCESS)
    throw Error("not enough memory on the GPU",
                std::to_string(committed_ >> 20) + " MiB are taken, and another program may have the rest",
                "lower the resolution, or use `device` cpu");
  const CUdeviceptr address = address_ + piece * piece_bytes_;
  CUmemAccessDesc access{};
  access.location = wanted.location;
  access.flags = CU_MEM_ACCESS_FLAGS_PROT_READWRITE;
  CUresult status = driver().map(address, piece_bytes_, 0, handle, 0);
  if (status == CUDA_SUCCESS) {
    status = driver().set_access(address, piece_bytes_, &access, 1);
    if (status != CUDA_SUCCESS) driver().unmap(address, piece_bytes_);
  }
  if (status != CUDA_SUCCESS) driver().release(handle);
  driver_check(status, "mapping memory");
  piece_[piece] = handle;
  committed_ += piece_bytes_;
}

}  // namespace nacre

#endif
#endif
