// Nacre: stars of which most are known from before give the mesh that all of them anew would give.
#include "compute/meshing/known_items.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/compute/meshing/cpu_stars.hpp"

namespace nacre::test {
namespace {

void expect_equal(const StarMesh& a, const StarMesh& b, int round) {
  EXPECT_EQ(a.triangles, b.triangles) << round;
  EXPECT_EQ(a.materials, b.materials) << round;
  EXPECT_EQ(a.unsettled, b.unsettled) << round;
  EXPECT_EQ(a.joined, b.joined) << round;
  EXPECT_EQ(a.counts.stars, b.counts.stars) << round;
  EXPECT_EQ(a.counts.unsettled, b.counts.unsettled) << round;
  EXPECT_EQ(a.counts.holes, b.counts.holes) << round;
  EXPECT_EQ(a.counts.filled, b.counts.filled) << round;
  EXPECT_EQ(a.counts.left_out, b.counts.left_out) << round;
}

void append(Cloud& to, const Cloud& from, std::size_t i) {
  to.position.push_back(from.position[i]);
  to.direction.push_back(from.direction[i]);
  to.junction.push_back(from.junction[i]);
  to.gradient.push_back(from.gradient[i]);
}

/// Moves a particle aside by a share of its size; one on a rim in any direction.
void push(Cloud& cloud, std::size_t i, float share, std::mt19937& generator) {
  std::uniform_real_distribution<float> random(-1, 1);
  Float4& p = cloud.position[i];
  const Vec3f way(random(generator), random(generator), random(generator));
  const Vec3f n(cloud.direction[i].x, cloud.direction[i].y, cloud.direction[i].z);
  const Vec3f aside = (way - n * dot(way, n)) * (share * p.w);
  p.x += aside.x, p.y += aside.y, p.z += aside.z;
}

/// A cloud with some particles gone, moved, come or turned, about one in `rare` of each.
Cloud changed(const Cloud& cloud, unsigned rare, std::mt19937& generator) {
  Cloud now;
  for (std::size_t i = 0; i < cloud.position.size(); ++i) {
    if (generator() % rare == 0) continue;
    append(now, cloud, i);
    if (generator() % rare == 0) push(now, now.position.size() - 1, 0.3f, generator);
    if (generator() % (4 * rare) == 0) now.position.back().w *= 1.1f;
    if (generator() % (4 * rare) == 0) now.direction.back().x += 0.01f;
  }
  for (std::size_t k = 0; k < cloud.position.size() / rare; ++k) {
    append(now, cloud, generator() % cloud.position.size());
    if (k % 4 != 0) push(now, now.position.size() - 1, 0.6f, generator);  // others are twice in one place
  }
  return now;
}

Cloud shuffled(const Cloud& cloud, std::mt19937& generator) {
  std::vector<std::size_t> order(cloud.position.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), generator);
  Cloud now;
  for (const std::size_t i : order) append(now, cloud, i);
  return now;
}

/// Rounds of random changes: few, many, none, back to an earlier state, another order.
void expect_the_same_after_changes(const Cloud& first, unsigned seed) {
  std::mt19937 generator(seed);
  CpuStars stars;
  std::vector<Cloud> states = {first};
  std::int64_t cut = 0, all = 0;
  for (int round = 0; round < 40; ++round) {
    const Cloud& last = states.back();
    Cloud now;
    switch (generator() % 8) {
      case 0: now = states[generator() % states.size()]; break;
      case 1: now = last; break;
      case 2: now = changed(last, 8, generator); break;
      case 3: now = generator() % 2 ? shuffled(last, generator) : changed(last, 1000, generator); break;
      default: now = changed(last, 200, generator);
    }
    const StarMesh quick = stars.mesh(now);
    expect_equal(quick, mesh_of(now), round);
    cut += quick.counts.cut, all += quick.counts.stars;
    states.push_back(now);
  }
  EXPECT_LT(cut, all * 3 / 4) << "most are known from before";
}

TEST(KnownItems, AfterRandomChangesTheMeshIsThatOfAllStarsAnew) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    expect_the_same_after_changes(halves(8, 0.8), seed);
    expect_the_same_after_changes(sphere(random_directions(1500, seed), 8), seed);
  }
}

TEST(KnownItems, NorDoesTheNumberOfThreadsMatter) {
  const auto on = [](int threads) {
    return tbb::task_arena(threads).execute([=] {
      std::mt19937 generator(9);
      CpuStars stars(threads);
      Cloud cloud = halves(8, 0.8);
      stars.mesh(cloud);
      for (int k = 0; k < 5; ++k) cloud = changed(cloud, 100, generator), stars.mesh(cloud);
      return stars.mesh(cloud);
    });
  };
  expect_equal(on(1), on(3), 0);
}

TEST(KnownItems, WhereNothingHasChangedNoStarIsCutAgain) {
  const Cloud cloud = halves(8, 0.8);
  CpuStars stars;
  const StarCounts first = stars.mesh(cloud).counts;
  EXPECT_EQ(first.cut, first.stars);
  EXPECT_EQ(stars.mesh(cloud).counts.cut, 0);
}

}  // namespace
}  // namespace nacre::test
