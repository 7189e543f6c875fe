// Nacre: slices along the axes of a volume, as they are looked at.
#include "app/viewer/mesh/ortho_slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

namespace nacre {
namespace {

constexpr std::array<std::array<float, 3>, 3> colours{{{0.85f, 0.22f, 0.2f}, {0.1f, 0.6f, 0.2f}, {0.2f, 0.4f, 0.95f}}};

/// "right" of "right-anterior-superior" for axis 0; empty: the file does not say.
std::string direction_of(const ViewedVolume& volume, int axis) {
  if (!volume.volumes || volume.volumes->empty()) return {};
  std::istringstream words(volume.volumes->front().space);
  std::string word;
  for (int k = 0; k <= axis; ++k)
    if (!std::getline(words, word, '-')) return {};
  constexpr const char* known[] = {"right", "left", "anterior", "posterior", "superior", "inferior"};
  return std::find(std::begin(known), std::end(known), word) != std::end(known) ? word : std::string();
}

/// 1: world axis k is held to the right, or up; -1: the other way round.
double hold(const ViewedVolume& volume, int axis, bool to_the_right) {
  const std::string way = direction_of(volume, axis);
  if (to_the_right) return way == "right" || way == "anterior" ? -1 : 1;
  return way == "posterior" || way == "inferior" ? -1 : 1;
}

std::string opposite(const std::string& way) {
  constexpr const char* pairs[][2] = {{"right", "left"}, {"anterior", "posterior"}, {"superior", "inferior"}};
  for (const auto& [a, b] : pairs) {
    if (way == a) return b;
    if (way == b) return a;
  }
  return {};
}

/// The name of what lies that way: of the world's axis that it runs most along.
std::string way_name(const ViewedVolume& volume, const Vec3d& way) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(way[a]) > std::fabs(way[axis])) axis = a;
  const std::string direction = direction_of(volume, axis);
  if (direction.empty()) return fmt::format("{}{}", way[axis] < 0 ? '-' : '+', "xyz"[axis]);
  return {char(std::toupper((way[axis] < 0 ? opposite(direction) : direction)[0]))};
}

}  // namespace

std::array<int, 3> volume_axes(const MeshInput& input) {
  std::array<int, 3> axes{0, 1, 2}, best = axes;
  double most = -1;
  do {
    double sum = 0;
    for (int world = 0; world < 3; ++world) sum += std::fabs(input.axes[std::size_t(axes[std::size_t(world)])][world]);
    if (sum > most + 1e-12) most = sum, best = axes;
  } while (std::next_permutation(axes.begin(), axes.end()));
  return best;
}

Int3 crosshair_voxel(const MeshInput& input, const Vec3d& shares) {
  Int3 voxel;
  for (int a = 0; a < 3; ++a) voxel[a] = std::clamp(int(std::floor(shares[a] * input.dims[a])), 0, input.dims[a] - 1);
  return voxel;
}

Vec3d crosshair_shares(const MeshInput& input, const Vec3d& voxel) {
  Vec3d shares;
  for (int a = 0; a < 3; ++a)
    shares[a] = (std::clamp(std::floor(voxel[a] + 0.5), 0.0, double(input.dims[a] - 1)) + 0.5) / input.dims[a];
  return shares;
}

Camera OrthoSlice::camera(double aspect) const {
  constexpr double margin = 1.12;  // for what is written beside it
  Camera camera;
  camera.orthographic = true;
  camera.target = plane.corner + (plane.across + plane.up) * 0.5;
  camera.up = up;
  camera.height = margin * std::max(height, width / aspect);
  camera.eye = camera.target - cross(up, right) * camera.height;
  return camera;
}

OrthoSlice ortho_slice(const ViewedVolume& volume, const Vec3d& shares, int k) {
  const MeshInput& input = volume.input;
  const std::array<int, 3> axes = volume_axes(input);
  const int right_world = k == 0 ? 1 : 0, up_world = k == 2 ? 1 : 2;
  OrthoSlice slice;
  slice.axis = axes[std::size_t(k)];
  slice.layer = crosshair_voxel(input, shares)[slice.axis];
  slice.plane = layer_plane(input, slice.axis, slice.layer);
  const auto held = [&](int world, bool to_the_right) {
    const Vec3d& axis = input.axes[std::size_t(axes[std::size_t(world)])];
    return axis * ((axis[world] < 0 ? -1.0 : 1.0) * hold(volume, world, to_the_right));
  };
  slice.right = held(right_world, true);
  slice.up = held(up_world, false);
  const auto extent = [&](int world) {
    const int a = axes[std::size_t(world)];
    return input.spacing[a] * input.dims[a];
  };
  slice.width = extent(right_world);
  slice.height = extent(up_world);
  return slice;
}

SliceCaption ortho_caption(const ViewedVolume& volume, const OrthoSlice& slice, int k) {
  const MeshInput& input = volume.input;
  Vec3d voxel;
  voxel[slice.axis] = slice.layer;
  const bool straight = std::fabs(input.axes[std::size_t(slice.axis)][k]) > 0.9999;
  SliceCaption caption;
  if (straight)
    caption.position =
        fmt::format("{} = {:.5g}{}, ", "xyz"[k], volume.to_world(voxel)[k], input.unit.empty() ? "" : " " + input.unit);
  caption.position += fmt::format("voxel {} of 0 to {}", slice.layer, input.dims[slice.axis] - 1);
  caption.left = way_name(volume, -slice.right);
  caption.right = way_name(volume, slice.right);
  caption.bottom = way_name(volume, -slice.up);
  caption.top = way_name(volume, slice.up);
  caption.colour = colours[std::size_t(k)];
  return caption;
}

}  // namespace nacre
