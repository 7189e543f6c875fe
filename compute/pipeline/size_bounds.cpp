// Nacre: bounds on the size of triangles in materials and regions, from text.
#include "compute/pipeline/size_bounds.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "compute/device/error.hpp"
#include "compute/pipeline/volume_frame.hpp"

namespace nacre {
namespace {

constexpr double smallest_bound = 0.05, largest_bound = 1000;  // voxels, as those of `max_size`

[[noreturn]] void refuse(std::string_view part, const std::string& why) {
  throw Error("`sizes` cannot be read at '" + std::string(part) + "'", why,
              "write WHAT:SIZE, where WHAT is a label, a name, box x0 y0 z0 x1 y1 z1 or ball x y z radius");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// The numbers behind the first word.
std::vector<double> numbers_after(std::string_view word, std::string_view text, std::string_view part) {
  std::vector<double> numbers;
  for (text = trimmed(text.substr(word.size())); !text.empty();) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::optional<double> value = number_of(text.substr(0, end));
    if (!value) refuse(part, "'" + std::string(text.substr(0, end)) + "' is not a number");
    numbers.push_back(*value);
    text = trimmed(text.substr(end));
  }
  return numbers;
}

/// Maps the box or ball around `centre`, with these half axes along the world's, to the unit one around zero.
void map_to_unit(SizeBound& bound, const VolumeFrame& frame, const Vec3d& centre, const Vec3d& half) {
  const Vec3d zero = frame.to_world(Vec3d());
  const Vec3d axis[3] = {frame.to_world(Vec3d(1, 0, 0)) - zero, frame.to_world(Vec3d(0, 1, 0)) - zero,
                         frame.to_world(Vec3d(0, 0, 1)) - zero};
  const Vec3d centre_voxels = frame.to_voxels(centre);
  for (int k = 0; k < 3; ++k)
    bound.row[k] = Vec3f(Vec3d(axis[0][k], axis[1][k], axis[2][k]) / std::max(half[k], 1e-300));
  bound.centre = Vec3f(centre_voxels);
}

void read_region(SizeBound& bound, std::string_view what, std::string_view part, const VolumeFrame& frame) {
  if (bound.kind == SizeBound::Kind::box) {
    const std::vector<double> n = numbers_after("box", what, part);
    if (n.size() != 6) refuse(part, "a box has six numbers: the corner with the least x, y and z, and the other one");
    const Vec3d low(n[0], n[1], n[2]), high(n[3], n[4], n[5]);
    if (!(low.x < high.x && low.y < high.y && low.z < high.z)) refuse(part, "the box is empty");
    map_to_unit(bound, frame, (low + high) * 0.5, (high - low) * 0.5);
  } else {
    const std::vector<double> n = numbers_after("ball", what, part);
    if (n.size() != 4) refuse(part, "a ball has four numbers: its centre and its radius");
    if (!(n[3] > 0)) refuse(part, "the radius is not positive");
    map_to_unit(bound, frame, Vec3d(n[0], n[1], n[2]), Vec3d(n[3], n[3], n[3]));
  }
}

/// By name first: a material may be called 3.
std::uint32_t material_of(std::string_view what, std::string_view part, const MeshVolume& volume) {
  for (std::size_t m = 0; m < volume.names.size(); ++m)
    if (volume.names[m] == what) return std::uint32_t(m);
  std::string known;
  for (std::size_t m = 0; m < volume.labels.size(); ++m) {
    const std::string label = std::to_string(volume.labels[m]);
    if (label == what) return std::uint32_t(m);
    if (m < 20) known += (m ? ", " : "") + label;
  }
  refuse(part, "there is no material '" + std::string(what) + "'; the labels are " + known +
                   (volume.labels.size() > 20 ? ", ..." : ""));
}

SizeBound read_bound(std::string_view part, const MeshVolume& volume) {
  const std::size_t colon = part.rfind(':');
  if (colon == part.npos) refuse(part, "there is no colon before the size");
  const std::string_view what = trimmed(part.substr(0, colon));
  const std::optional<double> size = number_of(trimmed(part.substr(colon + 1)));
  if (!size || *size < smallest_bound || *size > largest_bound)
    refuse(part, "the size behind the colon is not a number from 0.05 to 1000");
  SizeBound bound;
  bound.size = float(*size);
  if (what.starts_with("box ") || what.starts_with("ball ")) {
    bound.kind = what.starts_with("box ") ? SizeBound::Kind::box : SizeBound::Kind::ball;
    read_region(bound, what, part, VolumeFrame(volume));
  } else {
    bound.material = material_of(what, part, volume);
  }
  return bound;
}

}  // namespace

std::vector<SizeBound> size_bounds(std::string_view text, const MeshVolume& volume) {
  std::vector<SizeBound> bounds;
  while (!trimmed(text).empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    bounds.push_back(read_bound(trimmed(text.substr(0, end)), volume));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return bounds;
}

}  // namespace nacre
