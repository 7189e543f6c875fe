// Nacre: earlier iterations of the particles, to look back at.
#pragma once

#include <cstddef>
#include <map>

#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/gl/buffer.hpp"

namespace nacre {

/// The particles of an iteration, on the graphics device, as ParticlePass draws them.
struct KeptIteration {
  Buffer position, direction;
  ShownCounts counts;
};

/// Where memory would not suffice, every second one goes.
class KeptParticles {
 public:
  explicit KeptParticles(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Copies the first `counts` particles on the graphics device.
  void keep(int iteration, const Buffer& position, const Buffer& direction, const ShownCounts& counts);
  /// The last one that is not after `iteration`, else the first there is; null: there is none.
  const KeptIteration* find(int iteration) const;
  bool has(int iteration) const { return kept_.contains(iteration); }
  void clear() { kept_.clear(), bytes_ = 0, stride_ = 1; }

 private:
  void thin_out();

  std::size_t most_bytes_, bytes_ = 0;
  int stride_ = 1;  ///< only iterations that it divides are kept
  std::map<int, KeptIteration> kept_;
};

}  // namespace nacre
