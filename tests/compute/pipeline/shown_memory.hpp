// Nacre: what a renderer lends to a mesh pipeline, and whether the right particles came.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre::test {

/// Memory of the device beside the pipeline's.
template <class T>
class Lent {
 public:
  Lent(Device& device, std::int64_t count)
      : device_(device),
        bytes_(std::size_t(count) * sizeof(T)),
        data_(static_cast<T*>(device.allocate(std::max<std::size_t>(bytes_, 256)))) {
    device.fill(data_, 0x5a, bytes_);
  }
  ~Lent() { device_.deallocate(data_, std::max<std::size_t>(bytes_, 256)); }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

  T* data() const { return data_; }
  std::int64_t size() const { return std::int64_t(bytes_ / sizeof(T)); }
  std::vector<T> view() const {
    std::vector<T> host(bytes_ / sizeof(T));
    device_.copy_to_host(host.data(), data_, bytes_);
    return host;
  }
  bool untouched() const {
    std::vector<unsigned char> host(bytes_);
    device_.copy_to_host(host.data(), data_, bytes_);
    return std::all_of(host.begin(), host.end(), [](unsigned char b) { return b == 0x5a; });
  }

 private:
  Device& device_;
  std::size_t bytes_;
  T* data_;
};

inline ShownParticles shown_memory(const Lent<Float4>& position, const Lent<Float4>& direction) {
  return {position.data(), direction.data(), std::min(position.size(), direction.size())};
}

/// Junction order of the shown particle number i.
inline int order_of(const ShownCounts& counts, std::int64_t i) {
  return i < counts.points ? 0 : i < counts.points + counts.curves ? 1 : 2;
}

/// The particles of `particles()`, order by order, each order as it lies there, are the shown ones.
inline void expect_shown(MeshPipeline& pipeline, const Lent<Float4>& to_position, const Lent<Float4>& to_direction) {
  const ShownCounts counts = pipeline.show_particles(shown_memory(to_position, to_direction));
  const MeshParticles all = pipeline.particles();
  ASSERT_EQ(counts.total(), std::int64_t(all.points.size()));
  const std::vector<Float4> position = to_position.view(), direction = to_direction.view();
  const VoxelFrame frame = pipeline.voxel_frame();
  const double unit = length(frame.axes[0]);
  std::int64_t at = 0;
  for (int order = 0; order < 3; ++order)
    for (std::size_t i = 0; i < all.points.size(); ++i) {
      if (all.order[i] != order) continue;
      ASSERT_EQ(order_of(counts, at), order);
      const Float4 p = position[std::size_t(at)], d = direction[std::size_t(at)];
      EXPECT_LT(length(frame.to_world({p.x, p.y, p.z}) - all.points[i]), 1e-9);
      EXPECT_FLOAT_EQ(float(p.w * unit), all.size[i]);
      const Vec3d turned = (frame.to_world({d.x, d.y, d.z}) - frame.origin) / unit;
      EXPECT_LT(length(turned - Vec3d(all.normal[i])), 1e-6);
      EXPECT_EQ(d.w, all.energy[i]);
      ++at;
    }
}

}  // namespace nacre::test
