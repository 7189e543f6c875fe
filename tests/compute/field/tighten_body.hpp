// Nacre: test bodies for tightening: nothing changes sides, and no staircases are left.
#pragma once

#include "compute/device/random.hpp"
#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

/// Tightens and asks that every voxel's centre is in its own material.
template <class Backend>
void expect_kept(Executor<Backend>& exec, const char* what, const MeshVolume& volume) {
  TightenResult result;
  const std::size_t mark = exec.arena().mark();
  const MaterialBricks b = bricks_of(exec, volume, 1.2, CubicKernel::catmull_rom, &result);
  EXPECT_EQ(result.left, 0) << what;
  EXPECT_EQ(stray_voxels(exec, b), 0u) << what;
  exec.arena().rewind(mark);
}

template <class Backend>
void EveryVoxelStaysInItsMaterial(Executor<Backend>& exec) {
  const Int3 n(20, 21, 19);
  const Vec3d c(9.6, 10.2, 9.1);
  expect_kept(exec, "ball", label_volume(n, 2, [&](const Vec3d& p) { return length(p - c) < 6.2; }));
  expect_kept(exec, "plate", label_volume(n, 2, [](const Vec3d& p) { return p.z == 9 && p.x > 3 && p.x < 15; }));
  expect_kept(exec, "rod", label_volume(n, 2, [](const Vec3d& p) { return p.z == 9 && p.x == 8; }));
  expect_kept(exec, "oblique plate",
              label_volume(n, 2, [&](const Vec3d& p) { return std::fabs(dot(p - c, Vec3d(0.6, 0.48, 0.64))) < 0.5; }));
  expect_kept(exec, "shell", label_volume(n, 3, [&](const Vec3d& p) {
                const double r = length(p - c);
                return r < 5.6 ? 2 : r < 6.6 ? 1 : 0;
              }));
  expect_kept(exec, "single voxel",
              label_volume(n, 2, [](const Vec3d& p) { return p.x == 9 && p.y == 9 && p.z == 9; }));
  expect_kept(exec, "touching faces", label_volume(n, 3, [](const Vec3d& p) { return p.x < 9 ? 1 : 2; }));
}

template <class Backend>
void EvenTheWorstVoxelsStay(Executor<Backend>& exec) {
  const Int3 n(13, 12, 11);
  expect_kept(exec, "checkerboard", label_volume(n, 2, [](const Vec3d& p) { return int(p.x + p.y + p.z) % 2; }));
  expect_kept(exec, "noise of two", label_volume(n, 2, [](const Vec3d& p) {
                return uniform_random(5, int(p.x + 16 * p.y), int(p.z)) < 0.5f;
              }));
  expect_kept(exec, "noise of five", label_volume(n, 5, [](const Vec3d& p) {
                return int(5 * uniform_random(6, int(p.x + 16 * p.y), int(p.z)));
              }));
}

/// A thin disc, whose voxels have to be held in several rounds, at `shift` from where it usually is: values at the
/// voxels beside its boundary.
template <class Backend>
std::vector<float> values_of_disc(Executor<Backend>& exec, const Vec3d& shift) {
  const Vec3d c(16, 16, 16);
  const auto disc = [&](const Vec3d& p) {
    return std::fabs(dot(p - c, Vec3d(0.6, 0.48, 0.64))) < 0.5 && length(p - c) < 8;
  };
  const std::size_t mark = exec.arena().mark();
  TightenResult result;
  const MaterialBricks b =
      bricks_of(exec, label_volume({40, 40, 40}, 2, [&](const Vec3d& p) { return disc(p - shift); }), 1.2,
                CubicKernel::catmull_rom, &result);
  EXPECT_GT(result.held, 100);
  std::vector<Vec3f> centres;
  for_each_voxel({33, 33, 33}, [&](std::size_t, const Vec3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d step;
      step[axis] = 1;
      if (disc(p + step) == disc(p - step)) continue;
      centres.push_back(in_fields(p + shift));
      return;
    }
  });
  std::vector<float> values;
  for (const FieldSample& s : sample_all(exec, b, centres, 1)) values.push_back(s.value);
  exec.arena().rewind(mark);
  return values;
}

