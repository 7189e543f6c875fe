// Nacre: the first particles: spread by the sizing field over sites on the interfaces, along a space-filling curve.
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/device/random.hpp"
#include "compute/particles/particle_set.hpp"

namespace nacre {

/// Particles h apart in a hexagonal lattice: 2 / sqrt 3 to an area of h^2.
inline constexpr float hexagonal_density = 1.1547005f;

/// Where a particle may begin. What says so is a source of seeds (embedding_seeds.hpp, marching_cubes_seeds.hpp):
///   std::int64_t sites() const             numbers of sites are below this
///   int order() const                      junction order of all its sites
///   float share(i) const                   of site i: how many particles the sizing field asks for there; 0: none
///   std::uint32_t interface(i) const       where the share is not 0
///   std::uint64_t code(i) const            Morton code of its cell, below 2^48
///   SeedSite site(i) const
struct SeedSite {
  Vec3f middle;           ///< in cells
  Vec3f direction;        ///< unit normal of a surface, tangent of a curve
  float size;             ///< h, voxels
  float cells_per_voxel;  ///< seeds stand within half a cell of the middle
};

namespace detail {

template <class Source>
struct CountSeedSites {
  Source source;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const { count[i] = source.share(i) > 0 ? 1 : 0; }
};

template <class Source>
struct ListSeedSites {
  Source source;
  const std::uint32_t* start;
  std::uint64_t* key;
  std::uint32_t* site;
  NACRE_HD void operator()(std::int64_t i) const {
    if (!(source.share(i) > 0)) return;
    key[start[i]] = std::uint64_t(source.interface(i)) << 48 | source.code(i);
    site[start[i]] = std::uint32_t(i);
  }
};

/// Shares in units of 2^-24, so that their running sum is exact; times `scale`.
template <class Source>
struct SeedShares {
  Source source;
  const std::uint32_t* site;
  double scale;
  std::uint64_t* share;
  NACRE_HD void operator()(std::int64_t i) const {
    share[i] = std::uint64_t(double(source.share(site[i])) * scale * 16777216.0);
  }
};

/// A site gets as many particles as whole numbers lie in its stretch of the running sum.
struct CountSeeds {
  const std::uint64_t* sum;
  std::uint64_t total;
  std::int64_t sites;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint64_t half = 1u << 23, end = i + 1 < sites ? sum[i + 1] : total;
    count[i] = std::uint32_t(((end + half) >> 24) - ((sum[i] + half) >> 24));
  }
};

/// Seeds stand beside their sites, along the interface: two sites may be at one point (two cells across a flat
/// interface have the same closest one), and particles there would never part. Those of a site that has several spread
/// over its cell.
template <class Source>
struct WriteSeeds {
  Source source;
  const std::uint32_t* site_number;
  const std::uint32_t* start;  ///< the counts scanned
  const std::uint32_t* count;
  std::uint32_t random;  ///< seed of the random numbers
  std::int64_t first;
  Float4* position;
  Float4* direction;
  std::uint32_t* interface;
  Float4* velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    if (count[i] == 0) return;
    const std::int64_t at = site_number[i];
    const SeedSite seed = source.site(at);
    const std::uint32_t of = source.interface(at);
    const Vec3f& d = seed.direction;
    for (std::uint32_t k = 0; k < count[i]; ++k) {
      const Vec3f p = (seed.middle + aside(at, k, count[i], d)) / seed.cells_per_voxel;
      const std::int64_t to = first + start[i] + k;
      position[to] = {p.x, p.y, p.z, seed.size};
      direction[to] = {d.x, d.y, d.z, 0};
      interface[to] = of;
      velocity[to] = {0, 0, 0, 0};
    }
  }

 private:
  /// Up to a quarter of a cell along each axis, in the tangent space; half of it for one of several.
  NACRE_HD Vec3f aside(std::int64_t at, std::uint32_t number, std::uint32_t of, const Vec3f& direction) const {
    const float reach = of == 1 ? 0.25f : 0.5f;
    const auto along_axis = [&](std::uint32_t axis) {
      return reach * (2 * uniform_random(random, std::uint32_t(at), 3 * number + axis) - 1);
    };
    const Vec3f r(along_axis(0), along_axis(1), along_axis(2)), along = direction * dot(direction, r);
    return source.order() == 2 ? r - along : along;
  }
};

template <class Source>
struct SumShares {
  Source source;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const {
    return std::uint64_t(double(source.share(i)) * 16777216.0);
  }
};

}  // namespace detail

/// How many particles the sizing field asks for on the interfaces of a source of seeds.
template <class Backend, class Source>
double expected_particles(Executor<Backend>& exec, const Source& source) {
  return double(exec.reduce(source.sites(), std::uint64_t(0), detail::SumShares<Source>{source}, Add{})) / 16777216.0;
}

/// Puts seeds behind the particles of a set; returns how many. `scale`: times as many as the sizing field asks for;
/// `random`: seed of the random numbers. Throws Error where they do not fit.
template <class Backend, class Source>
std::int64_t seed_particles(Executor<Backend>& exec, const Source& source, double scale, std::uint32_t random,
                            ParticleSet& set, Array<Float4>& velocity) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  std::int64_t n = 0;
  Array<std::uint64_t> key;
  Array<std::uint32_t> site;
  {
    Array<std::uint32_t> start = arena.temporary<std::uint32_t>(source.sites());
    exec.for_each(source.sites(), detail::CountSeedSites<Source>{source, start.data()});
    n = exec.exclusive_scan(start.data(), start.data(), source.sites());
    if (n == 0) return 0;
    key = arena.temporary<std::uint64_t>(n);
    site = arena.temporary<std::uint32_t>(n);
    exec.for_each(source.sites(), detail::ListSeedSites<Source>{source, start.data(), key.data(), site.data()});
  }
  exec.sort_pairs(key.data(), site.data(), n);
  Array<std::uint64_t> sum = arena.temporary<std::uint64_t>(n);
  exec.for_each(n, detail::SeedShares<Source>{source, site.data(), scale, sum.data()});
  const std::uint64_t total = exec.exclusive_scan(sum.data(), sum.data(), n);
  Array<std::uint32_t> count = arena.temporary<std::uint32_t>(n), start = arena.temporary<std::uint32_t>(n);
  exec.for_each(n, detail::CountSeeds{sum.data(), total, n, count.data()});
  const std::int64_t seeds = exec.exclusive_scan(count.data(), start.data(), n);
  require_capacity(set, set.count + seeds);
  exec.for_each(
      n, detail::WriteSeeds<Source>{source, site.data(), start.data(), count.data(), random, set.count,
                                    set.position.data(), set.direction.data(), set.interface.data(), velocity.data()});
  set.count += seeds;
  return seeds;
}

}  // namespace nacre
