// Nacre: stars found on the CPU, for tests of what is made of them.
#pragma once

#include <memory>

#include "compute/device/executor_cpu.hpp"
#include "compute/meshing/device_stars.hpp"
#include "tests/compute/meshing/star_clouds.hpp"

namespace nacre::test {

/// Finds stars on the CPU.
class CpuStars {
 public:
  explicit CpuStars(int threads = 0) : device_(make_cpu_device(threads)), exec_(*device_), stars_(exec_) {}

  FoundStars& find(const Cloud& cloud) { return stars_.find(cloud.view()); }
  StarMesh mesh(const Cloud& cloud) { return mesh_from_stars(cloud.view(), stars_); }

 private:
  std::unique_ptr<Device> device_;
  Executor<Cpu> exec_;
  DeviceStars<Cpu> stars_;
};

/// Of all stars anew.
inline StarMesh mesh_of(const Cloud& cloud, int threads = 0) { return CpuStars(threads).mesh(cloud); }

}  // namespace nacre::test
