// Nacre: triangles as OpenGL draws them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "engine/gl/buffer.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// One vertex, shared by corners that have the same point and normal.
struct SurfaceVertex {
  Vec3f position;  ///< model coordinates, 0..1 along the longest side of the bounding box
  Vec3f normal;
  std::uint32_t point;  ///< of the mesh
  Vec3f embedded{};     ///< where the point is in the shape that is embedded, in the same coordinates
  float sheet = 0;      ///< 1 in a second sheet, which lies where another does
};

/// Triangles prepared on the host, on any thread.
struct SurfaceGeometry {
  std::vector<SurfaceVertex> vertices;
  std::vector<Triangle> triangles;                  ///< of vertices
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< each once, of vertices
  bool sheets = false;                              ///< some are second sheets
  bool closed = false;                              ///< every edge has two triangles: backs are never seen
  double mean_edge = 0;                             ///< world units
  Vec3d origin{};                                   ///< world = origin + model * size
  double size = 1;
};

/// `corner_normals`: three per triangle, or none (for flat shading). `second_sheet`: one per triangle, or none.
SurfaceGeometry make_surface_geometry(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                      std::span<const Vec3f> corner_normals,
                                      std::span<const std::uint8_t> second_sheet = {});

/// The vertices of a surface that has moved find their texture where `embedded` has their points.
void set_embedded(SurfaceGeometry& geometry, std::span<const Vec3d> embedded);

/// The same on the graphics device; immutable. Several passes draw from it.
class SurfaceBuffers {
 public:
  SurfaceBuffers() = default;
  explicit SurfaceBuffers(const SurfaceGeometry& geometry);
  ~SurfaceBuffers();
  SurfaceBuffers(SurfaceBuffers&& other) noexcept { *this = static_cast<SurfaceBuffers&&>(other); }
  SurfaceBuffers& operator=(SurfaceBuffers&& other) noexcept;

  /// From now on draws other edges of the same vertices: those of a part of the triangles.
  void set_edges(std::span<const std::array<std::uint32_t, 2>> edges);

  void draw_triangles() const;
  void draw_edges() const;

  bool closed() const { return closed_; }
  bool sheets() const { return sheets_; }
  double mean_edge() const { return mean_edge_; }
  const Vec3d& origin() const { return origin_; }
  double size() const { return size_; }
  Placement placement() const { return place_grid(origin_, size_); }
  explicit operator bool() const { return triangles_ > 0; }

 private:
  Buffer vertex_, triangle_, edge_;
  GLuint triangle_array_ = 0, edge_array_ = 0;
  GLsizei triangles_ = 0, edges_ = 0;
  bool closed_ = false, sheets_ = false;
  double mean_edge_ = 0;
  Vec3d origin_{};
  double size_ = 1;
};

}  // namespace nacre
