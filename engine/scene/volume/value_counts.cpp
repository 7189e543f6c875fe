// Nacre: how often each value of a volume occurs, in one pass.
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "engine/scene/volume/volume.hpp"

namespace nacre {
namespace {

/// Behind the run of equal values that begins at `i`.
template <class T>
std::size_t end_of_run(const T* values, std::size_t i, std::size_t end) {
  const T value = values[i];
  constexpr std::size_t step = 16;
  for (++i; i + step <= end; i += step) {
    bool alike = true;
    for (std::size_t k = 0; k < step; ++k) alike &= values[i + k] == value;
    if (!alike) break;
  }
  while (i < end && values[i] == value) ++i;
  return i;
}

template <class T>
ValueCounts counted(const VoxelArray<T>& values, std::size_t row) {
  constexpr std::size_t different = std::size_t(1) << 8 * sizeof(T), piece = std::size_t(1) << 24;
  const ValueCounts none{std::vector<std::size_t>(different, 0), std::vector<std::size_t>(different, 0)};
  tbb::enumerable_thread_specific<ValueCounts> counts(none);
  const std::size_t rows = values.size() / row, at_once = std::max<std::size_t>(1, piece / row);
  tbb::parallel_for(std::size_t(0), (rows + at_once - 1) / at_once, [&](std::size_t p) {
    ValueCounts& mine = counts.local();
    const std::size_t first = p * at_once, last = std::min(rows, first + at_once);
    for (std::size_t r = first; r < last; ++r)
      for (std::size_t i = r * row; i < (r + 1) * row;) {
        const std::size_t end = end_of_run(values.data(), i, (r + 1) * row);
        const auto bits = std::make_unsigned_t<T>(values[i]);
        mine.voxels[bits] += end - i;
        mine.repeated[bits] += end - i - 1;
        i = end;
      }
    values.let_go(first * row, last * row);
  });
  ValueCounts all = none;
  for (const ValueCounts& mine : counts)
    for (std::size_t k = 0; k < different; ++k) all.voxels[k] += mine.voxels[k], all.repeated[k] += mine.repeated[k];
  return all;
}

}  // namespace

const ValueCounts* value_counts(const Volume& volume) {
  return std::visit(
      [&](const auto& values) -> const ValueCounts* {
        using T = std::decay_t<decltype(values[0])>;
        if constexpr (sizeof(T) <= 2) {
          KeptCounts& kept = values.kept_counts();
          std::call_once(kept.once, [&] { kept.counts = counted(values, std::size_t(volume.dims.x)); });
          return &kept.counts;
        }
        return nullptr;
      },
      volume.values);
}

}  // namespace nacre
