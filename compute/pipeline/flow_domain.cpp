// Nacre: the domain of a flow run, and the dry run over its triangles that estimates its memory.
#include "compute/pipeline/flow_domain.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "compute/device/among_all.hpp"
#include "compute/device/error.hpp"
#include "compute/flow/surface_diffusion.hpp"

namespace nacre {
namespace {

constexpr double least_pattern_cells = 5;  // from spot to spot: fewer blur the waves that should grow
constexpr double most_pattern_cells = 32;  // steps grow with the square, and 7 are enough
constexpr int max_bricks = 1024;           // per axis: 30 bits of Morton code
constexpr int max_octree_resolution = 1 << 20;

struct Bounds {
  Vec3d lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
};

enum class Sheets { all, first };

Bounds bounds_of(const FlowMesh& mesh, Sheets which = Sheets::all) {
  Bounds b;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (which == Sheets::first && !mesh.second_sheet.empty() && mesh.second_sheet[t]) continue;
    for (int k = 0; k < 3; ++k) {
      b.lower = min(b.lower, mesh.points[mesh.triangles[t][k]]);
      b.upper = max(b.upper, mesh.points[mesh.triangles[t][k]]);
    }
  }
  return b;
}

/// At most two digits after the point.
std::string number(double x) {
  std::string text = std::to_string(std::round(100 * x) / 100);
  text.resize(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

double largest(const Vec3d& v) { return std::max({v.x, v.y, v.z}); }

/// Edge of a texture cell on the grid, where the longest side is so long.
double texture_cell(const FlowMesh& mesh, const FlowParameters& parameters, double longest) {
  return mesh.cell_size > 0 ? mesh.cell_size : longest / parameters.resolution;
}

double grid_radius(const FlowParameters& parameters) {
  if (parameters.radius > 0) return parameters.radius;
  return parameters.texture == FlowTexture::streaks ? stencil_radius : diffusion_radius;
}

std::string gibibytes(double bytes) {
  const double g = bytes / (1 << 30);
  std::string text = std::to_string(g);
  return text.substr(0, text.find('.') + 2) + " GiB";
}

}  // namespace

void require_pattern(const FlowParameters& parameters) {
  if (parameters.texture == FlowTexture::streaks) return;
  const std::string name = parameters.texture == FlowTexture::spots ? "spots" : "stripes";
  if (parameters.method != EmbeddingKind::grid)
    throw Error("`texture` " + name + " needs the grid", "on an octree only streaks are drawn", "use `method` grid");
  if (parameters.radius > 0 && parameters.radius < diffusion_radius)
    throw Error("`radius` " + number(parameters.radius) + " is too small for " + name,
                "their stencils reach " + number(diffusion_radius) + " cells from the surface", "use that, or 0");
  const double cells = parameters.pattern_spacing / parameters.refine;
  if (!(cells >= least_pattern_cells))
    throw Error("`pattern_spacing` " + number(parameters.pattern_spacing) + " is too small",
                "the closest-point grid has one cell in " + std::to_string(parameters.refine) +
                    ", and a pattern needs " + number(least_pattern_cells) + " from spot to spot",
                "use " + number(least_pattern_cells * parameters.refine) + " or more, or a smaller `refine`");
  if (cells > most_pattern_cells)
    throw Error("`pattern_spacing` " + number(parameters.pattern_spacing) + " is too large",
                "at one grid cell in " + std::to_string(parameters.refine) + " its steps would be too short",
                "use " + number(most_pattern_cells * parameters.refine) + " or less, or a larger `refine`");
  if (!(parameters.pattern_stretch >= 1 && parameters.pattern_stretch <= most_stretch))
    throw Error("`pattern_stretch` " + number(parameters.pattern_stretch) + " is out of range",
                "diffusion beyond it would need more cells around than its stencil has, and be unstable",
                "use 1 to " + number(most_stretch));
}

FlowDomain make_domain(const FlowMesh& mesh, const FlowParameters& parameters) {
  if (mesh.triangles.empty()) throw Error("no triangles", "", "give a surface");
  // Second sheets that stand aside (separate_sheets) make the domain larger, and not its cells.
  const Bounds b = bounds_of(mesh), first = bounds_of(mesh, Sheets::first);
  const double longest = largest(first.upper - first.lower);
  if (!(longest > 0) || !std::isfinite(longest)) throw Error("the surface has no extent");
  FlowDomain domain;
  domain.cell_size = texture_cell(mesh, parameters, longest) * parameters.refine;
  domain.radius = grid_radius(parameters);
  domain.margin = int(std::ceil(domain.radius)) + 2;
  // The surface's lower corner lies off the cell faces: an axis-aligned wall on a face would touch two layers of cells.
  const double shift = domain.margin + 0.37;
  domain.origin = b.lower - Vec3d(shift * domain.cell_size);
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = (b.upper[axis] - b.lower[axis]) / domain.cell_size;
    domain.extent[axis] = std::max(1, int(std::ceil(cells - 1e-9)));
    domain.bricks[axis] =
        (int(std::ceil(cells + 0.37)) + 2 * domain.margin + parameters.subcells) / parameters.subcells;
    if (domain.bricks[axis] > max_bricks) {
      const int limit = (max_bricks - 1) * parameters.subcells - 2 * domain.margin - 2;
      throw Error("`resolution` " + std::to_string(parameters.resolution) + " is too fine",
                  "at most 1024 coarse cells per axis",
                  "use `resolution` " + std::to_string(limit * parameters.refine) + " or a larger `refine`");
    }
  }
  return domain;
}

double estimate_flow_bytes(const FlowMesh& mesh, const FlowParameters& parameters) {
  const Bounds b = bounds_of(mesh);
  const Vec3d size = b.upper - b.lower;
  const double h = texture_cell(mesh, parameters, std::max(largest(size), 1e-300)), H = h * parameters.refine;
  double area = 0, edges = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d ab = mesh.points[t.b] - mesh.points[t.a], ac = mesh.points[t.c] - mesh.points[t.a];
    area += 0.5 * length(cross(ab, ac));
    edges += length(ab) + length(ac);
  }
  const double triangles = double(mesh.triangles.size());
  const double radius = grid_radius(parameters);
  const double sheet = area / (H * H);  // surface in closest-point cells
  const double layers = 2 * radius + 1.6 * parameters.subcells;
  double dense = 1;
  for (int axis = 0; axis < 3; ++axis) dense *= size[axis] / H + 2 * radius + 8;
  const double cells = std::min(sheet * layers, dense);
  const double reach = 0.8661 + 2.3 / parameters.refine;
  const double texels = std::min(sheet * 2.4 * reach, dense) * std::pow(parameters.refine, 3);
  const double surface = std::min(1.6 * area / (h * h), texels);
  constexpr double slots = 2;
  // A pattern has lists and rows for about 10 and 7 layers of cells, and 13 weights for each cell for a while.
  const double pattern = parameters.texture == FlowTexture::streaks ? 0 : sheet * (10 * 4 + 7 * 108) + cells * 13 * 4;
  const double pairs = std::min(triangles, sheet * 2) * 60 / parameters.subcells + cells / 16 + edges / H;
  return dense / std::pow(parameters.subcells, 3) * 4 + cells * (16 + 4 + 4 + 4 + 32 + 16 * slots) + texels * (4 + 4) +
         surface * (4 + 16 + 4 + 24 + 32 + 8 * 3 + 4 * 5) + pairs * 24 + triangles * 220 + pattern + 64e6;
}

