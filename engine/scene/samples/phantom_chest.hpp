// Nacre: the parts of a chest that several phantoms share, as tubes and distances in one frame.
#pragma once

#include "engine/scene/samples/phantom_kit.hpp"

namespace nacre {

/// Where a chest lies: x to the left, y to the back, z up. Its bones stand on ellipses about the centre.
struct ChestFrame {
  Vec3d centre;         ///< of the volume of the chest
  double a = 1, b = 1;  ///< half width and half depth of the widest rib, at the middle of the bone
  double height = 1;    ///< from the lowest rib to the highest
  int pairs = 12;
  double bone = 2.5;  ///< half thickness of a rib
  double tall = 2;    ///< a rib is this much higher than thick, half of it above, half below
  double spine = 6;   ///< radius of a vertebra's body
};

/// Ribs, flat, from the spine to the sternum.
std::vector<Tube> rib_tubes(const ChestFrame& chest);

/// Spine: bodies with gaps for the discs between them, and processes. Sternum with clavicles.
void unite_spine(DistanceGrid& bones, const ChestFrame& chest, double low, double high);
void unite_sternum(DistanceGrid& bones, const ChestFrame& chest);
/// Shoulder blades: thin plates behind the ribs.
void unite_scapulae(DistanceGrid& bones, const ChestFrame& chest);

/// Distance to one lung: `side` is -1 or +1. Lobes are parted by fissures of `fissure` width.
double lung_distance(const Vec3d& p, const ChestFrame& chest, int side, double fissure);

/// Joins the heart with its great vessels, solid; `size` is its half length, `top` where the upper cava ends.
void unite_heart(DistanceGrid& heart, const Vec3d& centre, double size, double top);

/// Distance to the nearest of the heart's four hollows.
double chamber_distance(const Vec3d& p, const Vec3d& centre, double size);

}  // namespace nacre