template <class Backend>
void WhereBricksBeginMakesNoDifference(Executor<Backend>& exec) {
  const std::vector<float> values = values_of_disc(exec, {});
  for (const Vec3d& shift : {Vec3d(3, 5, 2), Vec3d(4, 4, 4), Vec3d(7, 1, 6)}) {
    const std::vector<float> shifted = values_of_disc(exec, shift);
    ASSERT_EQ(shifted.size(), values.size());
    for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(shifted[k], values[k], 1e-5) << k;
  }
}

template <class Backend>
void WithoutWidthTheLabelsAreLeftAlone(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({16, 16, 16}, 2, [](const Vec3d& p) { return p.x + 2 * p.y > 20; });
  const MaterialBricks b = bricks_of(exec, volume, 0);
  std::vector<Vec3f> centres;
  for_each_voxel(volume.dims, [&](std::size_t, const Vec3d& p) { centres.push_back(in_fields(p)); });
  const auto found = sample_all(exec, b, centres, 1);
  for (std::size_t k = 0; k < found.size(); ++k) ASSERT_EQ(found[k].value, float(volume.material[k]));
}

/// Angles between the interface's normals and `normal`, degrees, at places along it.
template <class Backend>
std::vector<double> normal_errors(Executor<Backend>& exec, const MaterialBricks& b, const std::vector<Vec3f>& positions,
                                  const std::function<Vec3f(const Vec3f&)>& normal) {
  std::vector<double> errors;
  for (const JunctionPoint& at : bring_onto(exec, b, Junction(0, 1), positions))
    errors.push_back(length(at.direction) > 0 ? degrees_between(at.direction, normal(at.p)) : 90);
  return errors;
}

template <class Backend>
void AnObliquePlaneHasNoStaircase(Executor<Backend>& exec) {
  const Vec3d n = normalized(Vec3d(0.8, 0.33, 0.21)), c(20.2, 17.1, 16.6);
  const MeshVolume volume = label_volume({40, 34, 33}, 2, [&](const Vec3d& p) { return dot(p - c, n) > 0; });
  const Vec3d s = normalized(cross(n, Vec3d(0, 0, 1))), t = cross(n, s);
  std::vector<Vec3f> positions;
  for (int i = -40; i <= 40; ++i)
    for (int j = -40; j <= 40; ++j) positions.push_back(in_fields(c + s * (i * 0.23) + t * (j * 0.23)));
  const auto normal = [&](const Vec3f&) { return Vec3f(n); };
  const auto smooth = normal_errors(exec, bricks_of(exec, volume), positions, normal);
  const auto staircase = normal_errors(exec, bricks_of(exec, volume, 0), positions, normal);
  std::printf("oblique plane: median normal error %.2f degrees, largest %.2f; untightened %.2f\n", median_of(smooth),
              *std::max_element(smooth.begin(), smooth.end()), median_of(staircase));
  EXPECT_LE(median_of(smooth), 3);
  EXPECT_GE(median_of(staircase), 4 * median_of(smooth));
  for (const JunctionPoint& at : bring_onto(exec, bricks_of(exec, volume), Junction(0, 1), positions))
    EXPECT_LT(std::fabs(dot(Vec3d(at.p) - Vec3d(volume_padding + 0.5) - c, n)), 0.5);
}