int make_octree_domain(const FlowMesh& mesh, const FlowParameters& parameters, FlowDomain& domain, Ranks* sharers) {
  if (sum_of_all(sharers, mesh.triangles.size()) == 0) throw Error("no triangles", "", "give a surface");
  Bounds b = bounds_of(mesh);
  extremes_of_all(sharers, {&b.lower.x, 3}, {&b.upper.x, 3});
  const double longest = largest(b.upper - b.lower);
  if (!(longest > 0) || !std::isfinite(longest)) throw Error("the surface has no extent");
  domain.radius = parameters.radius > 0 ? parameters.radius : octree_radius;
  if (domain.radius < 1) throw Error("`radius` is too small for an octree", "", "use 1 or more, or 0");
  domain.margin = int(std::ceil(domain.radius)) + 1;
  const double asked =
      mesh.cell_size > 0 ? std::ceil(longest / mesh.cell_size) + 2 * domain.margin + 1 : double(parameters.resolution);
  const int n = int(std::min(asked, 2.0 * max_octree_resolution));
  if (n > max_octree_resolution)
    throw Error("`resolution` " + std::to_string(n) + " is too fine", "at most 2^20 cells per axis",
                "use `resolution` " + std::to_string(max_octree_resolution) + " or less");
  const int inner = n - 2 * domain.margin - 1;
  if (inner < 1)
    throw Error("`resolution` " + std::to_string(n) + " is too coarse", "the band fills it",
                "use `resolution` " + std::to_string(2 * domain.margin + 16) + " or more");
  domain.cell_size = mesh.cell_size > 0 ? mesh.cell_size : longest / inner;
  domain.cells = Int3(n);
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = (b.upper[axis] - b.lower[axis]) / domain.cell_size;
    domain.extent[axis] = std::max(1, int(std::ceil(cells - 1e-9)));
    // In the middle of the cube, but off the cell faces: an axis-aligned wall on a face would touch two layers of
    // cells.
    const double corner = std::floor(0.5 * (n - cells)) + 0.37;
    domain.origin[axis] = b.lower[axis] - corner * domain.cell_size;
  }
  int levels = 0;
  while ((8 << levels) < n) ++levels;
  return levels;
}

