// Nacre: measures a surface mesh of a label image by our quality code and by distances that favour no mesher.
//
// peer_measure LABELS SURFACE.off [RADIUS,RADIUS,.. X Y Z]
//
// Distances, in voxels, of vertices and facet centres: from the stairs, the faces between voxels of different labels;
// and, where the phantom has exact spheres around a point of the world, from the nearest sphere.
#include <algorithm>
#include <sstream>

#include "compute/meshing/quality.hpp"
#include "tests/peers/label_image.hpp"

namespace nacre {
namespace {

/// Distance to the square of side 1 in the plane across `axis` around `centre`.
double distance_to_face(const Vec3d& p, const Vec3d& centre, int axis) {
  Vec3d d = p - centre;
  for (int k = 0; k < 3; ++k)
    if (k != axis) d[k] = std::max(0.0, std::fabs(d[k]) - 0.5);
  return length(d);
}

/// Distance of a point in index coordinates to the nearest face between two labels; `reach` where there is none nearer.
double distance_to_staircase(const LabelImage& image, const Vec3d& p, int reach) {
  double nearest = reach;
  const Int3 middle(int(std::floor(p.x + 0.5)), int(std::floor(p.y + 0.5)), int(std::floor(p.z + 0.5)));
  for (int z = middle.z - reach - 1; z <= middle.z + reach; ++z)
    for (int y = middle.y - reach - 1; y <= middle.y + reach; ++y)
      for (int x = middle.x - reach - 1; x <= middle.x + reach; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          const int own = image.at(x, y, z), next = image.at(x + (axis == 0), y + (axis == 1), z + (axis == 2));
          if (own == next) continue;
          Vec3d centre(x, y, z);
          centre[axis] += 0.5;
          nearest = std::min(nearest, distance_to_face(p, centre, axis));
        }
  return nearest;
}

struct Spheres {
  std::vector<double> radii;
  Vec3d centre;

  double distance(const Vec3d& p) const {
    double nearest = 1e300;
    for (const double r : radii) nearest = std::min(nearest, std::fabs(length(p - centre) - r));
    return nearest;
  }
};

/// Mean and largest of a distance over vertices and over facet centres.
template <class Distance>
void tell_distances(const std::string& name, const std::vector<Vec3d>& vertices, const std::vector<Vec3d>& centres,
                    const Distance& distance) {
  for (const auto& [what, points] : {std::pair("vertex", &vertices), std::pair("facet", &centres)}) {
    double sum = 0, largest = 0;
    for (const Vec3d& p : *points) {
      const double d = distance(p);
      sum += d;
      largest = std::max(largest, d);
    }
    tell((name + "_" + what + "_mean").c_str(), sum / double(std::max<std::size_t>(1, points->size())));
    tell((name + "_" + what + "_max").c_str(), largest);
  }
}

Spheres parse_spheres(char** words) {
  Spheres s;
  std::istringstream list(words[0]);
  for (std::string item; std::getline(list, item, ',');) s.radii.push_back(std::stod(item));
  s.centre = {std::stod(words[1]), std::stod(words[2]), std::stod(words[3])};
  return s;
}

void run(int count, char** words) {
  if (count != 3 && count != 7)
    throw Error("peer_measure got " + std::to_string(count - 1) + " words", "",
                "give LABELS SURFACE.off [RADIUS,.. X Y Z]");
  const LabelImage image(words[1]);
  const Surface surface = open_surface({words[2]}).load(0);
  SurfaceMesh mesh;
  mesh.points = surface.points;
  mesh.triangles = surface.triangles;
  mesh.materials.assign(mesh.triangles.size(), {0, 1});

  std::vector<char> used(mesh.points.size(), 0);
  std::vector<Vec3d> vertices, centres;
  for (const Triangle& t : mesh.triangles) {
    centres.push_back((mesh.points[t.a] + mesh.points[t.b] + mesh.points[t.c]) / 3.0);
    used[t.a] = used[t.b] = used[t.c] = 1;
  }
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) vertices.push_back(mesh.points[v]);

  const TriangleQuality q = surface_quality(mesh).all;
  tell("vertices", double(vertices.size()));
  tell("triangles", double(q.triangles));
  tell("radius_ratio_mean", q.radius_ratio_mean);
  tell("radius_ratio_min", q.radius_ratio_min);
  tell("angle_min", q.angle_min);
  tell("angle_max", q.angle_max);
  tell("share_under_25", q.share_under_25);
  tell_distances("stairs", vertices, centres,
                 [&](const Vec3d& p) { return distance_to_staircase(image, image.to_index(p), 2); });
  if (count < 7) return;
  const Spheres spheres = parse_spheres(words + 3);
  tell_distances("sphere", vertices, centres,
                 [&](const Vec3d& p) { return spheres.distance(p) / image.volume.spacing.x; });
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  nacre::run(argc, argv);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "peer_measure: %s\n", e.what());
  return 2;
}
