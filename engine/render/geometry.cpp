// Nacre: triangles as OpenGL draws them.
#include "engine/render/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

/// Assigns a vertex to each corner; makes a new one if no vertex of its point has its normal.
class VertexMaker {
 public:
  VertexMaker(SurfaceGeometry& geometry, std::span<const Vec3d> points)
      : g_(geometry), points_(points), newest_(points.size(), none) {}

  std::uint32_t vertex(std::uint32_t point, const Vec3f& normal, float sheet) {
    for (std::uint32_t v = newest_[point]; v != none; v = older_[v])
      if (g_.vertices[v].sheet == sheet && (dot(g_.vertices[v].normal, normal) > 1 - 1e-6f || normal == Vec3f{}))
        return v;
    const std::uint32_t made = std::uint32_t(g_.vertices.size());
    const Vec3f position((points_[point] - g_.origin) / g_.size);
    g_.vertices.push_back({position, normal, point, position, sheet});
    older_.push_back(newest_[point]);
    return newest_[point] = made;
  }

 private:
  SurfaceGeometry& g_;
  std::span<const Vec3d> points_;
  std::vector<std::uint32_t> newest_, older_;
};

void find_box(SurfaceGeometry& g, std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  Vec3d low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) low = min(low, points[t[k]]), high = max(high, points[t[k]]);
  if (triangles.empty()) low = high = {};
  const Vec3d extent = high - low;
  g.origin = low;
  g.size = std::max({extent.x, extent.y, extent.z, std::numeric_limits<double>::min()});
}

/// Edges by points, sorted: a key, and the triangle corner at which the edge begins.
void find_edges(SurfaceGeometry& g, std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  struct Edge {
    std::uint64_t key;
    std::uint32_t triangle, corner;
    bool operator<(const Edge& other) const { return key < other.key; }
  };
  std::vector<Edge> all;
  all.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = triangles[t][int(k)], b = triangles[t][int((k + 1) % 3)];
      all.push_back({std::min(a, b) << 32 | std::max(a, b), t, k});
    }
  std::sort(all.begin(), all.end());
  g.closed = !triangles.empty();
  double sum = 0;
  for (std::size_t i = 0, end; i < all.size(); i = end) {
    for (end = i + 1; end < all.size() && all[end].key == all[i].key;) ++end;
    const auto upwards = [&](const Edge& e) {  // consistent winding: one triangle runs up the edge, the other down
      return triangles[e.triangle][int(e.corner)] < triangles[e.triangle][int((e.corner + 1) % 3)];
    };
    g.closed = g.closed && end - i == 2 && upwards(all[i]) != upwards(all[i + 1]);
    const Triangle& t = g.triangles[all[i].triangle];
    const std::uint32_t a = t[int(all[i].corner)], b = t[int((all[i].corner + 1) % 3)];
    g.edges.push_back({a, b});
    sum += length(points[g.vertices[a].point] - points[g.vertices[b].point]);
  }
  g.mean_edge = g.edges.empty() ? 0 : sum / double(g.edges.size());
}

}  // namespace

SurfaceGeometry make_surface_geometry(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                      std::span<const Vec3f> corner_normals,
                                      std::span<const std::uint8_t> second_sheet) {
  SurfaceGeometry g;
  find_box(g, points, triangles);
  VertexMaker maker(g, points);
  g.triangles.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::uint32_t, 3> v;
    const bool second = !second_sheet.empty() && second_sheet[t] != 0;
    g.sheets = g.sheets || second;
    for (int k = 0; k < 3; ++k)
      v[std::size_t(k)] =
          maker.vertex(triangles[t][k], corner_normals.empty() ? Vec3f{} : corner_normals[3 * t + std::size_t(k)],
                       second ? 1.0f : 0.0f);
    g.triangles.push_back({v[0], v[1], v[2]});
  }
  find_edges(g, points, triangles);
  return g;
}

