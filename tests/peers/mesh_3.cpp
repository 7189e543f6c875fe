// Nacre: CGAL's Mesh_3 on a label image, as its examples run it, for run.sh.
//
// peer_mesh_3 LABELS OUT.off [vertices=N | size=VOXELS] [work=surface|cells] [threads=2] [distance=VOXELS]
// [error=SHARE]
//             [features=SURFACE.off] [parallel=1]
//
// vertices=N looks for the facet size that gives N vertices on the surfaces; the last run is the one that is told. The
// bound on edges is the facet size. `features` names a surface whose edges with more than two facets are protected as
// junction curves: this version of CGAL takes such curves, but does not find them in an image.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Image_3.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_3/initialize_triangulation_from_labeled_image.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/version.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <unordered_map>

#include "compute/meshing/quality.hpp"
#include "tests/peers/label_image.hpp"

namespace nacre {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;
using Polyline = std::vector<Kernel::Point_3>;

struct Settings {
  std::string labels, out, features, work = "surface";
  std::int64_t vertices = 0;
  double size = 1, distance = 0.5, error = 1e-3;
  int threads = 2;
  bool parallel = true;
};

constexpr int border = 2;  // voxels of outside around the image: its sides are surfaces like any other

/// The labels as CGAL's image, spacing 1, with a border.
CGAL::Image_3 make_image(const LabelImage& image) {
  const Int3 n = image.volume.dims + Int3(2 * border);
  _image* raw = _createImage(n.x, n.y, n.z, 1, 1, 1, 1, 1, WK_FIXED, SGN_UNSIGNED);
  auto* voxel = static_cast<unsigned char*>(raw->data);
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) *voxel++ = static_cast<unsigned char>(image.at(x - border, y - border, z - border));
  return CGAL::Image_3(raw);
}

/// Lines of edges that more than two triangles share, cut where not exactly two such edges meet.
std::vector<Polyline> junction_curves(const LabelImage& image, const Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> facets;
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) ++facets[std::minmax(t[k], t[(k + 1) % 3])];
  std::map<std::uint32_t, std::set<std::uint32_t>> next;
  for (const auto& [edge, count] : facets)
    if (count > 2) next[edge.first].insert(edge.second), next[edge.second].insert(edge.first);
  const auto position = [&](std::uint32_t v) {
    const Vec3d p = image.to_index(surface.points[v]) + Vec3d(border);
    return Kernel::Point_3(p.x, p.y, p.z);
  };
  std::set<std::uint32_t> ends;
  for (const auto& [v, others] : next)
    if (others.size() != 2) ends.insert(v);
  std::vector<Polyline> lines;
  const auto walk = [&](std::uint32_t from) {
    while (!next[from].empty()) {
      Polyline line{position(from)};
      for (std::uint32_t at = from;;) {
        const std::uint32_t to = *next[at].begin();
        next[at].erase(to);
        next[to].erase(at);
        line.push_back(position(to));
        at = to;
        if (ends.count(at) || at == from) break;
      }
      lines.push_back(line);
    }
  };
  for (const std::uint32_t v : ends) walk(v);
  for (const auto& one : next) walk(one.first);  // closed ones
  return lines;
}

/// A mesh in CGAL's structures, and what we take out of it.
template <class Tag>
class Mesher {
 public:
  using Triangulation = typename CGAL::Mesh_triangulation_3<Domain, CGAL::Default, Tag>::type;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, typename Domain::Corner_index,
                                                          typename Domain::Curve_index>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

  /// Facet angle 30 degrees, as in CGAL's examples; cells: radius over edge at most 3, then perturbed and exuded.
  void run(const CGAL::Image_3& image, const std::vector<Polyline>& curves, const Settings& s) {
    namespace p = CGAL::parameters;
    Domain domain = Domain::create_labeled_image_mesh_domain(image, p::relative_error_bound = s.error);
    if (!curves.empty()) domain.add_features(curves.begin(), curves.end());
    const bool cells = s.work == "cells";
    const Criteria criteria(p::edge_size = s.size, p::facet_angle = 30, p::facet_size = s.size,
                            p::facet_distance = s.distance, p::cell_radius_edge_ratio = cells ? 3 : 0);
    initialize_triangulation_from_labeled_image(complex_, domain, image, criteria, (unsigned char)0, !curves.empty());
    if (cells)
      CGAL::refine_mesh_3(complex_, domain, criteria);
    else
      CGAL::refine_mesh_3(complex_, domain, criteria, p::no_perturb(), p::no_exude());
  }

