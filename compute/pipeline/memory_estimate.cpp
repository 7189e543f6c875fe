// Nacre: how much memory a mesh run will take, from its voxels, before any field is made.
#include "compute/pipeline/memory_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "compute/device/error.hpp"
#include "compute/field/distance.hpp"
#include "compute/field/sizing.hpp"
#include "compute/pipeline/particle_rules.hpp"

namespace nacre {
namespace {

/// Of the embedding, for a closest-point cell's area of a boundary: its own cells and those around it.
constexpr double cells_on_area = 18, bytes_of_cell = 18;
/// Of cells of the lattice that a boundary runs through, on both of its sides, for the area of one.
constexpr double boundary_cells = 1.7;
/// Delaunay's cells, triangles, their neighbours and what repair and improvement keep beside them.
constexpr double host_bytes_of_particle = 1150;
/// Stars and what they are cut from, each twice, and boxes; some particles have several.
constexpr double device_bytes_of_particle = 500;

double largest_size(const MeshParameters& parameters) { return std::max(parameters.min_size, parameters.max_size); }

/// Half-way between the sizes, but never far from the smallest one.
double usual_size(const MeshParameters& parameters) {
  return std::min(0.5 * (parameters.min_size + largest_size(parameters)), 1.5 * parameters.min_size);
}

/// Beside something thin: the ball that touches both of its sides is half as wide.
double size_beside(double thickness, const MeshParameters& parameters) {
  const SizingRule rule{.epsilon = float(parameters.epsilon),
                        .delta = float(parameters.delta),
                        .min_size = float(parameters.min_size),
                        .max_size = float(largest_size(parameters))};
  return std::min(usual_size(parameters), double(rule.size(float(thickness / 2), rule.max_size, rule.max_size)));
}

std::string one_decimal(double x) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", std::ceil(x * 10) / 10);
  return text;
}
std::string gigabytes(double bytes) { return one_decimal(bytes / 1e9) + " GB"; }

double particles_on(double area, double size) { return 1.1547 * area / (size * size); }

double particles_on(const BoundaryArea& boundary, const MeshParameters& parameters) {
  double particles = 0, thick = boundary.usual;
  for (const BoundaryArea::Thin& thin : boundary.thin) {
    particles += particles_on(thin.area, size_beside(thin.thickness, parameters));
    thick -= thin.area;
  }
  return particles + particles_on(std::max(thick, 0.0), usual_size(parameters));
}

}  // namespace

double MemoryEstimate::peak() const { return fields + std::max(building, particles + triangulation); }

MemoryEstimate estimate_memory(const VolumeFacts& facts, const MeshParameters& parameters) {
  const double brick = brick_voxels * sizeof(float), tile = Lattice::tile_cells * sizeof(float);
  const double points = boundary_cells * facts.boundary.usual / (facts.spacing * facts.spacing);
  const double cells_per_voxel = std::min(1.5 / (0.9 * largest_size(parameters)), double(parameters.subcells));
  const double particles = parameters.particles > 0 ? parameters.particles : particles_on(facts.boundary, parameters);
  const bool tightens = parameters.tighten > 0;
  MemoryEstimate estimate;
  estimate.fields =
      double(facts.bricks) * brick + 2 * double(facts.lattice_tiles) * tile + points * sizeof(InterfacePoint);
  estimate.building = tightens ? double(facts.bricks) * brick : 0;
  estimate.particles = cells_on_area * facts.boundary.usual * cells_per_voxel * cells_per_voxel * bytes_of_cell +
                       solver_bytes(std::int64_t(std::min(particles, 4e9)), 1, parameters);
  estimate.triangulation = particles * host_bytes_of_particle;
  return estimate;
}

double factor_that_fits(const VolumeFacts& facts, const MeshParameters& parameters, double free) {
  for (double factor = 1; factor < 20; factor *= 1.02) {
    MeshParameters larger = parameters;
    larger.min_size *= factor;
    larger.max_size *= factor;
    if (estimate_memory(facts, larger).peak() <= free) return factor;
  }
  return 0;
}

double require_memory(const VolumeFacts& facts, const MeshParameters& parameters, std::size_t room, std::size_t taken,
                      const Device& device) {
  MemoryEstimate estimate = estimate_memory(facts, parameters);
  double free = double(room), before = double(taken);
  if (device.shares_host_memory()) {
    free = std::min(free, double(device.available_bytes()));
    before = double(device.peak_bytes());
  } else {
    estimate.triangulation *= device_bytes_of_particle / host_bytes_of_particle;
  }
  if (estimate.peak() > free) {
    const double factor = factor_that_fits(facts, parameters, free);
    const double voxels = std::sqrt(estimate.peak() / std::max(free, 1.0));  // memory goes with the area
    throw Error("not enough memory for the mesh of this volume",
                "it takes about " + gigabytes(estimate.peak()) + ", " + gigabytes(free) + " are free",
                device.too_small(factor > 0 ? "raise `min_size` to " + one_decimal(parameters.min_size * factor) +
                                                  " and `max_size` to " + one_decimal(largest_size(parameters) * factor)
                                            : "crop the volume, or resample it to voxels " + one_decimal(voxels) +
                                                  " times as large"));
  }
  return before + estimate.peak();
}

}  // namespace nacre
