// Nacre: a volume that is being meshed, as the viewer shows it.
#include "app/viewer/mesh/viewed_volume.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "compute/pipeline/volume_frame.hpp"

namespace nacre {
namespace {

constexpr Color outside_colour{0.93f, 0.93f, 0.94f};
constexpr double most_pixels = 1024;  ///< along a slice in any direction

void put(Image& image, std::size_t pixel, const Color& colour) {
  for (std::size_t k = 0; k < 3; ++k) image.pixels[4 * pixel + k] = std::uint8_t(std::lround(255 * colour[k]));
}

const Color& material_pixel(std::span<const Color> palette, std::size_t material) {
  return material == 0 || material >= palette.size() ? outside_colour : palette[material];
}

const Color& mapped(const Colormap& map, double value, double low, double high) {
  const double share = high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.5;
  return map.table[std::size_t(std::lround(share * double(map.table.size() - 1)))];
}

}  // namespace

ValueSpread spread_of(const Volume& volume) {
  constexpr std::size_t bins = 8192;  // a CT's values are whole, and some thousands
  constexpr double beyond = 0.005;    // on either side
  const VolumeStatistics statistics = volume_statistics(volume);
  ValueSpread spread;
  spread.min = spread.low = statistics.min;
  spread.max = spread.high = statistics.max;
  const double range = spread.max - spread.min;
  if (!(range > 0)) return spread;
  std::vector<std::size_t> count(bins, 0);
  std::size_t total = 0;
  std::visit(
      [&](const auto& values) {
        for (const auto v : values) {
          if (!std::isfinite(double(v))) continue;
          ++count[std::min(bins - 1, std::size_t((double(v) - spread.min) / range * bins))], ++total;
        }
      },
      volume.values);
  const auto bin_below = [&](double share) {
    std::size_t sum = 0, bin = 0;
    while (bin + 1 < bins && double(sum + count[bin]) <= share * double(total)) sum += count[bin++];
    return bin;
  };
  const std::size_t first = bin_below(beyond), last = bin_below(1 - beyond);
  if (last > first) {
    spread.low = spread.min + range * double(first) / bins;
    spread.high = spread.min + range * double(last + 1) / bins;
  }
  std::array<double, std::tuple_size_v<decltype(spread.histogram)>> voxels{};
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const double value = spread.min + range * (double(bin) + 0.5) / bins;
    const double share = (value - spread.low) / (spread.high - spread.low);
    if (share >= 0 && share < 1) voxels[std::size_t(share * double(voxels.size()))] += double(count[bin]);
  }
  for (std::size_t k = 0; k < voxels.size(); ++k) spread.histogram[k] = float(std::sqrt(voxels[k]));
  return spread;
}

Vec3d ViewedVolume::to_world(const Vec3d& voxel) const {
  return index_to_world(voxel, input.origin, input.spacing, input.axes);
}

Vec3d ViewedVolume::to_voxels(const Vec3d& world) const {
  return world_to_index(world, input.origin, input.spacing, input.axes);
}

std::optional<std::size_t> ViewedVolume::index_of(const Vec3d& p) const {
  std::size_t index = 0;
  for (int a = 2; a >= 0; --a) {
    const double nearest = std::floor(p[a] + 0.5);
    if (!(nearest >= 0 && nearest < input.dims[a])) return {};
    index = index * std::size_t(input.dims[a]) + std::size_t(nearest);
  }
  return index;
}

double ViewedVolume::value(std::size_t index, std::size_t file) const {
  return std::visit([&](const auto& values) { return double(values[index]); }, (*volumes)[file].values);
}

std::vector<Vec3d> ViewedVolume::corners() const {
  Vec3d low(input.dims), high(0);
  std::size_t index = 0;
  for (int z = 0; z < input.dims.z; ++z)
    for (int y = 0; y < input.dims.y; ++y)
      for (int x = 0; x < input.dims.x; ++x) {
        if (material[index++] == 0) continue;
        low = min(low, Vec3d(x, y, z));
        high = max(high, Vec3d(x + 1, y + 1, z + 1));
      }
  return corners_of(low, high);
}

std::vector<Vec3d> ViewedVolume::box() const { return corners_of(Vec3d(0), Vec3d(input.dims)); }

