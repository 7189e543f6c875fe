// Nacre: a picture of a surface that several processes share: each casts all rays into its own bricks, the nearest hit
// of a ray counts, and the first process shades it.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/device/executor.hpp"
#include "compute/device/ranks.hpp"
#include "compute/raycast/render.hpp"

namespace nacre {

namespace detail {

struct SeenAt {
  std::uint64_t index;
  SeenSample sample;
};

/// Of equally near hits, the one that a single process would take: the lower triangle.
inline void keep_nearer(SeenSample& kept, const SeenSample& other) {
  if (other.t < kept.t || (other.t == kept.t && other.triangle < kept.triangle)) kept = other;
}

}  // namespace detail

/// Fills the pixels on the first process, with the same bytes as one process alone; a part of the picture at a time.
/// `most`: cells around a hit in which a process knows the values of the texture. Throws Error where a pixel stands for
/// more. Collective.
template <class Backend, class Pixel>
void draw_among_ranks(Executor<Backend>& exec, Ranks& ranks, const Pixel& whole, double most) {
  constexpr std::int64_t most_samples = 1 << 20;
  const std::int64_t rays = std::int64_t(whole.samples) * whole.samples,
                     pixels = std::int64_t(whole.width) * whole.height;
  const std::int64_t at_once = std::max<std::int64_t>(1, most_samples / rays);
  Arena::Scope scope(exec.arena());
  Array<SeenSample> seen = exec.arena().template temporary<SeenSample>(std::size_t(std::min(at_once, pixels) * rays));
  Array<std::uint32_t> too_wide = exec.arena().template temporary<std::uint32_t>(1);
  too_wide.fill_bytes(0);
  for (std::int64_t first = 0; first < pixels; first += at_once) {
    const std::int64_t n = std::min(at_once, pixels - first);
    Pixel pixel = whole;
    pixel.first = first;
    pixel.seen = seen.data();
    pixel.most = float(most);
    pixel.too_wide = too_wide.data();
    exec.for_each(n, pixel);
    std::vector<SeenSample> samples = seen.download(0, std::size_t(n * rays));
    std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks.count()));
    if (!ranks.first())
      for (std::size_t k = 0; k < samples.size(); ++k) {
        if (samples[k].triangle == none) continue;
        const detail::SeenAt one{k, samples[k]};
        const auto* bytes = reinterpret_cast<const std::byte*>(&one);
        send[0].insert(send[0].end(), bytes, bytes + sizeof one);
      }
    const std::vector<Ranks::Bytes> received = ranks.exchange(send);
    if (!ranks.first()) continue;
    for (const Ranks::Bytes& from : received)
      for (std::size_t at = 0; at < from.size(); at += sizeof(detail::SeenAt)) {
        detail::SeenAt one;
        std::memcpy(&one, from.data() + at, sizeof one);
        detail::keep_nearer(samples[one.index], one.sample);
      }
    seen.upload(samples);
    pixel.seen = nullptr;
    pixel.given = seen.data();
    exec.for_each(n, pixel);
  }
  std::uint64_t wide = too_wide.download()[0];
  ranks.sum({&wide, 1});
  if (wide > 0)
    throw Error("a pixel of the picture stands for more cells than a process knows around its own",
                "over " + std::to_string(int(2 * most)), "make the picture larger, or use a lower `resolution`");
}

/// The same where `ranks` is not null, else a picture by this process alone.
template <class Backend, class Pixel>
void draw_among(Executor<Backend>& exec, Ranks* ranks, const Pixel& pixel, double most) {
  if (ranks)
    draw_among_ranks(exec, *ranks, pixel, most);
  else
    exec.for_each(std::int64_t(pixel.width) * pixel.height, pixel);
}

}  // namespace nacre
