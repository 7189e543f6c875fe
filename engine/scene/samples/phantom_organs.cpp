// Nacre: scalar phantoms of a chest: heart, lungs, ribcage. 1 inside, 0 outside, interface at 0.5, smooth everywhere.
#include "engine/scene/samples/phantom_chest.hpp"

namespace nacre {
namespace {

constexpr Int3 chest_dims{268, 129, 177};
constexpr double marrow_radius = 2.2;  // ribs are hollow

ChestFrame chest() {
  ChestFrame c;
  c.centre = {133.5, 64, 90};
  c.a = 118;
  c.b = 50;
  c.height = 164;
  c.pairs = 12;
  c.bone = 4.7;
  c.spine = 11;
  c.tall = 1.2;
  return c;
}

void make_heart(const PhantomGrid& grid, Phantom& phantom) {
  DistanceGrid heart(grid);
  const Vec3d centre = chest().centre + Vec3d(10, -14, -22);
  constexpr double size = 56;
  unite_heart(heart, centre, size, 182);
  phantom.values.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    phantom.values[at] = soft_value(smooth_cut(double(heart[at]), chamber_distance(p, centre, size), 2.0));
  });
}

void make_lungs(const PhantomGrid& grid, Phantom& phantom) {
  ChestFrame c = chest();
  c.a = 90;
  c.b = 46;
  c.height = 136;
  phantom.values.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    const double d = std::min(lung_distance(p, c, -1, 5), lung_distance(p, c, 1, 5));
    phantom.values[at] = soft_value(d);
  });
}

void make_ribcage(const PhantomGrid& grid, Phantom& phantom) {
  ChestFrame c = chest();
  DistanceGrid bones(grid);
  std::vector<Tube> ribs = rib_tubes(c);
  bones.unite_tubes(ribs, 1.0);
  c.bone = 1.9;  // of the flat bones
  unite_spine(bones, c, 0, 180);
  unite_sternum(bones, c);
  unite_scapulae(bones, c);
  DistanceGrid marrow(grid);
  for (Tube& rib : ribs) {
    rib = Tube(rib.begin() + 2, rib.end() - 2);
    for (TubePoint& point : rib) point.radius = marrow_radius;
  }
  marrow.unite_tubes(ribs, 0);
  phantom.values.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d&) {
    phantom.values[at] = soft_value(std::max(double(bones[at]), -double(marrow[at])));
  });
}

}  // namespace

PhantomDefinition heart_phantom() {
  return {{"heart", "hollow heart with its great vessels, scalar; --isovalue 0.5", chest_dims, false}, make_heart};
}

PhantomDefinition lungs_phantom() {
  return {{"lungs", "two lungs with fissures, scalar; --isovalue 0.5", chest_dims, false}, make_lungs};
}

PhantomDefinition ribcage_phantom() {
  return {{"ribcage", "ribs, spine, sternum, shoulder blades, scalar; --isovalue 0.5", chest_dims, false},
          make_ribcage};
}

}  // namespace nacre
