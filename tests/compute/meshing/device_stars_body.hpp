// Nacre: items found in their boxes, and stars that a device finds: of all items, and of those that have changed.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "compute/meshing/device_stars.hpp"
#include "compute/meshing/star_mesh.hpp"
#include "tests/compute/meshing/own_items.hpp"
#include "tests/compute/meshing/star_clouds.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/small_cases.hpp"

namespace nacre::test::device_stars {

/// Items at random positions on three surfaces, of which one has very few and one has none.
inline OwnItems random_items(std::uint32_t count) {
  OwnItems items;
  std::mt19937 generator(count);
  std::uniform_real_distribution<float> random(-3, 30);
  items.first = {0, std::min(count, 2u), std::min(count, 2u), count};
  for (std::uint32_t i = 0; i < count; ++i) {
    items.position.push_back(Vec3d(Vec3f(random(generator), random(generator), random(generator))));
    items.surface.push_back(i < 2 ? 0 : 2);
  }
  return items;
}

/// What is found around an item: how many items of its surface, and the sum of their numbers and squared distances.
struct Found {
  std::uint64_t count = 0, numbers = 0;
  double distances = 0;
};

struct FindAround {
  StarItemsView items;
  ItemBoxesView boxes;
  double radius2;
  Found* found;
  NACRE_HD void operator()(std::int64_t i) const {
    Found all;
    const std::uint32_t s = items.surface[i];
    boxes.within(items.first[s], items.first[s + 1], Vec3f(items.position[i]), radius2,
                 [&](double d, std::uint32_t k) { ++all.count, all.numbers += k, all.distances += d; });
    found[i] = all;
  }
};

inline Found found_by_trying_all(const OwnItems& items, std::uint32_t i, double radius2) {
  Found all;
  for (std::uint32_t k = items.first[items.surface[i]]; k < items.first[items.surface[i] + 1]; ++k) {
    const Vec3d r = items.position[k] - items.position[i];
    if (dot(r, r) <= radius2) ++all.count, all.numbers += k, all.distances += dot(r, r);
  }
  return all;
}

/// Of the items only what boxes are made of, in temporary memory.
template <class Backend>
StarItemsView upload_positions(Executor<Backend>& exec, const OwnItems& items) {
  auto position = exec.arena().template temporary<Vec3d>(items.count());
  auto surface = exec.arena().template temporary<std::uint32_t>(items.count());
  auto first = exec.arena().template temporary<std::uint32_t>(items.first.size());
  position.upload(items.position), surface.upload(items.surface), first.upload(items.first);
  StarItemsView view;
  view.position = position.data(), view.surface = surface.data(), view.first = first.data();
  return view;
}

template <class Backend>
void boxes_find_what_is_near(Executor<Backend>& exec) {
  for (const std::uint32_t count : {1u, 2u, 8u, 9u, 65u, small_cases() ? 200u : 5000u})
    for (const double radius : {0.0, 2.5, 11.0, 100.0}) {
      const OwnItems items = random_items(count);
      Arena::Scope scope(exec.arena());
      const StarItemsView view = upload_positions(exec, items);
      const ItemBoxesView boxes = item_boxes(exec, view, count);
      const auto found = exec.arena().template temporary<Found>(count);
      exec.for_each(count, FindAround{view, boxes, radius * radius, found.data()});
      const std::vector<Found> all = found.download();
      for (std::uint32_t i = 0; i < count; i += 1 + count / 50) {
        const Found expected = found_by_trying_all(items, i, radius * radius);
        ASSERT_EQ(all[i].count, expected.count) << i << " of " << count << " within " << radius;
        ASSERT_EQ(all[i].numbers, expected.numbers);
        ASSERT_NEAR(all[i].distances, expected.distances, 1e-9 * expected.distances);
      }
    }
}
NACRE_DEVICE_TEST(ItemBoxes, boxes_find_what_is_near)

/// What is found around an item of all that was gathered around a box that it is in; `count` is 0 where that is too
/// much.
struct FindGathered {
  StarItemsView items;
  ItemBoxesView boxes;
  double reach;
  Found* found;
  NACRE_HD void operator()(std::int64_t i) const {
    Found all;
    const std::uint32_t s = items.surface[i];
    const Vec3f at(items.position[i]), aside(0.5f, 1, 0.25f);
    ItemsAround around;
    if (around.gather(boxes, items.first[s], items.first[s + 1], at - aside, at + aside, reach))
      around.within(at, reach * reach,
                    [&](double d, std::uint32_t k) { ++all.count, all.numbers += k, all.distances += d; });
    found[i] = all;
  }
};

template <class Backend>
void what_is_gathered_has_all_that_is_near(Executor<Backend>& exec) {
  const std::uint32_t count = small_cases() ? 200 : 5000;
  const OwnItems items = random_items(count);
  std::uint32_t gathered = 0;
  for (const double reach : {0.5, 3.0, 100.0}) {
    Arena::Scope scope(exec.arena());
    const StarItemsView view = upload_positions(exec, items);
    const ItemBoxesView boxes = item_boxes(exec, view, count);
    const auto found = exec.arena().template temporary<Found>(count);
    exec.for_each(count, FindGathered{view, boxes, reach, found.data()});
    const std::vector<Found> all = found.download();
    for (std::uint32_t i = 2; i < count; i += 1 + count / 50) {
      const Found expected = found_by_trying_all(items, i, reach * reach);
      if (all[i].count == 0) {
        EXPECT_EQ(reach, 100) << "items are far apart";
        continue;
      }
      ++gathered;
      ASSERT_EQ(all[i].count, expected.count) << i << " within " << reach;
      ASSERT_EQ(all[i].numbers, expected.numbers);
    }
  }
  EXPECT_GT(gathered, 60u);
}
NACRE_DEVICE_TEST(ItemBoxes, what_is_gathered_has_all_that_is_near)

inline void expect_equal(const StarMesh& a, const StarMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.unsettled, b.unsettled);
  EXPECT_EQ(a.counts.unsettled, b.counts.unsettled);
}