/// A plane that rises one voxel in `run` along x and in `other_run` along y, its labels tightened with `staircase`:
/// median error of its normals, degrees.
template <class Backend>
double slope_error(Executor<Backend>& exec, double run, double other_run, double staircase) {
  const Vec3d n = normalized(Vec3d(-1 / run, -1 / other_run, 1)), c(40.2, 40.1, 16.6);
  const MeshVolume volume = label_volume({80, 80, 33}, 2, [&](const Vec3d& p) { return dot(p - c, n) > 0; });
  std::vector<Vec3f> positions;
  for (int i = -60; i <= 60; ++i)
    for (int j = -60; j <= 60; ++j) {
      const double x = 0.43 * i, y = 0.43 * j;
      positions.push_back(in_fields(c + Vec3d(x, y, x / run + y / other_run)));
    }
  const std::size_t mark = exec.arena().mark();
  const MaterialBricks b = bricks_of(exec, volume, 1.2, CubicKernel::catmull_rom, nullptr, wide_range, staircase);
  const double error = median_of(normal_errors(exec, b, positions, [&](const Vec3f&) { return Vec3f(n); }));
  exec.arena().rewind(mark);
  return error;
}

template <class Backend>
void StaircasesBecomeSlopes(Executor<Backend>& exec) {
  const double runs[][2] = {{3, 7}, {5, 1e9}, {12, 1e9}, {12.3, 19.7}, {30, 1e9}, {30, 41}};
  for (const auto& [run, other] : runs) {
    const double off = slope_error(exec, run, other, 0), on = slope_error(exec, run, other, 32);
    std::printf("one voxel in %g and in %g: median normal error %.2f degrees, as stairs %.2f\n", run, other, on, off);
    EXPECT_LT(on, 1.7);
    EXPECT_LT(on, 0.6 * off);
  }
}

struct ShareAtTop {
  LabelSlopes slopes;
  int top;
  float* share;
  NACRE_HD void operator()(std::int64_t x) const {
    const Int3 v = Int3(int(x), 8, top) + Int3(volume_padding);
    const auto label = [&](const Int3& at) { return slopes.field.material(at); };
    share[x] = 0;
    if (label(v) == label(v + Int3(0, 0, 1))) return;
    LabelSlopes::End end[LabelSlopes::ends_of_face];
    for (int axis = 0; axis < 2; ++axis) slopes.find_ends(label, 1, v, 2, axis, 1, end + axis, end + axis + 2);
    share[x] = -slopes.offset(end, 1, 2);
  }
};

/// Of the voxels above voxel `top`, what belongs to the lower material, less what does not of those below; along x at y
/// = 8.
template <class Backend>
std::vector<float> shares_along_x(Executor<Backend>& exec, const Int3& n,
                                  const std::function<bool(const Vec3d&)>& lower, int top) {
  const std::size_t mark = exec.arena().mark();
  Arena::Scope scope(exec.arena());
  const MaterialBricks b = bricks_of(exec, label_volume(n, 2, lower), 0);
  Array<float> share = exec.arena().template temporary<float>(n.x);
  exec.for_each(n.x, ShareAtTop{{b.view()}, top, share.data()});
  const std::vector<float> shares = share.download();
  exec.arena().rewind(mark);
  return shares;
}

/// Four treads of six voxels: in the middle ones the boundary runs from centre to centre.
template <class Backend>
void ATreadIsReadAsASlope(Executor<Backend>& exec) {
  const auto staircase = [](const Vec3d& p) { return p.z <= 4 + int(p.x) / 6; };
  const auto second = shares_along_x(exec, {24, 17, 16}, staircase, 5);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(second[6 + k], (k - 2.5f) / 6, 1e-5f) << k;
  for (const int x : {0, 3, 5, 12, 20}) EXPECT_EQ(second[x], 0) << x;  // the boundary is not there
}

/// Steps of more than three voxels leave their treads alone, and so does the rim of a plate.
template <class Backend>
void WallsAreNoSteps(Executor<Backend>& exec) {
  const auto all_zero = [&](const Int3& n, int top, const std::function<bool(const Vec3d&)>& lower) {
    const auto shares = shares_along_x(exec, n, lower, top);
    return std::all_of(shares.begin(), shares.end(), [](float s) { return s == 0; });
  };
  const auto staircase = [](int step) { return [=](const Vec3d& p) { return p.z <= 4 + step * (int(p.x) / 8); }; };
  EXPECT_FALSE(all_zero({24, 17, 20}, 7, staircase(3)));
  EXPECT_TRUE(all_zero({24, 17, 20}, 8, staircase(4)));
  EXPECT_TRUE(all_zero({24, 17, 20}, 7, [](const Vec3d& p) {
    return p.z >= 5 && p.z < 8 && p.x > 6 && p.x < 16 && p.y > 3 && p.y < 13;
  }));
}

