// Nacre: the torso: soft tissue, lungs with airways and fissures, heart and vessels, bones, in a cube.
#include "engine/scene/samples/phantom_chest.hpp"

namespace nacre {
namespace {

enum Tissue : std::uint8_t { outside, soft, lung, blood, bone };

constexpr int side_length = 136;
constexpr double fissure_width = 2.2;  // between lobes
constexpr double lobule_height = 1.4;  // of the bumps on a lung's surface
constexpr double lobule_wave = 10;     // their length
constexpr double twigs_apart = 8;      // mesh of the trees within a lung
constexpr double twig_radius = 1.55;

ChestFrame chest() {
  ChestFrame c;
  c.centre = {67.5, 66, 72};
  c.a = 53;
  c.b = 45;
  c.height = 118;
  c.pairs = 11;
  c.bone = 1.4;
  c.spine = 7;
  c.tall = 3.4;
  return c;
}

/// The trunk, cut by the volume's lowest and highest faces.
double skin_distance(const Vec3d& p) {
  const double t = (p.z - 60) / 80;
  const double width = 63 * (1 - 0.16 * t * t), depth = 57 * (1 - 0.10 * t * t);
  return ellipsoid_distance({p.x - 67.5, p.y - 67.5, 0}, {width, depth, 1});
}

/// Airways and vessels of one lung, from its root.
void add_trees(const ChestFrame& c, int side, std::vector<Tube>& airways, std::vector<Tube>& vessels) {
  const Vec3d low = c.centre - Vec3d(c.a, c.b, 0.5 * c.height), high = c.centre + Vec3d(c.a, c.b, 0.5 * c.height);
  const auto inside = [&](const Vec3d& p) { return lung_distance(p, c, side, fissure_width) < -4.5; };
  const Vec3d root = c.centre + Vec3d(side * 0.2 * c.a, 0.1 * c.b, 0.1 * c.height);
  for (const Tube& tube : grow_tree(root, scatter(low, high, twigs_apart, 7, inside), twig_radius, 4.0))
    airways.push_back(tube);
  const Vec3d half(0.5 * twigs_apart), below(0, -3, -7);
  for (const Tube& tube : grow_tree(root + below, scatter(low + half, high, twigs_apart, 11, inside), twig_radius, 3.6))
    vessels.push_back(tube);
}

void make_torso(const PhantomGrid& grid, Phantom& phantom) {
  const ChestFrame c = chest();
  DistanceGrid bones(grid), heart(grid), air(grid);
  bones.unite_tubes(rib_tubes(c), 0.8);
  unite_spine(bones, c, -2, side_length + 2);
  unite_sternum(bones, c);
  std::vector<Tube> airways, vessels;
  for (const int side : {-1, 1}) add_trees(c, side, airways, vessels);
  const Vec3d fork = c.centre + Vec3d(0, 0.1 * c.b, 0.17 * c.height);
  airways.push_back({{fork, 4.4}, {Vec3d(fork.x, fork.y - 4, side_length + 8), 4.8}});
  for (const int side : {-1, 1}) airways.push_back({{fork, 4.2}, {fork + Vec3d(side * 0.2 * c.a, 0, -8.3), 3.8}});
  air.unite_tubes(airways, 1.2);
  unite_heart(heart, c.centre + Vec3d(0.12 * c.a, -0.28 * c.b, -0.08 * c.height), 23, side_length + 6);
  heart.unite_tubes(vessels, 1.2);
  const Waves lobules(5, 14, 2 * 3.14159265358979323846 / lobule_wave);
  phantom.labels.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    std::uint8_t label = outside;
    if (skin_distance(p) < 0) {
      label = soft;
      double d = 1e9;
      for (const int side : {-1, 1}) d = std::min(d, lung_distance(p, c, side, fissure_width));
      if (std::abs(d) < 4 * lobule_height) d += lobule_height * lobules.value(p);
      if (d < 0) label = lung;
      if (air[at] < 0) label = outside;
      if (heart[at] < 0) label = blood;
      if (bones[at] < 0) label = bone;
    }
    phantom.labels[at] = label;
  });
  remove_crumbs(grid, phantom.labels, 64);
}

}  // namespace

PhantomDefinition torso_phantom() {
  return {{"torso",
           "chest: soft tissue 1, lungs 2, heart and vessels 3, bones 4; airways open to the outside 0",
           {side_length, side_length, side_length},
           true},
          make_torso};
}

}  // namespace nacre
