// Nacre: what the programs that run a peer share: a label image and its frame, plain surfaces, results as lines of
// words.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/io/reader.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/scene/volume/materials.hpp"

namespace nacre {

/// Labels on voxels as `nacre mesh` sees them. Index coordinates have voxel centres at whole numbers.
struct LabelImage {
  explicit LabelImage(const std::string& path)
      : volume(make_mesh_volume(std::vector<Volume>{read_volume(path)}, MaterialOptions())) {
    if (volume.kind != MeshVolume::Kind::labels) throw Error(path + " holds no labels", "", "name a label image");
  }

  /// Material at a voxel; 0, the outside, beyond the image.
  int at(int x, int y, int z) const {
    const Int3& n = volume.dims;
    if (x < 0 || y < 0 || z < 0 || x >= n.x || y >= n.y || z >= n.z) return 0;
    return volume.material[x + std::size_t(n.x) * (y + std::size_t(n.y) * z)];
  }

  Vec3d to_index(const Vec3d& p) const {
    const Vec3d q = p - volume.origin;
    return {dot(q, volume.axes[0]) / volume.spacing.x, dot(q, volume.axes[1]) / volume.spacing.y,
            dot(q, volume.axes[2]) / volume.spacing.z};
  }

  Vec3d to_world(const Vec3d& p) const {
    return volume.origin + volume.axes[0] * (p.x * volume.spacing.x) + volume.axes[1] * (p.y * volume.spacing.y) +
           volume.axes[2] * (p.z * volume.spacing.z);
  }

  MeshVolume volume;
};

/// Writes OFF with all digits: others round in reading what we write.
inline void write_off(const std::string& path, const std::vector<Vec3d>& points,
                      const std::vector<Triangle>& triangles) {
  std::ofstream out(path);
  out.precision(17);
  out << "OFF\n" << points.size() << ' ' << triangles.size() << " 0\n";
  for (const Vec3d& p : points) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Triangle& t : triangles) out << "3 " << t.a << ' ' << t.b << ' ' << t.c << '\n';
  if (!out.flush()) throw Error(path + " cannot be written", "", "is the folder there, and the disk not full?");
}

/// One result: a word and its value, as run.sh reads them.
inline void tell(const char* name, double value) { std::printf("%s %.6g\n", name, value); }

/// Wall time of `work`, seconds.
template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace nacre