/// Counts faces in lines of eight whose ends are others than each face alone has.
struct CompareEnds {
  LabelSlopes slopes;
  std::uint64_t* different;
  std::uint64_t* found;  ///< ends that are steps

  NACRE_HD void operator()(std::int64_t i) const {  // voxels
    const Int3 n = slopes.field.voxels(), v(int(i % n.x), int(i / n.x % n.y), int(i / n.x / n.y));
    const auto label = [&](const Int3& at) { return slopes.field.material(at); };
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 1; k <= 2; ++k) {
        const int along = (axis + k) % 3;
        Int3 up{}, on{};
        up[axis] = 1, on[along] = 1;
        if (!is_within(v + up + on * Int3(7), n)) continue;
        unsigned boundary = 0;
        for (int face = 0; face < 8; ++face)
          boundary |= unsigned(label(v + on * Int3(face)) != label(v + on * Int3(face) + up)) << face;
        LabelSlopes::End ahead[8], behind[8], own_ahead, own_behind;
        slopes.find_ends(label, boundary, v, axis, along, 1, ahead, behind);
        for (int face = 0; face < 8; ++face) {
          if (!(boundary >> face & 1)) continue;
          slopes.find_ends(label, 1, v + on * Int3(face), axis, along, 1, &own_ahead, &own_behind);
          const bool same = ahead[face] == own_ahead && behind[face] == own_behind;
          atomic_add(different, std::uint64_t(same ? 0 : 1));
          atomic_add(found, std::uint64_t(own_ahead.step != 0) + std::uint64_t(own_behind.step != 0));
        }
      }
  }
};

/// Faces of one tread share its ends: as each would find them by itself, also where these are out of reach.
template <class Backend>
void FacesOfATreadShareItsEnds(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({33, 29, 31}, 3, [](const Vec3d& p) {
    const double height = 8 + 0.3 * p.x + 0.17 * p.y + 2 * std::sin(0.4 * p.x) * std::cos(0.3 * p.y);
    return p.z < height ? 0 : p.x + 0.4 * p.z < 24 ? 1 : 2;
  });
  const std::size_t mark = exec.arena().mark();
  Arena::Scope scope(exec.arena());
  const MaterialBricks b = bricks_of(exec, volume, 0);
  const Int3 n = b.view().voxels();
  Array<std::uint64_t> counts = exec.arena().template temporary<std::uint64_t>(2);
  for (const float reach : {32.0f, 4.0f, 2.0f}) {
    counts.fill_bytes(0);
    exec.for_each(std::int64_t(n.x) * n.y * n.z, CompareEnds{{b.view(), reach}, counts.data(), counts.data() + 1});
    EXPECT_EQ(counts.download()[0], 0u) << reach;
    EXPECT_GT(counts.download()[1], 1000u) << reach;
  }
  exec.arena().rewind(mark);
}