  void surface(const LabelImage& image, std::vector<Vec3d>& points, std::vector<Triangle>& triangles) const {
    std::unordered_map<const void*, std::uint32_t> number;
    for (auto f = complex_.facets_in_complex_begin(); f != complex_.facets_in_complex_end(); ++f) {
      std::uint32_t corner[3];
      for (int k = 0; k < 3; ++k) corner[k] = vertex(image, f->first->vertex((f->second + 1 + k) & 3), number, points);
      triangles.push_back({corner[0], corner[1], corner[2]});
    }
  }

  TetrahedralMesh cells(const LabelImage& image) const {
    TetrahedralMesh mesh;
    std::unordered_map<const void*, std::uint32_t> number;
    for (auto c = complex_.cells_in_complex_begin(); c != complex_.cells_in_complex_end(); ++c) {
      std::array<std::uint32_t, 4> corner;
      for (int k = 0; k < 4; ++k) corner[k] = vertex(image, c->vertex(k), number, mesh.points);
      mesh.cells.push_back(corner);
      mesh.material.push_back(std::uint16_t(c->subdomain_index()));
    }
    return mesh;
  }

 private:
  template <class Handle>
  static std::uint32_t vertex(const LabelImage& image, const Handle& v,
                              std::unordered_map<const void*, std::uint32_t>& number, std::vector<Vec3d>& points) {
    const auto [found, fresh] = number.try_emplace(&*v, std::uint32_t(points.size()));
    if (fresh) points.push_back(image.to_world(Vec3d(v->point().x(), v->point().y(), v->point().z()) - Vec3d(border)));
    return found->second;
  }

  Complex complex_;
};

template <class Tag>
void bench(Settings s) {
  const LabelImage labels(s.labels);
  const CGAL::Image_3 image = make_image(labels);
  std::vector<Polyline> curves;
  if (!s.features.empty()) curves = junction_curves(labels, open_surface({s.features}).load(0));
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  for (int attempt = 0;; ++attempt) {
    Mesher<Tag> mesher;
    points.clear(), triangles.clear();
    const double seconds = seconds_of([&] { mesher.run(image, curves, s); });
    mesher.surface(labels, points, triangles);
    const double off = s.vertices ? double(points.size()) / double(s.vertices) : 1;
    if (attempt < 8 && std::fabs(off - 1) > 0.01) {
      s.size *= std::sqrt(off);
      continue;
    }
    tell("seconds", seconds);
    tell("size", s.size);
    tell("vertices", double(points.size()));
    tell("curves", double(curves.size()));
    if (s.work == "cells") {
      const TetrahedralMesh cells = mesher.cells(labels);
      const CellQuality q = cell_quality(cells, labels.volume.materials());
      tell("cells", double(q.cells));
      tell("cell_vertices", double(cells.points.size()));
      tell("inverted", double(q.inverted));
      tell("dihedral_min", q.dihedral_min);
      tell("dihedral_max", q.dihedral_max);
      tell("share_within_10_160", q.share_within_10_160);
    }
    break;
  }
  write_off(s.out, points, triangles);
}

Settings parse(int count, char** words) {
  if (count < 3) throw Error("too few words", "", "give LABELS OUT.off [vertices=N ...]");
  Settings s;
  s.labels = words[1];
  s.out = words[2];
  for (int k = 3; k < count; ++k) {
    const std::string word = words[k];
    const std::size_t mark = std::min(word.find('='), word.size() - 1);
    const std::string key = word.substr(0, mark), value = word.substr(mark + 1);
    if (key == "vertices")
      s.vertices = std::stoll(value);
    else if (key == "size")
      s.size = std::stod(value);
    else if (key == "work")
      s.work = value;
    else if (key == "threads")
      s.threads = std::stoi(value);
    else if (key == "distance")
      s.distance = std::stod(value);
    else if (key == "error")
      s.error = std::stod(value);
    else if (key == "features")
      s.features = value;
    else if (key == "parallel")
      s.parallel = value != "0";
    else
      throw Error("no setting '" + key + "'", "", "see the head of tests/peers/mesh_3.cpp");
  }
  return s;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  const nacre::Settings settings = nacre::parse(argc, argv);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
  std::cout.setstate(std::ios_base::failbit);  // CGAL talks of its components there; results go through printf
  std::printf("version CGAL %s\n", CGAL_VERSION_STR);
  if (settings.parallel)
    nacre::bench<CGAL::Parallel_tag>(settings);
  else
    nacre::bench<CGAL::Sequential_tag>(settings);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "peer_mesh_3: %s\n", e.what());
  return 2;
}