/// No particle lies beyond the plane of a triangle.
template <class Backend>
void stars_of_a_sphere_are_its_convex_hull(Executor<Backend>& exec) {
  const int count = small_cases() ? 60 : 400;
  const Cloud cloud = sphere(random_directions(count, 5), 5);
  DeviceStars<Backend> stars(exec);
  const StarParticles particles = cloud.view();
  const StarMesh made = mesh_from_stars(particles, stars);
  ASSERT_TRUE(made.sound());
  EXPECT_EQ(made.triangles.size(), std::size_t(2 * count - 4));
  for (const Triangle& t : made.triangles) {
    const Vec3d a = particles.point(t.a), n = normalized(cross(particles.point(t.b) - a, particles.point(t.c) - a));
    for (std::size_t i = 0; i < particles.count(); ++i) ASSERT_LT(dot(n, particles.point(i) - a), 1e-5);
  }
}
NACRE_DEVICE_TEST(DeviceStars, stars_of_a_sphere_are_its_convex_hull)

/// Sound with rims, too, although some stars disagree at first; and after changes what all stars anew give.
template <class Backend>
void stars_known_from_before_change_nothing(Executor<Backend>& exec) {
  Cloud cloud = halves(small_cases() ? 3 : 8, 0.8);
  DeviceStars<Backend> stars(exec);
  const StarMesh first = mesh_from_stars(cloud.view(), stars);
  EXPECT_TRUE(first.sound());
  EXPECT_TRUE(cloud.topology(first, 3).sound());
  EXPECT_EQ(first.counts.cut, first.counts.stars);
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> random(-0.2f, 0.2f);
  for (int round = 0; round < 3; ++round) {
    for (int k = 0; k < 4; ++k) {
      Float4& p = cloud.position[generator() % cloud.position.size()];
      p.x += random(generator), p.y += random(generator);
    }
    const StarMesh quick = mesh_from_stars(cloud.view(), stars);
    EXPECT_LT(quick.counts.cut, first.counts.stars);
    DeviceStars<Backend> others(exec);
    expect_equal(quick, mesh_from_stars(cloud.view(), others));
  }
}
NACRE_DEVICE_TEST(DeviceStars, stars_known_from_before_change_nothing)

}  // namespace nacre::test::device_stars
