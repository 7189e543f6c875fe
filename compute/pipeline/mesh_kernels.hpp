// Nacre: the mesh pipeline's own kernels: last projection, looks into the fields, what a renderer is shown.
#pragma once

#include "compute/embedding/interface_grid.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/sizing.hpp"
#include "compute/particles/bins.hpp"
#include "compute/particles/tree.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre::detail {

/// Puts the particles onto the fields themselves after the last move, and marks those that have no interface nearby.
struct PolishParticle {
  MaterialBricksView field;
  SizingFieldView size;
  const Junction* junction;
  const std::uint32_t* interface;
  Float4* place;
  Float4* direction;
  std::uint8_t* lost;
  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 at = place[i];
    const Junction j = junction[interface[i]];
    lost[i] = 0;
    if (j.order() == 0) return;
    JunctionPoint on;
    lost[i] = 1;
    if (!project(field, j, {at.x, at.y, at.z}, 0.7f, on)) return;
    if (junction_margin(field, j, on.p, on.steepness) < -0.02f) return;
    lost[i] = 0;
    place[i] = {on.p.x, on.p.y, on.p.z, at.w > 0 ? at.w : size(on.p)};
    direction[i] = {on.direction.x, on.direction.y, on.direction.z, direction[i].w};
  }
};

struct MaterialAt {
  MaterialBricksView field;
  const Vec3f* point;
  std::uint16_t* material;
  NACRE_HD void operator()(std::int64_t i) const { material[i] = std::uint16_t(material_at(field, point[i])); }
};

/// The same for pictures, sooner: a voxel whose 26 neighbours are of its material is taken to be whole.
struct PictureMaterialAt {
  MaterialBricksView field;
  const Vec3f* point;
  float* material;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = point[i];
    material[i] = 0;
    if (!field.inside(p, 2)) return;
    const Vec3f u = p * field.cells_per_unit;
    const std::int64_t row = field.blocks.x * block_size, slab = row * field.blocks.y * block_size;
    const std::uint16_t* voxel = field.voxel_material + field.voxel_number(int(u.x), int(u.y), int(u.z));
    bool whole = true;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y) {
        const std::uint16_t* line = voxel + z * slab + y * row;
        whole = whole && line[-1] == *voxel && line[0] == *voxel && line[1] == *voxel;
      }
    material[i] = whole ? float(*voxel) : float(nacre::material_at(field, p));
  }
};

struct SizeAt {
  MaterialBricksView field;
  SizingFieldView size;
  const Vec3f* point;
  float* h;
  NACRE_HD void operator()(std::int64_t i) const { h[i] = field.inside(point[i], 0) ? size(point[i]) : NAN; }
};

/// Unsigned distance from the interfaces: the interface point that is the nearest stands for a disc as wide as the
/// lattice, since distances from the points alone would show where they lie.
struct DistanceAt {
  MaterialBricksView field;
  DistanceFieldView distances;
  const Vec3f* point;
  float* distance;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = point[i];
    distance[i] = NAN;
    if (!field.inside(p, 0)) return;
    float away = 0;
    const std::uint32_t q = distances.closest(p, away);
    distance[i] = INFINITY;
    if (q == none || away > distances.reach) return;
    const Float4 n = distances.point[q].normal;
    const Vec3f s = distances.lattice.spacing;
    const float along = dot(p - distances.place(q), Vec3f(n.x, n.y, n.z));
    const float beside = std::sqrt(std::fmax(away * away - along * along, 0.0f)) - std::fmax(s.x, std::fmax(s.y, s.z));
    distance[i] = beside > 0 ? std::sqrt(along * along + beside * beside) : std::fabs(along);
  }
};

/// Distance of a point from the interface of a facet's two materials, in voxels; negative where it cannot be found.
struct DistanceToInterface {
  MaterialBricksView field;
  const Vec3f* point;
  const Junction* junction;
  float* distance;
  NACRE_HD void operator()(std::int64_t i) const {
    JunctionPoint on;
    distance[i] = -1;
    if (!field.inside(point[i], 3) || !project(field, junction[i], point[i], 3, on)) return;
    distance[i] = length(on.p - point[i]);
  }
};

/// One in the upper half for a point, in the lower half for a curve's particle, so that one scan numbers both.
struct CountLowerOrders {
  const std::uint8_t* order;  ///< per interface
  const std::uint32_t* interface;
  std::uint64_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    const int mine = order[interface[i]];
    count[i] = mine == 0 ? std::uint64_t(1) << 32 : mine == 1 ? 1 : 0;
  }
};

/// Copies a particle to where a renderer wants it: points, curves, surfaces, each in their present order.
struct ShowParticle {
  const std::uint8_t* order;
  const std::uint32_t* interface;
  const Float4* place;
  const Float4* direction;
  const std::uint64_t* before;  ///< scanned
  std::int64_t points, curves;  ///< of all
  Float4* to_place;
  Float4* to_direction;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::int64_t p = std::int64_t(before[i] >> 32), c = std::int64_t(before[i] & 0xffffffff);
    const int mine = order[interface[i]];
    const std::int64_t at = mine == 0 ? p : mine == 1 ? points + c : points + curves + (i - p - c);
    to_place[at] = place[i];
    to_direction[at] = direction[i];
  }
};

/// An interface without particles has a root without bounds.
struct CountFullNodes {
  const TreeNode* node;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const { count[i] = node[i].first < node[i].last ? 1 : 0; }
};

struct NodeBox {
  const TreeNode* node;
  const std::uint32_t* number;  ///< scanned
  ShownBox* box;
  NACRE_HD void operator()(std::int64_t i) const {
    if (node[i].first < node[i].last) box[number[i]] = {node[i].low, node[i].high};
  }
};

struct BinBox {
  BinGrid grid;
  const std::uint32_t* bin;
  ShownBox* box;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f low = grid.low + Vec3f(grid.bin_of(bin[i])) * grid.edge;
    box[i] = {low, low + Vec3f(grid.edge)};
  }
};

}  // namespace nacre::detail