void set_embedded(SurfaceGeometry& geometry, std::span<const Vec3d> embedded) {
  for (SurfaceVertex& v : geometry.vertices) v.embedded = Vec3f((embedded[v.point] - geometry.origin) / geometry.size);
}

SurfaceBuffers::SurfaceBuffers(const SurfaceGeometry& g)
    : vertex_(Buffer::of<SurfaceVertex>(g.vertices)),
      triangle_(Buffer::of<Triangle>(g.triangles)),
      edge_(Buffer::of<std::array<std::uint32_t, 2>>(g.edges)),
      closed_(g.closed),
      sheets_(g.sheets),
      mean_edge_(g.mean_edge),
      origin_(g.origin),
      size_(g.size) {
  constexpr std::size_t most = std::numeric_limits<GLsizei>::max() / 3;
  if (g.triangles.size() > most || g.edges.size() > most)
    throw Error("too many triangles to draw", std::to_string(g.triangles.size()), "give a coarser surface");
  triangles_ = GLsizei(g.triangles.size());
  edges_ = GLsizei(g.edges.size());
  const auto make_array = [&](const Buffer& elements) {
    GLuint array = 0;
    glCreateVertexArrays(1, &array);
    glVertexArrayVertexBuffer(array, 0, vertex_.id(), 0, sizeof(SurfaceVertex));
    glVertexArrayElementBuffer(array, elements.id());
    glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(SurfaceVertex, position));
    glVertexArrayAttribFormat(array, 1, 3, GL_FLOAT, GL_FALSE, offsetof(SurfaceVertex, normal));
    glVertexArrayAttribIFormat(array, 2, 1, GL_UNSIGNED_INT, offsetof(SurfaceVertex, point));
    glVertexArrayAttribFormat(array, 3, 1, GL_FLOAT, GL_FALSE, offsetof(SurfaceVertex, sheet));
    glVertexArrayAttribFormat(array, 4, 3, GL_FLOAT, GL_FALSE, offsetof(SurfaceVertex, embedded));
    for (GLuint k = 0; k < 5; ++k) {
      glVertexArrayAttribBinding(array, k, 0);
      glEnableVertexArrayAttrib(array, k);
    }
    return array;
  };
  if (triangles_ == 0) return;
  triangle_array_ = make_array(triangle_);
  edge_array_ = make_array(edge_);
}

SurfaceBuffers::~SurfaceBuffers() {
  if (triangle_array_) glDeleteVertexArrays(1, &triangle_array_);
  if (edge_array_) glDeleteVertexArrays(1, &edge_array_);
}

SurfaceBuffers& SurfaceBuffers::operator=(SurfaceBuffers&& other) noexcept {
  std::swap(vertex_, other.vertex_);
  std::swap(triangle_, other.triangle_);
  std::swap(edge_, other.edge_);
  std::swap(triangle_array_, other.triangle_array_);
  std::swap(edge_array_, other.edge_array_);
  std::swap(triangles_, other.triangles_);
  std::swap(edges_, other.edges_);
  std::swap(closed_, other.closed_);
  std::swap(sheets_, other.sheets_);
  std::swap(mean_edge_, other.mean_edge_);
  std::swap(origin_, other.origin_);
  std::swap(size_, other.size_);
  return *this;
}

void SurfaceBuffers::set_edges(std::span<const std::array<std::uint32_t, 2>> edges) {
  if (edge_array_ == 0) return;
  edge_ = Buffer::of<std::array<std::uint32_t, 2>>(edges);
  edges_ = GLsizei(edges.size());
  glVertexArrayElementBuffer(edge_array_, edge_.id());
}

void SurfaceBuffers::draw_triangles() const {
  if (triangles_ == 0) return;
  glBindVertexArray(triangle_array_);
  glDrawElements(GL_TRIANGLES, 3 * triangles_, GL_UNSIGNED_INT, nullptr);
}

void SurfaceBuffers::draw_edges() const {
  if (edges_ == 0) return;
  glBindVertexArray(edge_array_);
  glDrawElements(GL_LINES, 2 * edges_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace nacre
