// Nacre: a part of a surface, cut along planes.
#include "engine/scene/surface/surface_part.hpp"

#include <utility>

#include "compute/embedding/triangle.hpp"

namespace nacre {
namespace {

/// A corner of a cut triangle, by its weights at the triangle's corners.
struct CutCorner {
  Vec3d weights, position;
};

/// `polygon` inside of a half space.
std::vector<CutCorner> cut(const std::vector<CutCorner>& polygon, const HalfSpace& inside) {
  std::vector<CutCorner> kept;
  const auto beyond = [&](const CutCorner& c) { return dot(inside.normal, c.position) - inside.offset; };
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const CutCorner &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double da = beyond(a), db = beyond(b);
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      const double share = da / (da - db);
      kept.push_back({a.weights + (b.weights - a.weights) * share, a.position + (b.position - a.position) * share});
    }
  }
  return kept;
}

class Cutter {
 public:
  Cutter(const PreparedSurface& whole, std::span<const HalfSpace> inside)
      : whole_(whole), inside_(inside), number_(whole.points.size(), none) {}

  SurfacePart run() {
    for (std::uint32_t t = 0; t < whole_.triangles.size(); ++t) add(t);
    return std::move(part_);
  }

 private:
  enum class Side { in, out, across };

  Side side_of(const Corners& c) const {
    bool across = false;
    for (const HalfSpace& half : inside_) {
      const double a = dot(half.normal, c.a) - half.offset, b = dot(half.normal, c.b) - half.offset;
      const double d = dot(half.normal, c.c) - half.offset;
      if (a > 0 && b > 0 && d > 0) return Side::out;
      across = across || a > 0 || b > 0 || d > 0;
    }
    return across ? Side::across : Side::in;
  }

  void add(std::uint32_t t) {
    const Triangle& corners = whole_.triangles[t];
    const Corners at{whole_.points[corners.a], whole_.points[corners.b], whole_.points[corners.c]};
    const Side side = side_of(at);
    if (side == Side::in) {
      part_.surface.triangles.push_back({point(corners.a), point(corners.b), point(corners.c)});
      for (int k = 0; k < 3; ++k) part_.surface.corner_normals.push_back(whole_.corner_normals[3 * t + k]);
      keep_sheet(t);
      ++part_.whole_triangles;
    }
    if (side != Side::across) return;
    std::vector<CutCorner> polygon{{{1, 0, 0}, at.a}, {{0, 1, 0}, at.b}, {{0, 0, 1}, at.c}};
    for (const HalfSpace& half : inside_) polygon = cut(polygon, half);
    for (std::size_t k = 2; k < polygon.size(); ++k) add_cut(t, polygon[0], polygon[k - 1], polygon[k]);
  }

  void add_cut(std::uint32_t t, const CutCorner& a, const CutCorner& b, const CutCorner& c) {
    const double area = length(cross(b.position - a.position, c.position - a.position));
    if (!(area > 0)) return;
    Triangle triangle;
    for (const auto& [corner, number] : {std::pair{&a, &triangle.a}, {&b, &triangle.b}, {&c, &triangle.c}}) {
      *number = std::uint32_t(part_.surface.points.size());
      part_.surface.points.push_back(corner->position);
      part_.origin.push_back({whole_.triangles[t], Vec3f(corner->weights)});
      const Vec3f* normal = whole_.corner_normals.data() + 3 * std::size_t(t);
      const Vec3f w(corner->weights);
      part_.surface.corner_normals.push_back(normalized(normal[0] * w.x + normal[1] * w.y + normal[2] * w.z));
    }
    part_.surface.triangles.push_back(triangle);
    keep_sheet(t);
    ++part_.cut_triangles;
  }

  void keep_sheet(std::uint32_t t) {
    if (!whole_.second_sheet.empty()) part_.surface.second_sheet.push_back(whole_.second_sheet[t]);
  }

  /// Number of a point of the whole in the part.
  std::uint32_t point(std::uint32_t p) {
    if (number_[p] == none) {
      number_[p] = std::uint32_t(part_.surface.points.size());
      part_.surface.points.push_back(whole_.points[p]);
      part_.origin.push_back({{p, p, p}, {1, 0, 0}});
    }
    return number_[p];
  }

  const PreparedSurface& whole_;
  std::span<const HalfSpace> inside_;
  std::vector<std::uint32_t> number_;
  SurfacePart part_;
};

}  // namespace

void SurfacePart::take(std::span<const Vec3f> whole, std::span<Vec3f> part) const {
  for (std::size_t i = 0; i < origin.size(); ++i) {
    const auto& [p, w] = origin[i];
    part[i] = p.a == p.b ? whole[p.a] : whole[p.a] * w.x + whole[p.b] * w.y + whole[p.c] * w.z;
  }
}

std::vector<float> SurfacePart::take(std::span<const float> whole) const {
  std::vector<float> part(origin.size());
  for (std::size_t i = 0; i < origin.size(); ++i) {
    const auto& [p, w] = origin[i];
    part[i] = p.a == p.b ? whole[p.a] : whole[p.a] * w.x + whole[p.b] * w.y + whole[p.c] * w.z;
  }
  return part;
}

std::vector<std::array<float, 4>> SurfacePart::take(std::span<const std::array<float, 4>> whole) const {
  std::vector<std::array<float, 4>> part(origin.size());
  for (std::size_t i = 0; i < origin.size(); ++i) {
    const auto& [p, w] = origin[i];
    for (std::size_t k = 0; k < 4; ++k) part[i][k] = whole[p.a][k] * w.x + whole[p.b][k] * w.y + whole[p.c][k] * w.z;
  }
  return part;
}

SurfacePart cut_surface(const PreparedSurface& whole, std::span<const HalfSpace> inside) {
  return Cutter(whole, inside).run();
}

}  // namespace nacre
