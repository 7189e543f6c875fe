// Nacre: the particles of a mesh as its improvement sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "compute/meshing/star_device.hpp"
#include "compute/meshing/triangle_rings.hpp"
#include "compute/particles/smoothing_rule.hpp"
#include "compute/pipeline/host_particles.hpp"

namespace nacre {

/// What the improvement of a mesh asks of the particles, which lie on a device and know the fields. A test can stand in
/// for them with particles of its own.
class MovableParticles {
 public:
  virtual ~MovableParticles() = default;

  virtual std::int64_t count() const = 0;
  virtual HostParticles download() const = 0;
  /// Instead of those that there are; all are then at rest.
  virtual void upload(const HostParticles& particles) = 0;
  /// As `replace_particles`; the new ones are brought onto their interfaces and get their sizes, and those that find
  /// none are left out. Returns which of `born` there are then, ascending.
  virtual std::vector<std::uint32_t> replace(std::span<const std::uint8_t> gone,
                                             std::span<const MeshDefects::NewPoint> born) = 0;
  /// Moves the particles that have rings within them, `rule.turns` times; `turned(k)` is called after each second time.
  virtual void smooth(const TriangleRings& rings, const SmoothingRule& rule,
                      const std::function<void(int)>& turned) = 0;
  /// The material at points of the world.
  virtual std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) = 0;
  /// How the materials of junctions change at points on these, voxels; zero where the fields end.
  virtual std::vector<JunctionGradients> junction_gradients(std::span<const Vec3f> points,
                                                            std::span<const Junction> junctions) = 0;
  /// Where points of the world come to lie on junctions, as MeshPipeline::onto_junctions.
  virtual std::vector<Vec3d> onto_junctions(std::span<const Vec3d> points, std::span<const Junction> junctions,
                                            bool within) = 0;
  /// One that finds stars where the particles lie. It must go before another one is made, or the particles are.
  virtual std::unique_ptr<StarDevice> star_device() = 0;
  /// Does `work` as a part of the stage of that name.
  virtual void in_stage(std::string_view name, const std::function<void()>& work) = 0;
};

}  // namespace nacre