MeshMeasure measure_mesh(const FlowMesh& mesh, Ranks* sharers) {
  MeshMeasure measure;
  ExactSum area, edges;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.points[t.a], b = mesh.points[t.b], c = mesh.points[t.c];
    area.add(0.5 * length(cross(b - a, c - a)));
    edges.add(length(b - a) + length(c - a));
    measure.lower = min(measure.lower, min(a, min(b, c)));
    measure.upper = max(measure.upper, max(a, max(b, c)));
  }
  extremes_of_all(sharers, {&measure.lower.x, 3}, {&measure.upper.x, 3});
  sum_of_all(sharers, area);
  sum_of_all(sharers, edges);
  measure.area = area.value();
  measure.edges = edges.value();
  measure.triangles = sum_of_all(sharers, mesh.triangles.size());
  return measure;
}

double estimate_octree_bytes(const FlowMesh& mesh, const FlowParameters& parameters) {
  return estimate_octree_bytes(measure_mesh(mesh), mesh, parameters);
}

double estimate_octree_bytes(const MeshMeasure& measure, const FlowMesh& mesh, const FlowParameters& parameters) {
  const double h = texture_cell(mesh, parameters, std::max(largest(measure.upper - measure.lower), 1e-300));
  const double radius = parameters.radius > 0 ? parameters.radius : octree_radius;
  const bool brick = parameters.octree == OctreeKind::brick;
  const double area = measure.area / (h * h);
  const double cells = area * 2 * radius + 4.2 * radius * radius * radius;  // at the end: around a speck
  const double surface = area * 1.5, edges = measure.edges / h, triangles = double(measure.triangles);
  const double ttl = parameters.ttl;
  const double bricks = std::min(surface / 40 + 8, cells / 8 + 8);
  const double lists = (edges / 8 + triangles * 2 + bricks * 2) * 4;
  const double seeds = brick ? surface : cells;
  const double structure =
      brick ? bricks * 340 + lists * 4 : cells * (8 + 5 + (parameters.neighbour_index ? 24 : 0) + 24);
  return cells * (12 + 4 * (brick ? 2 : ttl + 1)) + seeds * (8 * (brick ? 3 : ttl) + 16 + (brick ? 36 : 0)) +
         structure + triangles * 300 + 256e6;
}

namespace {
constexpr int least_resolution = 16;

/// Throws Error with the largest resolution that fits where `estimate` says that the memory will not do.
template <class Estimate>
void require(const FlowMesh& mesh, const FlowParameters& parameters, const Arena& arena, const Estimate& estimate) {
  const double needed = estimate(mesh, parameters);
  const std::size_t available = arena.room_bytes();
  if (needed <= double(available)) return;
  FlowParameters smaller = parameters;
  while (smaller.resolution > least_resolution && estimate(mesh, smaller) > double(available))
    smaller.resolution = std::max(least_resolution, smaller.resolution * 15 / 16);
  const bool fits = estimate(mesh, smaller) <= double(available);
  throw Error(
      "`resolution` " + std::to_string(parameters.resolution) + " needs about " + gibibytes(needed),
      gibibytes(double(available)) + " are free" + (fits ? "" : ", too few for these triangles at any resolution"),
      arena.device().too_small(fits ? "use `resolution` " + std::to_string(smaller.resolution)
                                    : "free some, use fewer triangles"));
}
}  // namespace

void require_memory(const FlowMesh& mesh, const FlowParameters& parameters, const Arena& arena) {
  require(mesh, parameters, arena, estimate_flow_bytes);
}

void require_octree_memory(const FlowMesh& mesh, const FlowParameters& parameters, const Arena& arena) {
  const MeshMeasure measure = measure_mesh(mesh);
  require(mesh, parameters, arena,
          [&](const FlowMesh& of, const FlowParameters& with) { return estimate_octree_bytes(measure, of, with); });
}

}  // namespace nacre
