// Nacre: the parts of a chest that several phantoms share.
#include "engine/scene/samples/phantom_chest.hpp"

namespace nacre {
namespace {

constexpr double pi = 3.14159265358979323846;

/// How wide the cage is at a height: narrow at the top, widest below the middle.
double cage_width(const ChestFrame& chest, double z) {
  const double t = (z - chest.centre.z) / (0.5 * chest.height);  // -1..1 from the lowest rib to the highest
  return std::sqrt(std::max(0.15, 1 - 0.62 * std::pow((t + 0.35) / 1.35, 2)));
}

/// Centre line of a rib: from the spine (angle 0) around one side to the front (angle pi), falling on its way.
Vec3d rib_point(const ChestFrame& chest, double z, int side, double angle) {
  const double fall = 0.17 * chest.height * std::sin(0.5 * std::min(angle, 0.8 * pi));
  const double w = cage_width(chest, z);
  return {chest.centre.x + side * chest.a * w * std::sin(angle),
          chest.centre.y + chest.b * (0.2 + 0.8 * w) * std::cos(angle), z - fall};
}

double smooth_max(double a, double b, double k) { return -smooth_union(-a, -b, k); }

}  // namespace

std::vector<Tube> rib_tubes(const ChestFrame& chest) {
  std::vector<Tube> tubes;
  for (int n = 0; n < chest.pairs; ++n) {
    const double t = chest.pairs > 1 ? double(n) / (chest.pairs - 1) : 0.5;  // 0: lowest
    const double z = chest.centre.z - 0.38 * chest.height + 0.86 * chest.height * t;
    const double end = pi * (n == 0 ? 0.5 : n == 1 ? 0.62 : 0.965);  // the lowest two end free
    for (const int side : {-1, 1}) {
      Tube tube;
      constexpr int points = 40;
      for (int k = 0; k <= points; ++k) {
        const double angle = 0.06 * pi + (end - 0.06 * pi) * k / points;
        tube.push_back({rib_point(chest, z, side, angle), chest.bone, chest.tall});
      }
      tubes.push_back(std::move(tube));
    }
  }
  return tubes;
}

void unite_spine(DistanceGrid& bones, const ChestFrame& chest, double low, double high) {
  const double y = chest.centre.y + 0.9 * chest.b, r = chest.spine, thin = r / 3, step = 1.4 * r;
  for (double z = low + 0.5 * step; z < high; z += step) {
    const Vec3d at{chest.centre.x, y, z};
    const Vec3d half{1.25 * r, 1.25 * r, 0.5 * step};
    bones.unite(
        at - half * 1.6, at + half * 1.6,
        [&](const Vec3d& p) {
          const Vec3d d = p - at;
          return rounded_extrusion(norm(d.x, d.y) - r, d.z, 0.5 * (step - thin), 0.8 * thin);
        },
        0.5);
    const Vec3d back{chest.centre.x, y + 2.3 * r, z - 0.3 * step};
    const std::vector<Tube> processes{
        {{at + Vec3d(0, 0.8 * r, 0), 0.9 * thin}, {back, 0.8 * thin}},
        {{at + Vec3d(0, 0.7 * r, 0), 0.9 * thin}, {at + Vec3d(1.9 * r, 1.0 * r, 0), 0.8 * thin}},
        {{at + Vec3d(0, 0.7 * r, 0), 0.9 * thin}, {at + Vec3d(-1.9 * r, 1.0 * r, 0), 0.8 * thin}}};
    for (const Tube& tube : processes) {
      const Vec3d around(2 * thin + 4);
      bones.unite(
          min(tube[0].centre, tube[1].centre) - around, max(tube[0].centre, tube[1].centre) + around,
          [&](const Vec3d& p) { return round_cone(p, tube[0].centre, tube[1].centre, tube[0].radius, tube[1].radius); },
          1.5);
    }
  }
}

void unite_sternum(DistanceGrid& bones, const ChestFrame& chest) {
  const double y = chest.centre.y - 0.93 * chest.b, r = 1.15 * chest.bone;
  const Vec3d low{chest.centre.x, y, chest.centre.z - 0.2 * chest.height};
  const Vec3d high{chest.centre.x, y + 0.1 * chest.b, chest.centre.z + 0.34 * chest.height};
  const Vec3d wide(2.2 * r, 0, 0);
  const std::vector<Tube> plate{
      {{low, r}, {high, r}}, {{low + wide * 0.5, r}, {high + wide, r}}, {{low - wide * 0.5, r}, {high - wide, r}}};
  bones.unite_tubes(plate, 1.0);
  std::vector<Tube> clavicles;
  for (const int side : {-1, 1}) {
    const Vec3d from = high + wide * side;
    clavicles.push_back({{from, 1.1 * r},
                         {from + Vec3d(side * 0.3 * chest.a, 0.05 * chest.b, 0.04 * chest.height), r},
                         {from + Vec3d(side * 0.62 * chest.a, 0.5 * chest.b, 0.06 * chest.height), 1.2 * r}});
  }
  bones.unite_tubes(clavicles, 1.0);
}

void unite_scapulae(DistanceGrid& bones, const ChestFrame& chest) {
  const Vec3d c = chest.centre + Vec3d(0, 0, 0.12 * chest.height);
  const double off = 2.4 * chest.bone + 1.5;
  for (const int side : {-1, 1}) {
    const Vec3d middle = c + Vec3d(side * 0.5 * chest.a, 0.75 * chest.b, 0);
    const Vec3d semi{0.25 * chest.a, 0.55 * chest.b, 0.24 * chest.height};
    bones.unite(
        middle - semi * 1.2, middle + semi * 1.2,
        [&](const Vec3d& p) {
          const double w = cage_width(chest, p.z + 0.13 * chest.height);
          const Vec3d d{p.x - c.x, p.y - c.y, 0};
          const double cage = ellipsoid_distance(d, {chest.a * w, chest.b * (0.2 + 0.8 * w), 1}) - off;
          return smooth_max(std::abs(cage) - chest.bone, ellipsoid_distance(p - middle, semi), 2.0);
        },
        0.5);
  }
}

double lung_distance(const Vec3d& p, const ChestFrame& chest, int side, double fissure) {
  const Vec3d c = chest.centre + Vec3d(side * 0.45 * chest.a, 0.02 * chest.b, 0);
  const Vec3d semi{0.38 * chest.a, 0.78 * chest.b, 0.48 * chest.height};
  const double rim = 0.12 * chest.a;  // knife edges would break into crumbs
  double d = ellipsoid_distance(p - c, semi);
  // From below the diaphragm's dome cuts in; from the middle the heart, more so on the left.
  const Vec3d dome = chest.centre + Vec3d(side * 0.42 * chest.a, 0.05 * chest.b, -0.62 * chest.height);
  d = smooth_cut(d, ellipsoid_distance(p - dome, {0.55 * chest.a, 0.85 * chest.b, 0.34 * chest.height}), rim);
  const Vec3d heart = chest.centre + Vec3d(0.12 * chest.a, -0.25 * chest.b, -0.1 * chest.height);
  const double room = side > 0 ? 0.40 : 0.30;
  d = smooth_cut(d, ellipsoid_distance(p - heart, {room * chest.a, 0.5 * chest.b, 0.28 * chest.height}), rim);
  if (fissure > 0) {  // an oblique sheet, bent; on the right a second one
    const Vec3d u = p - c;
    const double bend = 0.05 * chest.height * std::sin(2.5 * u.x / semi.x);
    const double oblique = std::abs(0.77 * u.z + 0.64 * (u.y * semi.z / semi.y) * 0.8 + bend) - 0.5 * fissure;
    d = smooth_cut(d, oblique, 1.5);
    if (side < 0 && u.y < 0) {
      const double level = std::abs(u.z - 0.12 * chest.height + 0.4 * bend) - 0.5 * fissure;
      d = smooth_cut(d, smooth_max(level, u.y + 0.1 * semi.y, 2), 1.5);
    }
  }
  return d;
}

void unite_heart(DistanceGrid& heart, const Vec3d& c, double s, double top) {
  const double fillet = 0.25 * s;
  heart.unite_ellipsoid(c + Vec3d(0.25, -0.15, -0.15) * s, Vec3d(0.62, 0.55, 0.8) * s, fillet);  // left ventricle
  heart.unite_ellipsoid(c + Vec3d(-0.25, -0.3, -0.1) * s, Vec3d(0.55, 0.45, 0.68) * s, fillet);  // right ventricle
  heart.unite_ellipsoid(c + Vec3d(-0.45, 0.2, 0.4) * s, Vec3d(0.42, 0.42, 0.4) * s, fillet);     // right atrium
  heart.unite_ellipsoid(c + Vec3d(0.2, 0.45, 0.4) * s, Vec3d(0.5, 0.38, 0.36) * s, fillet);      // left atrium
  const double r = 0.17 * s;
  std::vector<Tube> vessels;
  Tube aorta;  // up, over the arch, down along the spine
  const Vec3d arch = c + Vec3d(0.12, 0.35, 1.25) * s;
  aorta.push_back({c + Vec3d(0.0, -0.05, 0.4) * s, 1.15 * r});
  for (int n = 0; n <= 16; ++n) {
    const double angle = pi * n / 16;
    aorta.push_back({arch + Vec3d(0.02 * n, -0.5 * std::cos(angle), 0.42 * std::sin(angle)) * s, 1.1 * r});
  }
  aorta.push_back({c + Vec3d(0.44, 0.95, 0.2) * s, r});
  aorta.push_back({c + Vec3d(0.36, 1.0, -2.4) * s, 0.85 * r});
  vessels.push_back(aorta);
  vessels.push_back({{c + Vec3d(-0.5, 0.15, 0.5) * s, 0.95 * r},
                     {c + Vec3d(-0.52, 0.2, 1.3) * s, 0.85 * r},
                     {Vec3d(c.x - 0.5 * s, c.y + 0.15 * s, top), 0.8 * r}});  // upper cava
  vessels.push_back({{c + Vec3d(-0.45, 0.25, 0.2) * s, 0.95 * r}, {c + Vec3d(-0.4, 0.5, -2.4) * s, 0.9 * r}});
  vessels.push_back({{c + Vec3d(-0.1, -0.25, 0.4) * s, r},
                     {c + Vec3d(0.05, 0.05, 0.95) * s, r},
                     {c + Vec3d(0.75, 0.4, 0.85) * s, 0.8 * r}});  // pulmonary artery, to the left and right
  vessels.push_back({{c + Vec3d(0.05, 0.05, 0.95) * s, 0.9 * r}, {c + Vec3d(-0.95, 0.4, 0.85) * s, 0.8 * r}});
  heart.unite_tubes(vessels, 0.5 * fillet);
}

double chamber_distance(const Vec3d& p, const Vec3d& c, double s) {
  const double left = ellipsoid_distance(p - c - Vec3d(0.27, -0.13, -0.1) * s, Vec3d(0.36, 0.3, 0.52) * s);
  const double right = ellipsoid_distance(p - c - Vec3d(-0.3, -0.32, -0.1) * s, Vec3d(0.3, 0.25, 0.45) * s);
  const double right_atrium = ellipsoid_distance(p - c - Vec3d(-0.48, 0.22, 0.43) * s, Vec3d(0.28, 0.28, 0.27) * s);
  const double left_atrium = ellipsoid_distance(p - c - Vec3d(0.2, 0.48, 0.42) * s, Vec3d(0.34, 0.24, 0.22) * s);
  return smooth_union(smooth_union(left, left_atrium, 0.15 * s), smooth_union(right, right_atrium, 0.15 * s), 0.05 * s);
}

}  // namespace nacre
