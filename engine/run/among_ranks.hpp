// Nacre: what the processes that share a run agree on, and what they tell the first one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compute/device/ranks.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/scene/surface/surface_share.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// The first process's number, on all of them; `value` itself where `ranks` is null. Collective, as all that follow.
std::uint64_t first_ones(Ranks* ranks, std::uint64_t value);

/// The same of a text.
std::string first_ones(Ranks* ranks, const std::string& text);

/// Gives all processes the bytes of the first. Each passes them on to others, so that it takes log2(count) rounds.
void broadcast(Ranks& ranks, std::vector<std::byte>& bytes);

/// Throws Error where the processes have read different surfaces or vectors at the time `start`, or were given
/// different knobs.
void require_same_input(Ranks& ranks, VectorsInTime& input, double start, const std::string& knobs);

/// Throws Error where the processes were given different texts: what they are to do.
void require_same_text(Ranks& ranks, const std::string& text);

/// What each process did, on the first: its share, memory and stages (from `own_report`), bytes sent, and time spent
/// waiting; of a surface in shares also what it had of that.
nlohmann::json ranks_report(Ranks& ranks, const EmbeddingInfo& embedding, const nlohmann::json& own_report,
                            std::vector<double> seconds_per_step, const Share* share = nullptr);

}  // namespace nacre
