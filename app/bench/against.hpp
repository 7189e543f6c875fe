// Nacre: two runs of `nacre bench` compared: the guard against losses.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace nacre {

/// A ratio is lost where it is worse by more than this share.
inline constexpr double tolerated_loss = 0.30;

struct RunComparison {
  int compared = 0;
  std::vector<std::string> losses;   ///< sentences that name table, row and quantity
  std::vector<std::string> missing;  ///< ratios of the last run, or rows or tables with some, that this one lacks
};

/// Compares the ratios (quantities that say which way is better) of the rows that both have. A loss: higher is better
/// and `now` is under 70% of `last`, or lower is better and `last` is under 70% of `now`. Of tables that `now` has not,
/// those that were asked for by name, or all where no name was given (`asked`), are missing.
RunComparison compare_runs(const nlohmann::json& now, const nlohmann::json& last,
                           const std::vector<std::string>& asked);

/// Reads a file that --json wrote. Throws Error for any other file.
nlohmann::json read_bench(const std::filesystem::path& file);

/// Throws Error where `last` was made in a way that makes ratios incomparable: size, backend, number of threads, knobs.
void require_comparable(const nlohmann::json& now, const nlohmann::json& last, const std::string& file);

}  // namespace nacre
