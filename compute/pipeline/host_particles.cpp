// Nacre: the particles on the host, where the improvement of the mesh takes some out and puts others in.
#include "compute/pipeline/host_particles.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <tuple>

namespace nacre {

std::vector<std::uint32_t> replace_particles(HostParticles& particles, std::span<const std::uint8_t> gone,
                                             std::span<const MeshDefects::NewPoint> born, const JunctionTable& table,
                                             const VolumeFrame& frame, std::size_t capacity) {
  auto& [position, direction, interface] = particles;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (!gone[i]) position[kept] = position[i], direction[kept] = direction[i], interface[kept++] = interface[i];
  position.resize(kept), direction.resize(kept), interface.resize(kept);
  std::vector<std::uint32_t> taken;
  for (std::uint32_t i = 0; i < born.size(); ++i) {
    const MeshDefects::NewPoint& p = born[i];
    std::array<std::uint16_t, 3> met{p.materials[0], p.materials[1], p.third};
    std::sort(met.begin(), met.end());
    const auto number = table.find(Junction(met[0], met[1], met[2]));
    if (!number || position.size() == capacity) continue;
    const Vec3d at = frame.to_voxels(p.position);
    position.push_back({float(at.x), float(at.y), float(at.z), 0});
    direction.push_back({0, 0, 0, 0});
    interface.push_back(*number);
    taken.push_back(i);
  }
  return taken;
}

std::vector<std::uint32_t> same_particles(const HostParticles& before, const HostParticles& now) {
  struct Place {
    float x, y, z;
    std::uint32_t interface, number;
  };
  const auto what = [](const Place& p) { return std::tie(p.interface, p.x, p.y, p.z); };
  const auto ascend = [&](const Place& a, const Place& b) { return what(a) < what(b); };
  const auto sorted = [&](const HostParticles& particles) {
    std::vector<Place> all;
    for (std::uint32_t i = 0; i < particles.count(); ++i) {
      const Float4& p = particles.position[i];
      all.push_back({p.x, p.y, p.z, particles.interface[i], i});
    }
    std::sort(all.begin(), all.end(), ascend);
    return all;
  };
  const std::vector<Place> old = sorted(before), fresh = sorted(now);
  std::vector<std::uint32_t> same(now.count(), none);
  for (auto at = fresh.begin(), from = old.begin(); at != fresh.end();) {
    const auto end = std::upper_bound(at, fresh.end(), *at, ascend);
    const auto [first, last] = std::equal_range(from, old.end(), *at, ascend);
    if (end - at == 1 && last - first == 1) same[at->number] = first->number;
    at = end, from = last;
  }
  return same;
}

HostParticles select(const HostParticles& particles, std::span<const std::uint32_t> chosen) {
  HostParticles selected;
  const std::size_t n = chosen.size();
  selected.position.resize(n), selected.direction.resize(n), selected.interface.resize(n);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t k) {
    selected.position[k] = particles.position[chosen[k]];
    selected.direction[k] = particles.direction[chosen[k]];
    selected.interface[k] = particles.interface[chosen[k]];
  });
  return selected;
}

std::vector<Vec3d> world_positions(std::span<const Float4> position, const VolumeFrame& frame) {
  std::vector<Vec3d> points(position.size());
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    points[i] = frame.to_world(Vec3d(position[i].x, position[i].y, position[i].z));
  });
  return points;
}

std::array<std::int64_t, 3> count_by_order(std::span<const std::uint32_t> interface, const JunctionTable& table) {
  std::array<std::int64_t, 3> count{};
  for (const std::uint32_t k : interface) ++count[table.order[k]];
  return count;
}

MeshParticles describe_particles(const HostParticles& particles, const JunctionTable& table, const VolumeFrame& frame) {
  MeshParticles result;
  result.points = world_positions(particles.position, frame);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Float4 &position = particles.position[i], &direction = particles.direction[i];
    const Junction j = table.junctions[particles.interface[i]];
    result.size.push_back(position.w * float(frame.unit));
    result.energy.push_back(direction.w);
    result.normal.push_back(frame.direction_to_world({direction.x, direction.y, direction.z}));
    result.order.push_back(std::uint8_t(j.order()));
    result.materials.push_back(j.all());
  }
  return result;
}

}  // namespace nacre
