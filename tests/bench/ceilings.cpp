// Nacre: what this machine's processors can do at most, to hold the program's stages against.
//
// bench_ceilings [threads=0]
//
// Prints JSON: bytes a second of a copy (read and written) and of reads alone in order, 64-byte lines a second at
// random positions of an array far larger than the caches (as many under way as the processor likes, and one after
// another), single-precision multiply-adds a second in vectors and one by one, and additions of whole numbers a second.
// The best of five runs each.
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

constexpr std::size_t bytes = std::size_t(1) << 29;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Seconds of `work(thread)` on all threads, the least of five times.
template <class Work>
double seconds_of(int threads, const Work& work) {
  double best = 1e30;
  for (int run = 0; run < 5; ++run) {
    const double begin = now();
    tbb::parallel_for(0, threads, work, tbb::simple_partitioner());
    best = std::min(best, now() - begin);
  }
  return best;
}

struct Line {
  std::array<std::uint64_t, 8> words;
};

/// Any good mixing will do.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

volatile double kept;  // so that nothing is computed in vain

}  // namespace

int main(int argc, char** argv) {
  int threads = argc > 1 ? std::atoi(argv[1]) : 0;
  if (threads <= 0) threads = tbb::info::default_concurrency();
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
  const std::size_t words = bytes / sizeof(double), share = words / std::size_t(threads);
  const auto first = std::make_unique<double[]>(words), second = std::make_unique<double[]>(words);
  std::fill_n(first.get(), words, 1.0);
  std::fill_n(second.get(), words, 2.0);

  const double copy = seconds_of(threads, [&](int t) {
    std::copy_n(first.get() + std::size_t(t) * share, share, second.get() + std::size_t(t) * share);
  });
  std::vector<double> sums(std::size_t(threads) * 16);
  const double read = seconds_of(threads, [&](int t) {
    std::array<double, 32> sum{};
    const double* from = first.get() + std::size_t(t) * share;
    for (std::size_t i = 0; i + 32 <= share; i += 32)
      for (std::size_t k = 0; k < 32; ++k) sum[k] += from[i + k];
    for (const double s : sum) sums[std::size_t(t) * 16] += s;
  });

  constexpr std::size_t lines = bytes / sizeof(Line);
  const auto* line = reinterpret_cast<const Line*>(first.get());
  constexpr std::size_t reads = std::size_t(1) << 22;
  const double scattered = seconds_of(threads, [&](int t) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < reads; ++i) sum += line[mixed(i * 64 + std::size_t(t)) % lines].words[0];
    sums[std::size_t(t) * 16] += double(sum);
  });
  const double chained = seconds_of(threads, [&](int t) {
    std::uint64_t at = std::uint64_t(t);
    for (std::size_t i = 0; i < reads / 4; ++i) at = mixed(at + i + line[at % lines].words[0]);
    sums[std::size_t(t) * 16] += double(at);
  });

  constexpr int rounds = 4'000'000, wide = 128;
  const double vectors = seconds_of(threads, [&](int t) {
    std::array<float, wide> x;
    for (int k = 0; k < wide; ++k) x[std::size_t(k)] = float(k + t);
    for (int i = 0; i < rounds; ++i)
      for (std::size_t k = 0; k < wide; ++k) x[k] = x[k] * 0.999f + 0.001f;
    for (const float v : x) sums[std::size_t(t) * 16] += double(v);
  });
  const double single = seconds_of(threads, [&](int t) {
    float a = float(t), b = 1, c = 2, d = 3, e = 4, f = 5, g = 6, h = 7;
    for (int i = 0; i < rounds * 8; ++i) {
      a = a * 0.999f + 0.001f, b = b * 0.999f + 0.001f, c = c * 0.999f + 0.001f, d = d * 0.999f + 0.001f;
      e = e * 0.999f + 0.001f, f = f * 0.999f + 0.001f, g = g * 0.999f + 0.001f, h = h * 0.999f + 0.001f;
      __asm__ volatile("" : "+x"(a), "+x"(b), "+x"(c), "+x"(d), "+x"(e), "+x"(f), "+x"(g), "+x"(h));
    }
    sums[std::size_t(t) * 16] += double(a + b + c + d + e + f + g + h);
  });
  const double whole = seconds_of(threads, [&](int t) {
    std::uint64_t a = std::uint64_t(t), b = 1, c = 2, d = 3, e = 4, f = 5, g = 6, h = 7;
    for (int i = 0; i < rounds * 8; ++i) {
      a += 3, b += 5, c += 7, d += 9, e += 11, f += 13, g += 15, h += 17;
      __asm__ volatile("" : "+r"(a), "+r"(b), "+r"(c), "+r"(d), "+r"(e), "+r"(f), "+r"(g), "+r"(h));
    }
    sums[std::size_t(t) * 16] += double(a + b + c + d + e + f + g + h);
  });
  for (const double s : sums) kept = kept + s;

  const double n = threads;
  std::printf(
      "{\"threads\": %d,\n \"copy_bytes_per_second\": %.4g,\n \"read_bytes_per_second\": %.4g,\n"
      " \"random_lines_per_second\": %.4g,\n \"chained_lines_per_second\": %.4g,\n"
      " \"vector_multiply_adds_per_second\": %.4g,\n \"single_multiply_adds_per_second\": %.4g,\n"
      " \"whole_additions_per_second\": %.4g}\n",
      threads, 2 * double(share) * n * sizeof(double) / copy, double(share) * n * sizeof(double) / read,
      n * double(reads) / scattered, n * double(reads / 4) / chained, n * double(rounds) * wide / vectors,
      n * 64.0 * rounds / single, n * 64.0 * rounds / whole);
}
