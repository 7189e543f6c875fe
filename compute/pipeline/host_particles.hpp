// Nacre: the particles on the host, where the improvement of the mesh takes some out and puts others in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/embedding/junction_table.hpp"
#include "compute/math/lanes.hpp"
#include "compute/meshing/defects.hpp"
#include "compute/pipeline/volume_frame.hpp"

namespace nacre {

/// Particles in the order of a ParticleSet, which says what each array holds.
struct HostParticles {
  std::vector<Float4> position, direction;
  std::vector<std::uint32_t> interface;

  std::size_t count() const { return position.size(); }
};

/// Takes out the particles that `gone` marks, and puts new ones behind those that stay, of size 0 and without
/// direction: as many as there is room for in `capacity`, on interfaces that `table` has. Returns which of `born` these
/// are, ascending.
std::vector<std::uint32_t> replace_particles(HostParticles& particles, std::span<const std::uint8_t> gone,
                                             std::span<const MeshDefects::NewPoint> born, const JunctionTable& table,
                                             const VolumeFrame& frame, std::size_t capacity);

/// Per particle of `now`: that of `before` in the same position and on the same interface, or `none` where there is no
/// such particle, or more than one in either.
std::vector<std::uint32_t> same_particles(const HostParticles& before, const HostParticles& now);

/// Those of the numbers `chosen`, in that order.
HostParticles select(const HostParticles& particles, std::span<const std::uint32_t> chosen);

/// World coordinates.
std::vector<Vec3d> world_positions(std::span<const Float4> position, const VolumeFrame& frame);

/// How many particles are at points, on curves and on surfaces.
std::array<std::int64_t, 3> count_by_order(std::span<const std::uint32_t> interface, const JunctionTable& table);

/// What callers are given of the particles.
MeshParticles describe_particles(const HostParticles& particles, const JunctionTable& table, const VolumeFrame& frame);

}  // namespace nacre
