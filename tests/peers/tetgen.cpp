// Nacre: TetGen fills a closed surface mesh, such as one of ours, for run.sh.
//
// peer_tetgen SURFACE.off [SWITCHES=pYAQ]
//
// p: a surface; Y: its triangles stay as they are, as ours do; A: regions are told apart; Q: quiet. Add q for better
// cells. Reading is not in the seconds. Every region within the outermost surface is filled: holes that are the
// outside's count as cells, too.
#define TETLIBRARY  // the header declares the function on strings for libraries only
#include <tetgen.h>

#include "compute/meshing/quality.hpp"
#include "tests/peers/label_image.hpp"

namespace nacre {
namespace {

void fill_input(const Surface& s, tetgenio& in) {
  in.numberofpoints = int(s.points.size());
  in.pointlist = new REAL[s.points.size() * 3];
  for (std::size_t v = 0; v < s.points.size(); ++v)
    for (int k = 0; k < 3; ++k) in.pointlist[3 * v + k] = s.points[v][k];
  in.numberoffacets = int(s.triangles.size());
  in.facetlist = new tetgenio::facet[s.triangles.size()];
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    tetgenio::facet& f = in.facetlist[t];
    tetgenio::init(&f);
    f.numberofpolygons = 1;
    f.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(f.polygonlist);
    f.polygonlist->numberofvertices = 3;
    f.polygonlist->vertexlist = new int[3]{int(s.triangles[t].a), int(s.triangles[t].b), int(s.triangles[t].c)};
  }
}

/// All cells as one material.
TetrahedralMesh take_cells(const tetgenio& out) {
  TetrahedralMesh mesh;
  for (int v = 0; v < out.numberofpoints; ++v)
    mesh.points.push_back({out.pointlist[3 * v], out.pointlist[3 * v + 1], out.pointlist[3 * v + 2]});
  for (int c = 0; c < out.numberoftetrahedra; ++c) {
    const int* corner = out.tetrahedronlist + c * std::ptrdiff_t(out.numberofcorners);
    mesh.cells.push_back(
        {std::uint32_t(corner[0]), std::uint32_t(corner[1]), std::uint32_t(corner[2]), std::uint32_t(corner[3])});
  }
  mesh.material.assign(mesh.cells.size(), 1);
  return mesh;
}

void run(int count, char** words) {
  if (count < 2) throw Error("no surface", "", "give SURFACE.off [SWITCHES]");
  const Surface surface = open_surface({words[1]}).load(0);
  std::string switches = count > 2 ? words[2] : "pYAQ";
  tetgenio in, out;
  fill_input(surface, in);
  const double seconds = seconds_of([&] { tetrahedralize(switches.data(), &in, &out); });
  const TetrahedralMesh mesh = take_cells(out);
  const CellQuality q = cell_quality(mesh, 2);
  std::printf("version TetGen 1.5 (-%s)\n", switches.c_str());
  tell("seconds", seconds);
  tell("cells", double(q.cells));
  tell("cell_vertices", double(mesh.points.size()));
  tell("inverted", double(q.inverted));
  tell("dihedral_min", q.dihedral_min);
  tell("dihedral_max", q.dihedral_max);
  tell("share_within_10_160", q.share_within_10_160);
  tell("volume", q.volume.at(1));
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) try {
  nacre::run(argc, argv);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "peer_tetgen: %s\n", e.what());
  return 2;
} catch (int code) {  // TetGen throws numbers
  std::fprintf(stderr, "peer_tetgen: TetGen gave up with code %d\n", code);
  return 2;
}
