// Nacre: whether a mesh of materials is closed, manifold off the junctions, and turned the same way everywhere.
#include "compute/meshing/topology.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <span>

#include "compute/device/error.hpp"
#include "compute/math/disjoint_sets.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/meshing/vertex_fans.hpp"

namespace nacre {
namespace {

/// Whether three or more materials meet at one of the edges of a vertex that has these facets.
void check_mesh(const SurfaceMesh& mesh, int materials) {
  const char* what = "the mesh cannot be examined";
  if (mesh.materials.size() != mesh.triangles.size()) throw Error(what, "its triangles have no materials");
  for (const Triangle& t : mesh.triangles)
    if (std::max({t.a, t.b, t.c}) >= mesh.points.size())
      throw Error(what, "a triangle refers to a point that does not exist");
  for (const auto& [low, high] : mesh.materials)
    if (low >= high || high >= materials)
      throw Error(what, "the materials of a triangle are not two, ascending and known");
}

/// One examination: what its steps share.
class Examination {
 public:
  Examination(const SurfaceMesh& mesh, int materials)
      : mesh_(mesh),
        edges_(mesh.triangles, mesh.points.size()),
        vertices_(mesh.triangles, mesh.points.size()),
        on_junction_(mesh.points.size()),
        passes_(std::size_t(materials)),
        last_edge_(std::size_t(materials), edges_.size()) {
    report_.materials.resize(std::size_t(materials));
    report_.triangles = std::int64_t(mesh.triangles.size());
    report_.edges = std::int64_t(edges_.size());
    for (MaterialTopology& m : report_.materials) m.closed = true;
  }

  TopologyReport run() {
    count_triangles();
    for (std::size_t edge = 0; edge < edges_.size(); ++edge) count_edge(edge);
    number_corners();
    count_vertices();
    count_components();
    for (MaterialTopology& m : report_.materials) {
      m.euler = m.vertices - m.edges + m.facets;
      m.closed = m.closed && m.facets > 0;
    }
    return std::move(report_);
  }

 private:
  const MaterialPair& materials_of(std::uint32_t use) const { return mesh_.materials[use / 3]; }

  void count_triangles() {
    const Vec3d centre = mesh_.points.empty() ? Vec3d() : mesh_.points[0];  // keeps the volumes' rounding small
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      const Vec3d a = mesh_.points[t.a] - centre, b = mesh_.points[t.b] - centre, c = mesh_.points[t.c] - centre;
      report_.degenerate_triangles += cross(b - a, c - a) == Vec3d();
      const double volume = dot(a, cross(b, c)) / 6;
      for (int side = 0; side < 2; ++side) {
        MaterialTopology& m = report_.materials[mesh_.materials[i][side]];
        ++m.facets;
        m.volume += side == 1 ? volume : -volume;
      }
      report_.duplicate_triangles += is_duplicate(i);
    }
  }

  /// Whether an earlier triangle at its smallest corner has the same corners.
  bool is_duplicate(std::size_t triangle) const {
    const auto corners = [&](std::size_t i) {
      std::array<std::uint32_t, 3> c = {mesh_.triangles[i].a, mesh_.triangles[i].b, mesh_.triangles[i].c};
      std::sort(c.begin(), c.end());
      return c;
    };
    const auto mine = corners(triangle);
    for (const std::uint32_t corner : vertices_.corners(mine[0])) {
      if (corner / 3 >= triangle) return false;
      if (corners(corner / 3) == mine) return true;
    }
    return false;
  }

  void count_edge(std::size_t edge) {
    const auto uses = edges_.uses(edge);
    const auto& counts = counter_.facets(uses, [&](std::uint32_t use) { return materials_of(use); });
    bool odd = false, pinched = false;
    for (const auto& [material, facets] : counts) {
      ++report_.materials[material].edges;
      odd = odd || facets % 2 != 0;
      pinched = pinched || facets > 2;
    }
    const bool junction = counts.size() > 2;
    if (uses.size() == 1)
      ++report_.boundary_edges;
    else if (odd || (pinched && !junction))
      ++report_.nonmanifold_edges;
    else if (junction && pinched)
      ++report_.pinched_edges;
    if (junction) {
      ++report_.junction_edges;
      on_junction_[edges_.a(edge)] = on_junction_[edges_.b(edge)] = true;
    }
    count_passes(edge);
  }

