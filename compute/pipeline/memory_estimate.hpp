// Nacre: how much memory a mesh run will take, from its voxels, before any field is made.
#pragma once

#include <cstdint>

#include "compute/field/boundary_area.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// What is known of a volume that is laid out.
struct VolumeFacts {
  std::int64_t bricks = 0;         ///< of materials' functions
  std::int64_t lattice_tiles = 0;  ///< of distances, those that are stored
  BoundaryArea boundary;           ///< between materials
  double spacing = 1;              ///< of the lattice, in smallest spacings
};

/// Bytes beside those that the volume itself takes.
struct MemoryEstimate {
  double fields = 0;         ///< as they stay
  double building = 0;       ///< beside them while they are made, at most
  double particles = 0;      ///< of the embedding, and of the solver
  double triangulation = 0;  ///< on the host
  double peak() const;
};

/// By what each element takes; `triangulation` by what was measured. The sizes of particles are those that the
/// parameters ask for, and what SizingRule gives beside thin materials.
MemoryEstimate estimate_memory(const VolumeFacts& facts, const MeshParameters& parameters);

/// By how much `min_size` and `max_size` must be larger for `free` bytes to be enough; 0 where that would not help.
double factor_that_fits(const VolumeFacts& facts, const MeshParameters& parameters, double free);

/// What the run will take at its peak, with what was taken before: by the process on the CPU, else by the device, of
/// whose memory `room` is free and `taken` in use. Throws Error where there is not so much.
double require_memory(const VolumeFacts& facts, const MeshParameters& parameters, std::size_t room, std::size_t taken,
                      const Device& device);

}  // namespace nacre
