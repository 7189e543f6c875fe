// Nacre: what a run can compute on.
#pragma once

#include <string>
#include <vector>

#include "export.hpp"

namespace nacre {

/// A processor or a GPU.
struct DeviceDescription {
  std::string request;  ///< what to write into RunOptions::device: "cpu", "cuda:0", ...
  std::string backend;  ///< "cpu" or "cuda"
  std::string name;     ///< of the processor
};

/// The devices of this machine that this build can use; the CPU first.
NACRE_API std::vector<DeviceDescription> devices();

/// Why a machine with a driver of NVIDIA's does not use its GPU, as a sentence; empty where it does, or has none.
NACRE_API std::string why_no_gpu();

}  // namespace nacre
