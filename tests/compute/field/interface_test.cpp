// Nacre: junctions by name, and the ways onto them through a field of materials.
#include "compute/field/interface.hpp"

#include <gtest/gtest.h>

#include "compute/device/random.hpp"
#include "compute/device/team.hpp"
#include "compute/field/inside_outside.hpp"
#include "tests/compute/field/host_field.hpp"

namespace nacre::test {
namespace {

constexpr auto catmull_rom = CubicKernel::catmull_rom;
const Vec3f centre(12.3f, 11.8f, 12.1f);

HostField::Function plane(const Vec3f& slope) {
  return [slope](const Vec3f& p) { return dot(slope, p - centre); };
}

/// Three materials around the z line through `centre`, a fourth above: all four meet at `centre`.
HostField four_materials() {
  return {{3, 3, 3},
          {1, 1, 1},
          catmull_rom,
          {plane({1, 0, -0.3f}), plane({-0.5f, 0.9f, -0.3f}), plane({-0.5f, -0.9f, -0.3f}), plane({0, 0, 0.8f})}};
}

/// A ball of material 1 with this radius.
HostField ball_field(float radius, const Vec3f& cells_per_unit = {1, 1, 1}, const Int3& blocks = {3, 3, 3}) {
  const auto inside = [radius](const Vec3f& p) { return radius - length(p - centre); };
  return {blocks, cells_per_unit, catmull_rom, {[inside](const Vec3f& p) { return -inside(p); }, inside}};
}

std::vector<Vec3f> places_near(const Vec3f& p, float spread, int count) {
  std::vector<Vec3f> positions;
  for (int k = 0; k < count; ++k)
    positions.push_back(
        p + Vec3f(uniform_random(3, k, 0) - 0.5f, uniform_random(3, k, 1) - 0.5f, uniform_random(3, k, 2) - 0.5f) *
                (2 * spread));
  return positions;
}

TEST(Junction, KnowsItsMaterialsAndOrder) {
  const Junction surface(1, 4), curve(1, 3, 4), point(0, 1, 3, 4);
  EXPECT_EQ(surface.order(), 2);
  EXPECT_EQ(curve.order(), 1);
  EXPECT_EQ(point.order(), 0);
  EXPECT_EQ(curve.material(1), 3u);
  EXPECT_TRUE(curve.has(4));
  EXPECT_FALSE(curve.has(0));
  EXPECT_TRUE(curve.bounds(surface));
  EXPECT_TRUE(point.bounds(curve));
  EXPECT_TRUE(surface.bounds(surface));
  EXPECT_FALSE(surface.bounds(curve));
  EXPECT_FALSE(curve.bounds(Junction(0, 1)));
}

TEST(MaterialBricks, SamplesLinearFunctionsAcrossBlocks) {
  const HostField host({3, 3, 3}, {1, 1, 0.5f}, catmull_rom, {plane({1, -2, 0.5f}), plane({0.2f, 0, 1})});
  for (const Vec3f& p : places_near({12, 12, 24}, 8, 200)) {
    const CubicStencil stencil(host.view(), p);
    const FieldSample s = stencil.sample(host.view(), 0);
    EXPECT_NEAR(s.value, dot(Vec3f(1, -2, 0.5f), p - centre), 3e-5f);
    EXPECT_LT(length(s.gradient - Vec3f(1, -2, 0.5f)), 3e-5f);
    EXPECT_NEAR(stencil.value(host.view(), 1), dot(Vec3f(0.2f, 0, 1), p - centre), 3e-5f);
  }
}

TEST(MaterialBricks, SecondDerivativesOfAParabolaAreExact) {
  const HostField host({2, 2, 2}, {1, 0.8f, 1}, catmull_rom, {[](const Vec3f& p) {
                         return p.x * p.x - 0.5f * p.y * p.y + p.x * p.z - p.y * p.z + 0.25f * p.x * p.y;
                       }});
  for (const Vec3f& p : places_near({8, 10, 8}, 4, 50)) {
    const FieldCurvature c = CubicStencil(host.view(), p).curvature(host.view(), 0);
    const float expected[] = {2, -1, 0, 0.25f, -1, 1}, got[] = {c.xx, c.yy, c.zz, c.xy, c.yz, c.zx};
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(got[k], expected[k], 2e-3f) << k;
    EXPECT_NEAR(c.gradient.x, 2 * p.x + p.z + 0.25f * p.y, 2e-3f);
  }
}

TEST(MaterialBricks, TheMaterialIsTheOneThatIsLargest) {
  const HostField host = four_materials();
  EXPECT_EQ(material_at(host.view(), centre + Vec3f(3, 0, -1)), 0u);
  EXPECT_EQ(material_at(host.view(), centre + Vec3f(-1, 3, -1)), 1u);
  EXPECT_EQ(material_at(host.view(), centre + Vec3f(-1, -3, -1)), 2u);
  EXPECT_EQ(material_at(host.view(), centre + Vec3f(0, 0, 3)), 3u);
  EXPECT_EQ(material_at(host.view(), Vec3f(0, 0, 0)), 0u);  // too close to the end to be sampled
}

/// Both ways onto a junction; each test below runs on both.
bool by_difference(const MaterialBricksView& field, const Junction& j, const Vec3f& p, float reach, JunctionPoint& at) {
  return project(field, j, p, reach, at);
}
bool by_indicator(const MaterialBricksView& field, const Junction& j, const Vec3f& p, float reach, JunctionPoint& at) {
  return project_by_indicator(field, j, p, reach, at);
}
using Way = bool (*)(const MaterialBricksView&, const Junction&, const Vec3f&, float, JunctionPoint&);
class Ways : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(Project, Ways, testing::Values(by_difference, by_indicator));

TEST_P(Ways, ReachTheSurfaceOfABall) {
  const HostField host = ball_field(6);
  for (const Vec3f& position : places_near({0, 0, 0}, 1, 300)) {
    const Vec3f p = centre + normalized(position) * (6 + 0.9f * position.x);
    JunctionPoint at;
    ASSERT_TRUE(GetParam()(host.view(), Junction(0, 1), p, 1.5f, at));
    EXPECT_NEAR(length(at.p - centre), 6, 0.02f);
    EXPECT_LT(length(at.direction - normalized(at.p - centre)), 0.03f);  // out of 1, towards 0
    EXPECT_NEAR(at.steepness, 2, 0.03f);
    EXPECT_LT(length(at.p - p), 1.05f * std::fabs(length(p - centre) - 6) + 0.02f);  // straight there
  }
}

TEST_P(Ways, ReachItThroughFlatVoxels) {
  const HostField host = ball_field(6, {1, 1, 0.5f}, {3, 3, 2});
  for (const Vec3f& position : places_near({0, 0, 0}, 1, 100)) {
    JunctionPoint at;
    ASSERT_TRUE(GetParam()(host.view(), Junction(0, 1), centre + normalized(position) * 6.4f, 1, at));
    EXPECT_NEAR(length(at.p - centre), 6, 0.06f);
  }
}

TEST_P(Ways, GoNoFurtherThanTheirReach) {
  const HostField host = ball_field(6);
  JunctionPoint at;
  const Vec3f p = centre + Vec3f(4, 0, 0);
  EXPECT_FALSE(GetParam()(host.view(), Junction(0, 1), p, 1.5f, at));
  EXPECT_TRUE(GetParam()(host.view(), Junction(0, 1), p, 2.5f, at));
  EXPECT_FALSE(GetParam()(host.view(), Junction(0, 1), Vec3f(1, 12, 12), 9, at));  // at the end of the volume
  EXPECT_FALSE(GetParam()(host.view(), Junction(0, 7), p, 2.5f, at));              // no such material
}

TEST_P(Ways, ReachTheCurveOfThreeMaterials) {
  const HostField host = four_materials();
  const Vec3f along(0, 0, 1);  // of the first three: x (1.5, 0.9 ..) differences vanish on the z line
  for (const Vec3f& p : places_near(centre - Vec3f(0, 0, 4), 0.8f, 300)) {
    JunctionPoint at;
    ASSERT_TRUE(GetParam()(host.view(), Junction(0, 1, 2), p, 2, at));
    const Vec3f r = at.p - centre;
    EXPECT_LT(std::hypot(r.x, r.y), 5e-3f);
    EXPECT_NEAR(at.p.z, p.z, 5e-3f);  // straight there: no equation pulls along the curve
    EXPECT_NEAR(std::fabs(dot(at.direction, along)), 1, 1e-4f);
  }
}

TEST_P(Ways, ReachThePointOfFourMaterials) {
  const HostField host = four_materials();
  for (const Vec3f& p : places_near(centre, 0.7f, 300)) {
    JunctionPoint at;
    ASSERT_TRUE(GetParam()(host.view(), Junction(0, 1, 2, 3), p, 3, at));
    EXPECT_LT(length(at.p - centre), 0.02f);
    EXPECT_EQ(at.direction, Vec3f());
  }
}

TEST(Project, OnlyTheIndicatorSeesThatAnotherMaterialCoversThePlace) {
  const HostField host = four_materials();
  const Vec3f covered = centre + Vec3f(-3, 0, 3), open = centre + Vec3f(-3, 0.2f, -3);
  JunctionPoint at;
  EXPECT_TRUE(project(host.view(), Junction(1, 2), covered, 1, at));
  EXPECT_LT(junction_margin(host.view(), Junction(1, 2), at.p, at.steepness), -0.5f);
  EXPECT_FALSE(project_by_indicator(host.view(), Junction(1, 2), covered, 1, at));
  EXPECT_TRUE(project_by_indicator(host.view(), Junction(1, 2), open, 1, at));
  EXPECT_GT(junction_margin(host.view(), Junction(1, 2), at.p, at.steepness), 0.5f);
}

/// Within a third material, two that are far away may be equally low: one of them is listed, the other is not.
TEST(Project, ThereIsNoJunctionOfAMaterialThatIsNotListed) {
  const HostField host({3, 3, 3}, {1, 1, 1}, catmull_rom,
                       {[](const Vec3f&) { return 3.0f; }, [](const Vec3f& p) { return -8 + p.x - centre.x; }});
  JunctionPoint at;
  ASSERT_TRUE(project(host.view(), Junction(1, 2), centre + Vec3f(0.3f, 0, 0), 1, at));
  EXPECT_LT(junction_margin(host.view(), Junction(1, 2), at.p, at.steepness), -3);
}

TEST(Project, TheIndicatorReachesASurfaceRightBesideItsRim) {  // a third material that is nearly as large mixes in
  const HostField host = four_materials();
  for (int k = 1; k <= 60; ++k) {
    const Vec3f p = centre + Vec3f(-0.005f * float(k), 0.01f, -4);
    JunctionPoint at;
    ASSERT_TRUE(project_by_indicator(host.view(), Junction(1, 2), p, 0.5f, at)) << k;
    EXPECT_NEAR(at.p.y, centre.y, 2e-3f);
  }
}

TEST(Project, ATeamComesToTheSamePlace) {
  const HostField host = four_materials();
  for (const Junction& j : {Junction(1, 2), Junction(0, 1, 2), Junction(0, 1, 2, 3)})
    for (const Vec3f& p : places_near(centre - Vec3f(0.5f, 0, j.order() == 0 ? 0 : 2), 0.4f, 50)) {
      std::vector<unsigned char> sums(Team::sum_bytes);
      Team team(sums.data());
      FieldSample shared[mixed_materials];
      JunctionPoint alone, together;
      const bool found = project_by_indicator(host.view(), j, p, 2, alone);
      EXPECT_EQ(found, project_by_indicator(team, shared, host.view(), j, p, 2, together));
      EXPECT_EQ(alone.p, together.p);
    }
}

TEST(Project, TheStrongestOfTooManyMaterialsDecide) {
  std::vector<HostField::Function> functions{plane({1, 0, 0}), plane({-1, 0, 0})};
  for (int m = 2; m < 24; ++m) functions.push_back([m](const Vec3f& p) { return -5 - 0.1f * float(m) + 0.01f * p.y; });
  functions.push_back(plane({0, 0, 2}));  // covers both where z is large: comes last, and counts
  const HostField host({3, 3, 3}, {1, 1, 1}, catmull_rom, functions);
  JunctionPoint at;
  ASSERT_TRUE(project_by_indicator(host.view(), Junction(0, 1), centre + Vec3f(0.4f, 0, -2), 1, at));
  EXPECT_NEAR(at.p.x, centre.x, 2e-3f);
  EXPECT_FALSE(project_by_indicator(host.view(), Junction(0, 1), centre + Vec3f(0.4f, 0, 2), 1, at));
}

}  // namespace
}  // namespace nacre::test
