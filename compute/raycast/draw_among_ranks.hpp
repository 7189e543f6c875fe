// Nacre: a picture of a surface that several processes share: each casts all rays into its own bricks, the nearest hit
// of a ray counts, and each shades a part of the pixels ("direct send": Hsu 1993).
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "compute/device/array.hpp"
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

/// Of `n` pixels, those that a process shades go from this one to that of the next process.
inline std::int64_t first_shaded(const Ranks& ranks, int rank, std::int64_t n) { return n * rank / ranks.count(); }

/// The nearest hits of all processes along the rays that this one shades. `samples`: what it sees through `n` pixels,
/// with `rays` each. A hit is sent once, to the process that shades it. Collective.
inline std::vector<SeenSample> nearest_hits(Ranks& ranks, const std::vector<SeenSample>& samples, std::int64_t n,
                                            std::int64_t rays) {
  std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks.count()));
  std::vector<SeenSample> nearest;
  for (int rank = 0; rank < ranks.count(); ++rank) {
    const auto begin = std::size_t(first_shaded(ranks, rank, n) * rays);
    const auto end = std::size_t(first_shaded(ranks, rank + 1, n) * rays);
    if (rank == ranks.rank()) {
      nearest.assign(samples.data() + begin, samples.data() + end);
      continue;
    }
    Ranks::Bytes& to = send[static_cast<std::size_t>(rank)];
    for (std::size_t k = begin; k < end; ++k) {
      if (samples[k].triangle == none) continue;
      const SeenAt one{k - begin, samples[k]};
      const auto* bytes = reinterpret_cast<const std::byte*>(&one);
      to.insert(to.end(), bytes, bytes + sizeof one);
    }
  }
  for (const Ranks::Bytes& from : ranks.exchange(send))
    for (std::size_t at = 0; at < from.size(); at += sizeof(SeenAt)) {
      SeenAt one;
      std::memcpy(&one, from.data() + at, sizeof one);
      keep_nearer(nearest[one.index], one.sample);
    }
  return nearest;
}

/// Puts the pixels that each process has shaded into the picture of the first. `parts`: first pixel and number of
/// pixels of each part. Collective.
inline void gather_pixels(Ranks& ranks, const Array<std::uint32_t>& pixels,
                          const std::vector<std::pair<std::int64_t, std::int64_t>>& parts) {
  std::vector<std::uint32_t> picture = pixels.download();
  const auto each_run = [&](int rank, const auto& visit) {
    for (const auto& [first, n] : parts) {
      const std::int64_t begin = first_shaded(ranks, rank, n), end = first_shaded(ranks, rank + 1, n);
      visit(picture.data() + first + begin, std::size_t(end - begin) * sizeof(std::uint32_t));
    }
  };
  std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks.count()));
  if (!ranks.first())
    each_run(ranks.rank(), [&](const std::uint32_t* run, std::size_t size) {
      const auto* bytes = reinterpret_cast<const std::byte*>(run);
      send[0].insert(send[0].end(), bytes, bytes + size);
    });
  const std::vector<Ranks::Bytes> received = ranks.exchange(send);
  if (!ranks.first()) return;
  for (int rank = 1; rank < ranks.count(); ++rank) {
    const std::byte* from = received[static_cast<std::size_t>(rank)].data();
    each_run(rank, [&](std::uint32_t* run, std::size_t size) {
      if (size > 0) std::memcpy(run, from, size);
      from += size;
    });
  }
  Array<std::uint32_t>(pixels).upload(picture);
}

}  // namespace detail

/// Fills the pixels on the first process, with the same bytes as one process alone; a part of the picture at a time.
/// `most`: cells around a hit in which a process knows the values of the texture. Throws Error where a pixel stands for
/// more. Collective.
template <class Backend, class Pixel>
void draw_among_ranks(Executor<Backend>& exec, Ranks& ranks, const Pixel& whole, const Array<std::uint32_t>& pixels,
                      double most) {
  constexpr std::int64_t most_samples = 1 << 20;
  const std::int64_t rays = std::int64_t(whole.samples) * whole.samples, count = std::int64_t(pixels.size());
  const std::int64_t at_once = std::min(count, std::max<std::int64_t>(1, most_samples / rays));
  Arena::Scope scope(exec.arena());
  Array<SeenSample> seen = exec.arena().template temporary<SeenSample>(std::size_t(at_once * rays));
  Array<std::uint32_t> too_wide = exec.arena().template temporary<std::uint32_t>(1);
  too_wide.fill_bytes(0);
  std::vector<std::pair<std::int64_t, std::int64_t>> parts;
  for (std::int64_t first = 0; first < count; first += at_once) {
    const std::int64_t n = std::min(at_once, count - first);
    parts.emplace_back(first, n);
    Pixel pixel = whole;
    pixel.first = first;
    pixel.seen = seen.data();
    pixel.most = float(most);
    pixel.too_wide = too_wide.data();
    exec.for_each(n, pixel);
    const auto nearest = detail::nearest_hits(ranks, seen.download(0, std::size_t(n * rays)), n, rays);
    seen.upload(nearest);
    pixel.first = first + detail::first_shaded(ranks, ranks.rank(), n);
    pixel.seen = nullptr;
    pixel.given = seen.data();
    exec.for_each(std::int64_t(nearest.size()) / rays, pixel);
  }
  detail::gather_pixels(ranks, pixels, parts);
  std::uint64_t wide = too_wide.download()[0];
  ranks.sum({&wide, 1});
  if (wide > 0)
    throw Error("a pixel of the picture stands for more cells than a process knows around its own",
                "over " + std::to_string(int(2 * most)), "make the picture larger, or use a lower `resolution`");
}

/// The same where `ranks` is not null, else a picture by this process alone.
template <class Backend, class Pixel>
void draw_among(Executor<Backend>& exec, Ranks* ranks, const Pixel& pixel, const Array<std::uint32_t>& pixels,
                double most) {
  if (ranks)
    draw_among_ranks(exec, *ranks, pixel, pixels, most);
  else
    exec.for_each(std::int64_t(pixels.size()), pixel);
}

}  // namespace nacre
