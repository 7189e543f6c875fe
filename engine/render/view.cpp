// Nacre: the view of a frame. Matrices are computed in double precision, relative to the eye.
#include "engine/render/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <string>

namespace nacre {
namespace {

glm::dvec3 to_glm(const Vec3d& v) { return {v.x, v.y, v.z}; }

std::array<float, 3> floats(const Vec3d& v) { return {float(v.x), float(v.y), float(v.z)}; }

std::array<float, 16> floats(const glm::dmat4& m) {
  std::array<float, 16> out;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) out[std::size_t(4 * c + r)] = float(m[c][r]);
  return out;
}

std::array<float, 9> floats(const glm::dmat3& m) {
  std::array<float, 9> out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[std::size_t(3 * c + r)] = float(m[c][r]);
  return out;
}

}  // namespace

Vec3d flow_light(const Camera& camera) {
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  return normalized(right * 0.35 + up * 0.55 - camera.forward());
}

Vec3d mesh_light(const Camera& camera) {
  const Vec3d right = camera.right(), up = cross(right, camera.forward());
  return normalized(up * 0.55 - right * 0.45 - camera.forward());
}

Vec3d turned_light(const Vec3d& light, const Camera& camera, double azimuth, double height) {
  if (azimuth == 0 && height == 0) return light;
  constexpr double degree = std::numbers::pi / 180, straight = std::numbers::pi / 2;
  const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward);
  const double around = std::atan2(dot(light, right), -dot(light, forward)) + azimuth * degree;
  const double raised =
      std::clamp(std::asin(std::clamp(dot(light, up), -1.0, 1.0)) + height * degree, -straight, straight);
  return (right * std::sin(around) - forward * std::cos(around)) * std::cos(raised) + up * std::sin(raised);
}

glm::dmat4 View::clip_from_seen() const {
  const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward);
  const double distance = length(camera.target - camera.eye), half = 0.5 * camera.height;
  const double half_width = half * width / std::max(height, 1);
  // Rows: horizontal and vertical in half pictures at the target; then depth and w by kind of camera.
  const glm::dvec3 x = to_glm(right) / half_width, y = to_glm(up) / half, z = to_glm(forward);
  glm::dmat4 m(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    m[axis][0] = camera.orthographic ? x[axis] : x[axis] * distance;
    m[axis][1] = camera.orthographic ? y[axis] : y[axis] * distance;
    if (!camera.orthographic) m[axis][3] = z[axis];
  }
  if (camera.orthographic) {  // depth 1 far behind the eye, 0 as far in front of it
    const double reach = std::max(extent, 4 * (distance + camera.height));
    for (int axis = 0; axis < 3; ++axis) m[axis][2] = -0.5 * z[axis] / reach;
    m[3][2] = 0.5;
    m[3][3] = 1;
  } else {
    m[3][2] = 1e-4 * distance;  // whatever is nearer than this is not drawn
  }
  return m;
}

Placement place_grid(const Vec3d& origin, double size) {
  return glm::scale(glm::translate(glm::dmat4(1.0), to_glm(origin)), glm::dvec3(size));
}

static void set_clip_planes(const Program& program, const View& view) {
  const std::span<const ClipPlane> planes = view.clip.all();
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Vec3d n = normalized(planes[k].normal);
    const double offset = planes[k].offset / std::max(length(planes[k].normal), 1e-300);
    const std::array<float, 4> plane{float(n.x), float(n.y), float(n.z), float(dot(n, view.camera.eye) - offset)};
    program.set(("clip_planes[" + std::to_string(k) + "]").c_str(), plane);
  }
  program.set("clip_count", int(planes.size()));
}

void set_view(const Program& program, const View& view, const Placement& world_from_model) {
  const glm::dmat4 seen = glm::translate(glm::dmat4(1.0), -to_glm(view.camera.eye)) * world_from_model;
  program.set("seen_from_model", floats(seen));
  program.set("clip_from_model", floats(view.clip_from_seen() * seen));
  program.set("clip_from_seen", floats(view.clip_from_seen()));
  // Correct up to a factor, also for maps that shear. For a mirror image, the maker of the normals turns them back.
  program.set("normal_from_model", floats(glm::dmat3(glm::inverseTranspose(glm::dmat3(world_from_model)))));
  const Vec3d forward = view.camera.forward();
  program.set("ray_direction", std::array<float, 4>{float(forward.x), float(forward.y), float(forward.z),
                                                    view.camera.orthographic ? 1.0f : 0.0f});
  program.set("light", floats(view.light));
  program.set("ambient", view.ambient);
  program.set("picture_size", std::array<float, 2>{float(view.width), float(view.height)});
  set_clip_planes(program, view);
  program.set("backs", int(view.back_faces));
}

}  // namespace nacre