  /// Each material's surface must pass the edge as often one way as the other.
  void count_passes(std::size_t edge) {
    const auto pass = [&](std::uint16_t material, int sign) {
      if (last_edge_[material] != edge) passes_[material] = 0;
      last_edge_[material] = edge;
      passes_[material] += sign;
    };
    for (const std::uint32_t use : edges_.uses(edge)) {
      const int sign = mesh_.triangles[use / 3][int(use % 3)] == edges_.a(edge) ? 1 : -1;
      pass(materials_of(use)[0], -sign);
      pass(materials_of(use)[1], sign);
    }
    bool consistent = true;
    for (const std::uint32_t use : edges_.uses(edge))
      for (const std::uint16_t m : materials_of(use))
        if (passes_[m] != 0) consistent = report_.materials[m].closed = false;
    report_.inconsistent_edges += !consistent;
  }

  /// Numbers the pairs (vertex, material of a facet there): the vertices of the materials' own surfaces.
  void number_corners() {
    first_.push_back(0);
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      for (const auto& c : counter_.facets(vertices_.corners(v), [&](std::uint32_t use) { return materials_of(use); }))
        material_of_.push_back(c.material);
      first_.push_back(material_of_.size());
    }
  }

  std::uint32_t number_of(std::uint32_t vertex, std::uint16_t material) const {
    const auto begin = material_of_.begin() + std::ptrdiff_t(first_[vertex]);
    const auto end = material_of_.begin() + std::ptrdiff_t(first_[vertex + 1]);
    return std::uint32_t(std::lower_bound(begin, end, material) - material_of_.begin());
  }

  void count_vertices() {
    std::vector<VertexFanCounter::Facet> facets;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      facets.clear();
      for (const std::uint32_t corner : vertices_.corners(v)) {
        const Triangle& t = mesh_.triangles[corner / 3];
        const int k = int(corner % 3);
        facets.push_back({t[(k + 1) % 3], t[(k + 2) % 3], materials_of(corner)});
      }
      ++(facets.empty() ? report_.unused_points : report_.vertices);
      bool pinched = false;
      for (const auto& [material, vertex_fans] : counter_.vertex_fans(facets)) {
        ++report_.materials[material].vertices;
        pinched = pinched || vertex_fans > 1;
      }
      if (pinched) ++(on_junction_[v] ? report_.pinched_vertices : report_.nonmanifold_vertices);
    }
  }

  void count_components() {
    DisjointSets whole(mesh_.points.size()), own(material_of_.size());
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Triangle& t = mesh_.triangles[i];
      for (const std::uint32_t corner : {t.b, t.c}) {
        whole.join(t.a, corner);
        for (const std::uint16_t m : mesh_.materials[i]) own.join(number_of(t.a, m), number_of(corner, m));
      }
    }
    for (std::size_t v = 0; v < mesh_.points.size(); ++v)
      report_.components += first_[v] < first_[v + 1] && whole.find(std::uint32_t(v)) == v;
    for (std::size_t i = 0; i < material_of_.size(); ++i)
      report_.materials[material_of_[i]].components += own.find(std::uint32_t(i)) == i;
  }

  const SurfaceMesh& mesh_;
  EdgeTable edges_;
  VertexTable vertices_;
  VertexFanCounter counter_;
  std::vector<char> on_junction_;
  std::vector<int> passes_;  // per material, at the edge in last_edge_
  std::vector<std::size_t> last_edge_;
  std::vector<std::size_t> first_;          // per vertex: its first number
  std::vector<std::uint16_t> material_of_;  // per number, ascending at each vertex
  TopologyReport report_;
};

}  // namespace

TopologyReport check_topology(const SurfaceMesh& mesh, int materials) {
  check_mesh(mesh, materials);
  return Examination(mesh, materials).run();
}

std::vector<std::uint32_t> pinched_points(const SurfaceMesh& mesh) {
  const VertexTable table(mesh.triangles, mesh.points.size());
  std::vector<std::uint8_t> pinched(mesh.points.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pinched.size(), 1024), [&](const auto& range) {
    VertexFanCounter counter;
    std::vector<VertexFanCounter::Facet> facets;
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      facets.clear();
      for (const std::uint32_t corner : table.corners(v)) {
        const Triangle& t = mesh.triangles[corner / 3];
        const int k = int(corner % 3);
        facets.push_back({t[(k + 1) % 3], t[(k + 2) % 3], mesh.materials[corner / 3]});
      }
      pinched[v] = counter.is_pinched(facets);
    }
  });
  return marked(pinched);
}

}  // namespace nacre