/// Of the voxels from `low` to before `high`.
std::vector<Vec3d> ViewedVolume::corners_of(const Vec3d& low, const Vec3d& high) const {
  std::vector<Vec3d> corner;
  for (int k = 0; k < 8; ++k)
    corner.push_back(
        to_world({(k & 1 ? high.x : low.x) - 0.5, (k & 2 ? high.y : low.y) - 0.5, (k & 4 ? high.z : low.z) - 0.5}));
  return corner;
}

std::vector<Vec3d> SlicePlane::positions(int columns, int rows) const {
  std::vector<Vec3d> result;
  result.reserve(std::size_t(columns) * std::size_t(rows));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      result.push_back(corner + across * ((x + 0.5) / columns) + up * ((y + 0.5) / rows));
  return result;
}

SlicePlane slice_plane(const MeshInput& input, int axis, double at) {
  int across = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(input.axes[std::size_t(a)][axis]) > std::fabs(input.axes[std::size_t(across)][axis])) across = a;
  const bool turned = input.axes[std::size_t(across)][axis] < 0;
  return layer_plane(input, across, (turned ? 1 - at : at) * input.dims[across] - 0.5);
}

SlicePlane layer_plane(const MeshInput& input, int across, double along) {
  SlicePlane plane{};
  plane.across_axis = across == 0 ? 1 : 0;
  plane.up_axis = across == 2 ? 1 : 2;
  plane.width = input.dims[plane.across_axis];
  plane.height = input.dims[plane.up_axis];
  plane.first[across] = std::clamp(int(std::floor(along + 0.5)), 0, input.dims[across] - 1);
  const auto step = [&](int a) { return input.axes[std::size_t(a)] * input.spacing[a]; };
  plane.across = step(plane.across_axis) * plane.width;
  plane.up = step(plane.up_axis) * plane.height;
  plane.corner = input.origin + step(across) * along - step(plane.across_axis) * 0.5 - step(plane.up_axis) * 0.5;
  return plane;
}

std::optional<SlicePlane> slice_plane(const ViewedVolume& volume, const WorldPlane& wanted) {
  const std::vector<Vec3d> corners = volume.box();
  BoxCorners box;
  std::copy_n(corners.begin(), box.size(), box.begin());
  const std::vector<Vec3d> outline = plane_outline(wanted, box);
  if (outline.empty()) return {};
  const Vec3d& n = wanted.normal;
  const Vec3d along = std::fabs(n.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0);  // up in the picture, as far as it can be
  const Vec3d across = normalized(cross(along, n)), up = cross(n, across);
  std::array<double, 4> ends{1e300, 1e300, -1e300, -1e300};
  for (const Vec3d& p : outline) {
    const double x = dot(p - wanted.point, across), y = dot(p - wanted.point, up);
    ends = {std::min(ends[0], x), std::min(ends[1], y), std::max(ends[2], x), std::max(ends[3], y)};
  }
  const double width = ends[2] - ends[0], height = ends[3] - ends[1], longer = std::max(width, height);
  if (!(std::min(width, height) > 0)) return {};
  SlicePlane plane{};
  plane.across_axis = plane.up_axis = -1;
  plane.corner = wanted.point + across * ends[0] + up * ends[1];
  plane.across = across * width;
  plane.up = up * height;
  const double pixel = std::max(volume.voxel_length(), longer / most_pixels);
  plane.width = std::max(1, int(std::ceil(width / pixel)));
  plane.height = std::max(1, int(std::ceil(height / pixel)));
  return plane;
}

std::optional<SlicePlane> wanted_slice(const ViewedVolume& volume, const ViewSettings& view) {
  if (view.slice == PlaneAxis::none) return {};
  if (view.slice != PlaneAxis::plane) return slice_plane(volume.input, int(view.slice) - 1, view.slice_at);
  const std::vector<WorldPlane> planes = parse_clip_planes(view.clip_planes);
  return planes.empty() ? std::nullopt : slice_plane(volume, planes.front());
}

/// Along the volume's axes, each pixel is a voxel: calls colour_of(its index).
template <class ColourOf>
static Image voxel_image(const ViewedVolume& v, const SlicePlane& plane, const ColourOf& colour_of) {
  Image image(plane.width, plane.height);
  const std::size_t stride[] = {1, std::size_t(v.input.dims.x), std::size_t(v.input.dims.x) * v.input.dims.y};
  std::size_t first = 0;
  for (int a = 0; a < 3; ++a) first += stride[a] * std::size_t(plane.first[a]);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x)
      put(image, std::size_t(y) * plane.width + x,
          colour_of(first + stride[plane.across_axis] * std::size_t(x) + stride[plane.up_axis] * std::size_t(y)));
  return image;
}