/// Where two materials are alone in a block and in all around it, one function is made from the other. The values are
/// those of a volume where a third material is in a block beside it, and too far away to have a share.
template <class Backend>
void PairsAreSmoothedAsOthersAre(Executor<Backend>& exec) {
  const auto wavy = [](const Vec3d& p) { return p.z < 20 + 2.3 * std::sin(0.9 * p.x) * std::cos(1.1 * p.y) ? 1 : 2; };
  const Int3 n(64, 40, 40);
  const auto values = [&](bool third) {
    const std::size_t mark = exec.arena().mark();
    TightenResult result;
    const MaterialBricks b =
        bricks_of(exec, label_volume(n, 4, [&](const Vec3d& p) { return third && p.x > 35 ? 3 : wavy(p); }), 1.2,
                  CubicKernel::catmull_rom, &result);
    EXPECT_GT(result.held, 20);
    std::vector<Vec3f> centres;
    for_each_voxel(n, [&](std::size_t, const Vec3d& p) {
      if (p.x >= 24 && p.x < 26 && p.y >= 16 && p.y < 24 && std::fabs(p.z - 20) < 4) centres.push_back(in_fields(p));
    });
    std::vector<float> all;
    for (const std::uint32_t material : {1, 2})
      for (const FieldSample& s : sample_all(exec, b, centres, material)) all.push_back(s.value);
    exec.arena().rewind(mark);
    return all;
  };
  const std::vector<float> pairs = values(false), others = values(true);
  ASSERT_EQ(pairs.size(), others.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) ASSERT_NEAR(pairs[k], others[k], 1e-5) << k;
}

/// The cube between eight voxel centres that holds a point has corners of both materials: its voxel shell.
inline bool in_shell(const MeshVolume& volume, const Vec3f& p) {
  const Vec3d at = Vec3d(p) - Vec3d(volume_padding + 0.5);
  bool found[2] = {};
  for (int k = 0; k < 8; ++k) {
    const Int3 v(int(std::floor(at.x)) + (k & 1), int(std::floor(at.y)) + (k >> 1 & 1),
                 int(std::floor(at.z)) + (k >> 2));
    found[volume.material[(std::size_t(v.z) * volume.dims.y + v.y) * volume.dims.x + v.x]] = true;
  }
  return found[0] && found[1];
}

template <class Backend>
void ABallOfLabelsBecomesRound(Executor<Backend>& exec) {
  const Vec3d c(24.8, 25.3, 25.1);
  const double radius = 20;
  const MeshVolume volume = label_volume({51, 51, 51}, 2, [&](const Vec3d& p) { return length(p - c) < radius; });
  const MaterialBricks b = bricks_of(exec, volume);
  std::vector<Vec3f> positions;
  for (const Vec3d& d : even_directions(20000)) positions.push_back(in_fields(c + d * radius));
  const Vec3f centre = in_fields(c);
  const auto errors = normal_errors(exec, b, positions, [&](const Vec3f& p) { return normalized(p - centre); });
  double away = 0, most = 0, outside = 0;
  for (const JunctionPoint& at : bring_onto(exec, b, Junction(0, 1), positions)) {
    const double off = std::fabs(length(at.p - centre) - radius);
    away += off / double(positions.size());
    most = std::max(most, off);
    outside += in_shell(volume, at.p) ? 0 : 1;
  }
  std::printf(
      "ball of labels: distance mean %.3f max %.3f, median normal error %.2f degrees, out of the shell %.0f of %zu\n",
      away, most, median_of(errors), outside, positions.size());
  EXPECT_LE(away, 0.25);
  EXPECT_LE(most, 1);
  EXPECT_LE(median_of(errors), 5);
  EXPECT_EQ(outside, 0);
}

NACRE_DEVICE_TEST(Tighten, EveryVoxelStaysInItsMaterial)
NACRE_DEVICE_TEST(Tighten, EvenTheWorstVoxelsStay)
NACRE_DEVICE_TEST(Tighten, WhereBricksBeginMakesNoDifference)
NACRE_DEVICE_TEST(Tighten, WithoutWidthTheLabelsAreLeftAlone)
NACRE_DEVICE_TEST(Tighten, AnObliquePlaneHasNoStaircase)
NACRE_DEVICE_TEST(Tighten, StaircasesBecomeSlopes)
NACRE_DEVICE_TEST(Tighten, ATreadIsReadAsASlope)
NACRE_DEVICE_TEST(Tighten, WallsAreNoSteps)
NACRE_DEVICE_TEST(Tighten, FacesOfATreadShareItsEnds)
NACRE_DEVICE_TEST(Tighten, PairsAreSmoothedAsOthersAre)
NACRE_DEVICE_TEST(Tighten, ABallOfLabelsBecomesRound)

}  // namespace nacre::test
