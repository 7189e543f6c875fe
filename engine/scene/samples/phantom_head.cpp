// Nacre: the head: scalp, skull, fluid, and a brain whose cortex is folded like the real one.
#include "engine/scene/samples/phantom_kit.hpp"

namespace nacre {
namespace {

enum Tissue : std::uint8_t { outside, scalp, skull, fluid, brain };

constexpr Int3 head_dims{199, 250, 249};
const Vec3d cranium(99, 130, 150);
const Vec3d scalp_semi(86, 108, 94), skull_semi(79, 101, 87), cavity_semi(71, 93, 79), cortex_semi(68, 90, 76);
const Vec3d cerebellum(99, 188, 104), cerebellum_semi(44, 34, 24);

/// The folds: turn these to change the area. Lengths in voxels.
struct Folds {
  double wave = 10;          ///< from gyrus to gyrus is about half of it
  double half_width = 1.35;  ///< of a sulcus
  double depth = 32;         ///< of a sulcus, on average
  double depth_varies = 7;
};
constexpr Folds cortex_folds;
constexpr Folds cerebellum_folds{10, 1.2, 11, 2};

double smooth_max(double a, double b, double k) { return -smooth_union(-a, -b, k); }

/// Sulci of a body shaped like an ellipsoid: sheets across its surface, where a random wave field on the ellipsoid is
/// zero. Their net has no ends and no crossings, like that of the cortex.
class Sulci {
 public:
  Sulci(const Vec3d& centre, const Vec3d& semi, const Folds& folds, std::uint32_t seed)
      : centre_(centre),
        semi_(semi),
        radius_(std::cbrt(semi.x * semi.y * semi.z)),
        folds_(folds),
        net_(seed, 24, 6.2831853 * radius_ / folds.wave),
        depths_(seed + 1, 8, 9) {}

  /// Distance to the nearest sulcus, negative in it; `below` is the depth of `p` under the body's hull.
  double distance(const Vec3d& p, double below) const {
    const double reach = folds_.depth + 2 * folds_.depth_varies + 4;
    if (below > reach || below < -4) return 4;
    const Vec3d d = p - centre_;
    const Vec3d u{d.x / semi_.x, d.y / semi_.y, d.z / semi_.z};
    const double r = length(u);
    if (r < 0.05) return 4;
    const Vec3d on = u / r;
    const Waves::Sample net = net_(on);
    const Vec3d slope = net.gradient - on * dot(net.gradient, on);
    const double across = std::abs(net.value) / std::max(length(slope), 1e-6) * radius_ * r;
    const double depth = folds_.depth + folds_.depth_varies * depths_.value(on);
    return smooth_max(std::min(across, 8.0) - folds_.half_width, below - depth, 2.0);
  }