Image material_slice(const ViewedVolume& v, const SlicePlane& plane, std::span<const Color> palette) {
  return voxel_image(v, plane, [&](std::size_t i) -> const Color& { return material_pixel(palette, v.material[i]); });
}

static Image straight_slice(const ViewedVolume& v, const SlicePlane& plane, std::span<const Color> palette,
                            const Colormap& map, double low, double high) {
  if (v.input.kind != MeshVolume::Kind::scalar) return material_slice(v, plane, palette);
  return std::visit(
      [&](const auto& values) {
        return voxel_image(v, plane, [&](std::size_t i) -> const Color& {
          return std::isnan(double(values[i])) ? outside_colour : mapped(map, double(values[i]), low, high);
        });
      },
      v.volumes->front().values);
}

/// Linear between the centres of the voxels around `p` (in voxels), as far as there are some.
template <class T>
static double between_voxels(const VoxelArray<T>& values, const Int3& dims, const Vec3d& p) {
  std::array<std::size_t, 8> at{};
  Vec3d share;
  std::size_t stride = 1;
  for (int a = 0; a < 3; ++a) {
    const double x = std::clamp(p[a], 0.0, double(dims[a] - 1));
    const int first = std::min(int(x), std::max(0, dims[a] - 2));
    share[a] = x - first;
    for (std::size_t k = 0; k < 8; ++k) at[k] += stride * std::size_t(std::min(first + int(k >> a & 1), dims[a] - 1));
    stride *= std::size_t(dims[a]);
  }
  double sum = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const double weight =
        (k & 1 ? share.x : 1 - share.x) * (k & 2 ? share.y : 1 - share.y) * (k & 4 ? share.z : 1 - share.z);
    if (weight > 0) sum += weight * double(values[at[k]]);
  }
  return sum;
}

/// In any direction.
static Image oblique_slice(const ViewedVolume& v, const SlicePlane& plane, std::span<const Color> palette,
                           const Colormap& map, double low, double high) {
  Image image(plane.width, plane.height);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t(0));
  const Vec3d corner = v.to_voxels(plane.corner);
  const Vec3d across = (v.to_voxels(plane.corner + plane.across) - corner) / plane.width;
  const Vec3d up = (v.to_voxels(plane.corner + plane.up) - corner) / plane.height;
  const auto each = [&](const auto& colour_of) {
    for (int y = 0; y < plane.height; ++y)
      for (int x = 0; x < plane.width; ++x) {
        const Vec3d p = corner + across * (x + 0.5) + up * (y + 0.5);
        const std::optional<std::size_t> index = v.index_of(p);
        if (!index) continue;
        const std::size_t pixel = std::size_t(y) * std::size_t(plane.width) + std::size_t(x);
        put(image, pixel, colour_of(p, *index));
        image.pixels[4 * pixel + 3] = 255;
      }
  };
  if (v.input.kind == MeshVolume::Kind::scalar) {
    std::visit(
        [&](const auto& values) {
          each([&](const Vec3d& p, std::size_t) -> const Color& {
            const double value = between_voxels(values, v.input.dims, p);
            return std::isnan(value) ? outside_colour : mapped(map, value, low, high);
          });
        },
        v.volumes->front().values);
  } else {
    each([&](const Vec3d&, std::size_t i) -> const Color& { return material_pixel(palette, v.material[i]); });
  }
  return image;
}

Image volume_slice(const ViewedVolume& v, const SlicePlane& plane, std::span<const Color> palette, const Colormap& map,
                   double low, double high) {
  const auto make = plane.is_oblique() ? oblique_slice : straight_slice;
  return make(v, plane, palette, map, low, high);
}

Image colour_values(const std::vector<float>& values, int width, int height, double low, double high,
                    const Colormap& map) {
  Image image(width, height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]))
      std::fill_n(&image.pixels[4 * i], 4, std::uint8_t(0));
    else
      put(image, i, mapped(map, std::isinf(values[i]) ? high : double(values[i]), low, high));
  }
  return image;
}

Image colour_materials(const std::vector<float>& materials, int width, int height, std::span<const Color> palette) {
  Image image(width, height);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (std::isnan(materials[i]))
      std::fill_n(&image.pixels[4 * i], 4, std::uint8_t(0));
    else
      put(image, i, material_pixel(palette, std::uint16_t(materials[i])));
  }
  return image;
}

}  // namespace nacre
