// Nacre: what the processes that share a run agree on, and what they tell the first one.
#include "engine/run/among_ranks.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "compute/device/byte_hash.hpp"
#include "compute/device/error.hpp"

namespace nacre {
namespace {

double median(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  return seconds.empty() ? 0 : seconds[seconds.size() / 2];
}

/// One entry for each process, on the first; `own` is that of this one.
nlohmann::json gather_reports(Ranks& ranks, const nlohmann::json& own) {
  const std::string text = own.dump();
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  std::vector<Ranks::Bytes> send(static_cast<std::size_t>(ranks.count()));
  send[0].assign(bytes, bytes + text.size());
  nlohmann::json all = nlohmann::json::array();
  for (const Ranks::Bytes& from : ranks.exchange(send)) {
    const auto* begin = reinterpret_cast<const char*>(from.data());
    if (ranks.first()) all.push_back(nlohmann::json::parse(begin, begin + from.size()));
  }
  return all;
}

}  // namespace

std::uint64_t first_ones(Ranks* ranks, std::uint64_t value) {
  if (!ranks) return value;
  std::uint64_t sum = ranks->first() ? value : 0;
  ranks->sum({&sum, 1});
  return sum;
}

std::string first_ones(Ranks* ranks, const std::string& text) {
  if (!ranks) return text;
  std::vector<std::byte> bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  broadcast(*ranks, bytes);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void broadcast(Ranks& ranks, std::vector<std::byte>& bytes) {
  bytes.resize(std::size_t(first_ones(&ranks, bytes.size())));
  if (bytes.empty()) return;
  for (int have = 1; have < ranks.count(); have *= 2) {  // processes that have the bytes: 0 .. have - 1
    const int to = ranks.rank() + have, from = ranks.rank() - have;
    const Ranks::Part out{to, bytes}, in{from, bytes};
    if (ranks.rank() < have)
      ranks.exchange(std::span(&out, to < ranks.count() ? 1 : 0), {});
    else
      ranks.exchange({}, std::span(&in, from < have ? 1 : 0));
  }
}

void require_same_input(Ranks& ranks, VectorsInTime& input, double start, const std::string& knobs) {
  const PreparedSurface& surface = input.surface();
  std::vector<Vec3f> vectors(surface.points.size());
  input.vectors(start, vectors);
  std::uint64_t hash = hash_begin;
  hash = hash_of(hash, std::span<const Vec3d>(surface.points));
  hash = hash_of(hash, std::span<const Triangle>(surface.triangles));
  hash = hash_of(hash, std::span<const Vec3f>(vectors));
  hash = hash_of(hash, std::span<const char>(knobs));
  require_same(ranks, hash);
}

void require_same_text(Ranks& ranks, const std::string& text) {
  require_same(ranks, hash_of(hash_begin, std::span<const char>(text)));
}

nlohmann::json ranks_report(Ranks& ranks, const EmbeddingInfo& embedding, const nlohmann::json& own_report,
                            std::vector<double> seconds_per_step, const Share* share) {
  nlohmann::json own = {{"bricks", embedding.own_bricks},
                        {"surface_cells", embedding.own_surface_cells},
                        {"halo_bricks", embedding.halo_bricks},
                        {"triangles", embedding.mesh_triangles},
                        {"memory", own_report["memory"]},
                        {"stages", own_report["stages"]},
                        {"seconds_per_step", median(std::move(seconds_per_step))},
                        {"sent_bytes", ranks.sent_bytes()},
                        {"waited_seconds", ranks.waited_seconds()}};
  if (share)
    own["share"] = {{"triangles", share->triangles},
                    {"peak_bytes", share->peak_bytes},
                    {"halo_bytes", share->halo_bytes},
                    {"kept_bytes", share->kept_bytes},
                    {"near_bricks_bytes", embedding.mesh_bytes}};
  nlohmann::json all = gather_reports(ranks, own);
  double most = 0, sum = 0;
  for (const nlohmann::json& each : all) {
    most = std::max(most, each["surface_cells"].get<double>());
    sum += each["surface_cells"].get<double>();
  }
  return {{"count", ranks.count()}, {"imbalance", sum > 0 ? most * ranks.count() / sum : 1}, {"each", std::move(all)}};
}

}  // namespace nacre
