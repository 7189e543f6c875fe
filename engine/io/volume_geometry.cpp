// Nacre: checks sizes and orientations of volumes.
#include "engine/io/volume_geometry.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compute/device/error.hpp"
#include "engine/io/file_bytes.hpp"

namespace nacre {
namespace {

constexpr double allowed_shear = 1e-3;
constexpr double pi = 3.14159265358979323846;

double memory_of_machine() { return double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGE_SIZE)); }

/// The orthogonal axes nearest to nearly orthogonal ones: Newton's iteration A <- (A + A^-T) / 2 of the polar
/// decomposition. It preserves handedness.
std::array<Vec3d, 3> orthogonalised(std::array<Vec3d, 3> a) {
  for (int round = 0; round < 4; ++round) {
    const double determinant = dot(cross(a[0], a[1]), a[2]);
    const std::array<Vec3d, 3> inverse_transposed{cross(a[1], a[2]) / determinant, cross(a[2], a[0]) / determinant,
                                                  cross(a[0], a[1]) / determinant};
    for (int i = 0; i < 3; ++i) a[i] = 0.5 * (a[i] + inverse_transposed[i]);
  }
  return a;
}

[[noreturn]] void fail_sheared(const std::array<Vec3d, 3>& axes, const std::filesystem::path& path) {
  int worst = 0;
  const auto cosine = [&](int pair) { return std::abs(dot(axes[pair], axes[(pair + 1) % 3])); };
  for (int pair = 1; pair < 3; ++pair)
    if (cosine(pair) > cosine(worst)) worst = pair;
  const int a = std::min(worst, (worst + 1) % 3), b = std::max(worst, (worst + 1) % 3);
  const double angle = std::acos(std::clamp(dot(axes[a], axes[b]), -1.0, 1.0)) * 180 / pi;
  fail_reading(path, fmt::format("its axes {} and {} are at {:.2f} degrees instead of 90: it is sheared", a, b, angle),
               "resample it to a grid with right angles");
}

}  // namespace

void set_dims(Volume& volume, const std::array<std::int64_t, 3>& dims, std::size_t bytes_per_voxel,
              const std::filesystem::path& path) {
  double voxels = 1;
  const std::string sizes = fmt::format("{} x {} x {}", dims[0], dims[1], dims[2]);
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] <= 0) fail_reading(path, fmt::format("its size is {} voxels", sizes));
    if (dims[axis] > std::numeric_limits<std::int32_t>::max())
      fail_reading(path, fmt::format("its size is {} voxels, which is implausible", sizes));
    voxels *= double(dims[axis]);
    volume.dims[axis] = std::int32_t(dims[axis]);
  }
  if (std::min({dims[0], dims[1], dims[2]}) < 2)
    fail_reading(path, fmt::format("it is a flat image of {} voxels", sizes), "open a volume, at least 2 voxels thick");
  if (voxels * double(bytes_per_voxel) > memory_of_machine())
    fail_reading(path, fmt::format("its {} voxels do not fit in memory", sizes),
                 "check the file, or extract a part of the volume");
}

double shear_of(const std::array<Vec3d, 3>& steps) {
  double shear = 0;
  for (int axis = 0; axis < 3; ++axis)
    shear = std::max(shear, std::abs(dot(normalized(steps[axis]), normalized(steps[(axis + 1) % 3]))));
  return shear;
}

void set_steps(Volume& volume, const std::array<Vec3d, 3>& steps, const std::filesystem::path& path) {
  for (int axis = 0; axis < 3; ++axis) {
    const double step = length(steps[axis]);
    if (!is_finite(steps[axis]) || !std::isfinite(step))
      fail_reading(path, fmt::format("the spacing along its axis {} is not a number", axis), "correct its header");
    if (!(step > 1e-30))
      fail_reading(path, fmt::format("the spacing along its axis {} is zero", axis), "correct its header");
    volume.spacing[axis] = step;
    volume.axes[axis] = steps[axis] / step + Vec3d(0, 0, 0);  // no negative zeros
  }
  const double shear = shear_of(steps);
  if (shear >= allowed_shear) fail_sheared(volume.axes, path);
  if (shear > 1e-12) volume.axes = orthogonalised(volume.axes);
}

void warn_unless_packed(Volume& volume, bool packed, const std::filesystem::path& file, const char* what_says_so) {
  if (packed) return;
  volume.warnings.push_back(
      fmt::format("{} is not packed with gzip, although {} says so; its bytes are taken as they are.",
                  file.filename().string(), what_says_so));
}

void warn_of_rest(Volume& volume, bool more) {
  if (more) volume.warnings.push_back("Its data go on after the last voxel; what follows is ignored.");
}

void check_stored(std::uintmax_t stored, std::uintmax_t needed, double ratio, const std::filesystem::path& path) {
  if (double(stored) * ratio < double(needed))
    fail_reading(path,
                 fmt::format("its header promises {} bytes of values, its {} bytes cannot hold them", needed, stored));
}

}  // namespace nacre
