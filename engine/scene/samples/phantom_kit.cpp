// Nacre: what phantoms are made of.
#include "engine/scene/samples/phantom_kit.hpp"

#include <array>
#include <limits>
#include <numeric>

#include "compute/device/random.hpp"

namespace nacre {

void DistanceGrid::unite_ellipsoid(const Vec3d& centre, const Vec3d& semi, double fillet) {
  const Vec3d half = semi + Vec3d(reach_);
  unite(
      centre - half, centre + half, [&](const Vec3d& p) { return ellipsoid_distance(p - centre, semi); }, fillet);
}

void DistanceGrid::unite_tubes(std::span<const Tube> tubes, double fillet) {
  // Cones of one set are joined by their nearest, into a grid of their own: joining each smoothly with the next would
  // swell the tube.
  std::vector<float> own(values_.size(), float(reach_));
  const double margin = std::min(reach_, fillet + 4 * grid_.unit + 4);
  for (const Tube& tube : tubes)
    for (std::size_t s = 0; s + 1 < tube.size(); ++s) {
      const TubePoint &a = tube[s], &b = tube[s + 1];
      const Vec3d axis = b.centre - a.centre;
      const double squared = dot(axis, axis), half = 0.25 * (a.tall + b.tall);
      if (squared < 1e-18) continue;
      const Vec3d around = Vec3d(std::max(a.radius, b.radius) + margin) + Vec3d(0, 0, half);
      Int3 first, last;
      if (!voxel_range(min(a.centre, b.centre) - around, max(a.centre, b.centre) + around, first, last)) continue;
      const auto nearest = [&](std::size_t at, Vec3d p) {
        const double along = std::clamp(dot(p - a.centre, axis) / squared, 0.0, 1.0);
        p.z -= std::clamp(p.z - a.centre.z - along * axis.z, -half, half);
        own[at] = std::min(own[at], float(round_cone(p, a.centre, b.centre, a.radius, b.radius)));
      };
      for (int k = first.z; k <= last.z; ++k)  // small boxes: threads would cost more than they save
        for (int j = first.y; j <= last.y; ++j)
          for (int i = first.x; i <= last.x; ++i) nearest(grid_.index(i, j, k), grid_.centre(i, j, k));
    }
  grid_.for_each([&](std::size_t at, const Vec3d&) {
    if (own[at] < margin) join(values_[at], own[at], fillet);
  });
}

bool DistanceGrid::voxel_range(const Vec3d& low, const Vec3d& high, Int3& first, Int3& last) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double end = grid_.dims[axis] - 1;
    first[axis] = int(std::clamp(std::ceil(low[axis] / grid_.unit), 0.0, end + 1));
    last[axis] = int(std::clamp(std::floor(high[axis] / grid_.unit), -1.0, end));
    if (first[axis] > last[axis]) return false;
  }
  return true;
}

double lattice_random(std::uint32_t seed, int i, int j, int k) {
  const std::uint32_t position = std::uint32_t(i) + 1024u * std::uint32_t(j) + 1048576u * std::uint32_t(k);
  return 2 * double(uniform_random(seed, position, 0)) - 1;
}

Waves::Waves(std::uint32_t seed, int count, double wave_number) : scale_(float(std::sqrt(2.0 / count))) {
  constexpr double pi = 3.14159265358979323846;
  for (int n = 0; n < count; ++n) {  // directions in even order over the sphere, phases at random
    const double z = 1 - (2 * n + 1.0) / count, turn = n * pi * (3 - std::sqrt(5.0)) + seed;
    const double across = std::sqrt(1 - z * z);
    waves_.push_back(Vec3f(Vec3d(across * std::cos(turn), across * std::sin(turn), z) * wave_number));
    phases_.push_back(float(2 * pi * uniform_random(seed, std::uint32_t(n), 1)));
  }
}

Waves::Sample Waves::operator()(const Vec3d& p) const {
  const Vec3f q(p);
  float sum = 0;
  Vec3f gradient{};
  for (std::size_t n = 0; n < waves_.size(); ++n) {
    const float at = dot(waves_[n], q) + phases_[n];
    sum += std::cos(at);
    gradient += waves_[n] * -std::sin(at);
  }
  return {double(sum * scale_), Vec3d(gradient * scale_)};
}

double Waves::value(const Vec3d& p) const {
  const Vec3f q(p);
  float sum = 0;
  for (std::size_t n = 0; n < waves_.size(); ++n) sum += std::cos(dot(waves_[n], q) + phases_[n]);
  return double(sum * scale_);
}

std::vector<Tube> grow_tree(const Vec3d& root, std::vector<Vec3d> leaves, double twig, double trunk) {
  std::stable_sort(leaves.begin(), leaves.end(),
                   [&](const Vec3d& a, const Vec3d& b) { return dot(a - root, a - root) < dot(b - root, b - root); });
  std::vector<Vec3d> nodes{root};
  std::vector<std::size_t> parent{0};
  std::vector<double> way{0};  // from the root along the tree
  for (const Vec3d& leaf : leaves) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const double cost = length(leaf - nodes[n]) + 0.35 * way[n];
      if (cost < least) least = cost, best = n;
    }
    nodes.push_back(leaf);
    parent.push_back(best);
    way.push_back(way[best] + length(leaf - nodes[best]));
  }
  std::vector<int> fed(nodes.size(), 1);
  for (std::size_t n = nodes.size() - 1; n > 0; --n) fed[parent[n]] += fed[n];
  const auto radius = [&](std::size_t n) { return std::min(trunk, twig * std::cbrt(double(fed[n]))); };
  std::vector<Tube> tubes;
  for (std::size_t n = 1; n < nodes.size(); ++n)
    tubes.push_back({{nodes[parent[n]], std::min(radius(parent[n]), 1.3 * radius(n))}, {nodes[n], radius(n)}});
  return tubes;
}

void remove_crumbs(const PhantomGrid& grid, std::vector<std::uint8_t>& labels, std::size_t smallest) {
  const Int3 d = grid.dims;
  std::vector<bool> seen(labels.size());
  std::vector<std::size_t> piece;
  for (std::size_t seed = 0; seed < labels.size(); ++seed) {
    if (seen[seed]) continue;
    const std::uint8_t label = labels[seed];
    std::array<std::size_t, 256> around{};
    seen[seed] = true;
    piece.assign(1, seed);
    for (std::size_t n = 0; n < piece.size(); ++n) {
      const std::size_t at = piece[n], row = at / d.x, slice = std::size_t(d.x) * d.y;
      const int i = int(at % d.x), j = int(row % d.y), k = int(row / d.y);
      const auto visit = [&](bool inside, std::size_t next) {
        if (!inside) return;
        if (labels[next] != label)
          ++around[labels[next]];
        else if (!seen[next])
          seen[next] = true, piece.push_back(next);
      };
      visit(i > 0, at - 1), visit(i + 1 < d.x, at + 1);
      visit(j > 0, at - d.x), visit(j + 1 < d.y, at + d.x);
      visit(k > 0, at - slice), visit(k + 1 < d.z, at + slice);
    }
    if (piece.size() >= smallest) continue;
    const auto most = std::max_element(around.begin(), around.end());
    if (*most > 0)
      for (const std::size_t at : piece) labels[at] = std::uint8_t(most - around.begin());
  }
}

}  // namespace nacre