 private:
  Vec3d centre_, semi_;
  double radius_;
  Folds folds_;
  Waves net_, depths_;
};

/// Skin: cranium, face, nose, ears and neck; the neck is cut by the volume's lowest face.
void unite_outer(DistanceGrid& outer) {
  outer.unite_ellipsoid(cranium, scalp_semi);
  outer.unite_ellipsoid({99, 82, 92}, {62, 66, 78}, 22);
  outer.unite(
      {0, 0, -1}, {198, 249, 130},
      [](const Vec3d& p) {
        const double neck = ellipsoid_distance({p.x - 99, p.y - 148, 0}, {54, 60, 1});
        return smooth_max(neck, p.z - 96, 20);
      },
      18);
  const std::vector<Tube> nose{{{{99, 22, 122}, 6}, {{99, 9, 92}, 9.5}, {{99, 22, 84}, 10}}};
  outer.unite_tubes(nose, 9);
  for (const int side : {-1, 1}) outer.unite_ellipsoid({99.0 + side * 86, 142, 118}, {5, 15, 22}, 7);
}

/// Bone: the vault is a shell between two ellipsoids; face, jaw and spine are joined to it.
void unite_bone(DistanceGrid& bone) {
  bone.unite_ellipsoid(cranium, skull_semi);
  bone.unite_ellipsoid({99, 78, 100}, {44, 50, 52}, 12);
  std::vector<Tube> jaw(1);
  for (int n = 0; n <= 24; ++n) {
    const double angle = 3.14159265 * (n / 24.0 - 0.5);
    const double lift = std::pow(std::abs(n / 12.0 - 1), 3.0);
    jaw[0].push_back({{99 + 47 * std::sin(angle), 112 - 78 * std::cos(angle), 34 + 52 * lift}, 6.5});
  }
  bone.unite_tubes(jaw, 2);
  for (double z = 6; z < 66; z += 17)
    bone.unite(
        {60, 120, z - 12}, {140, 200, z + 12},
        [&](const Vec3d& p) { return rounded_extrusion(norm(p.x - 99, p.y - 160) - 19, p.z - z, 6.8, 3.5); }, 2);
}

/// Air in nose and sinuses, and eyes, which are cut out of the bone.
double orbit_distance(const Vec3d& p) {
  const Vec3d d{std::abs(p.x - 99) - 29, p.y - 40, p.z - 122};
  return round_cone(d, {0, 0, 0}, {-9, 26, 0}, 17, 7);
}

double airway_distance(const Vec3d& p) {
  const Vec3d q{std::abs(p.x - 99), p.y, p.z};
  double d = round_cone(q, {6.5, 6, 82}, {6.5, 34, 92}, 3.6, 5.2);  // nostrils
  d = smooth_union(d, round_cone(q, {6.5, 34, 92}, {5, 92, 90}, 5.2, 6.5), 3);
  d = smooth_union(d, round_cone(q, {0, 96, 88}, {0, 104, -12}, 9, 8), 5);   // throat
  d = std::min(d, ellipsoid_distance(q - Vec3d(30, 58, 86), {10, 15, 13}));  // maxillary sinuses
  return d;
}

/// Fluid inside of the brain: two horns and what joins them.
double ventricle_distance(const Vec3d& p) {
  const Vec3d q{std::abs(p.x - 99), p.y, p.z};
  double d = round_cone(q, {8, 92, 158}, {9, 130, 166}, 5, 6);
  d = smooth_union(d, round_cone(q, {9, 130, 166}, {20, 170, 150}, 6, 5.5), 3);
  d = smooth_union(d, round_cone(q, {20, 170, 150}, {30, 140, 130}, 5, 3.5), 3);
  return smooth_union(d, round_cone(q, {0, 128, 158}, {0, 150, 118}, 3.2, 3.2), 3);
}

struct Brain {
  Sulci cortex{cranium, cortex_semi, cortex_folds, 3};
  Sulci folia{cerebellum, cerebellum_semi, cerebellum_folds, 5};

  /// Negative inside of the cerebrum, the cerebellum or the stem.
  double operator()(const Vec3d& p) const {
    const double stem = round_cone(p, {99, 148, 128}, {99, 160, -12}, 13, 8);
    double small = ellipsoid_distance(p - cerebellum, cerebellum_semi);
    if (small < 3) small = smooth_cut(small, folia.distance(p, -small), 1.0);
    double large = ellipsoid_distance(p - cranium, cortex_semi);
    if (large < 3) {
      const double below = -large;
      // The base is flat; behind, the cerebellum has its room; the hemispheres are parted down to the callosum.
      large = smooth_max(large, 84 - p.z + 0.25 * (p.y - 130), 10);
      large = smooth_cut(large, ellipsoid_distance(p - cerebellum, cerebellum_semi + Vec3d(3)), 4);
      large = smooth_cut(large, cortex.distance(p, below), 1.2);
      const double parting =
          smooth_max(std::abs(p.x - 99) - 1.7, 22 - ellipsoid_distance(p - cranium, {60, 62, 45}) - 22, 4);
      large = smooth_cut(large, parting, 1.5);
    }
    return smooth_union(std::min(large, small), stem, 4);
  }
};

void make_head(const PhantomGrid& grid, Phantom& phantom) {
  DistanceGrid outer(grid), bone(grid);
  unite_outer(outer);
  unite_bone(bone);
  const Brain brain_distance;
  phantom.labels.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    std::uint8_t label = outside;
    const double cavity =
        std::min(ellipsoid_distance(p - cranium, cavity_semi), round_cone(p, {99, 152, 110}, {99, 160, -14}, 17, 12));
    if (cavity < 0) {
      label = brain_distance(p) < 0 && ventricle_distance(p) > 0 ? brain : fluid;
    } else if (outer[at] < 0) {
      label = bone[at] < 0 && orbit_distance(p) > 0 ? skull : scalp;
      if (cavity > 4 && airway_distance(p) < 0) label = outside;
    }
    phantom.labels[at] = label;
  });
  remove_crumbs(grid, phantom.labels, 64);
}

}  // namespace

PhantomDefinition head_phantom() {
  return {{"head", "scalp 1, skull 2, fluid 3, folded brain 4", head_dims, true}, make_head};
}

}  // namespace nacre
