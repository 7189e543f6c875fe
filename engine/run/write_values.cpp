// Nacre: writes the values of a flow that one process has, or several.
#include "engine/run/write_values.hpp"

#include <vector>

#include "compute/pipeline/gather_values.hpp"
#include "engine/system/extension.hpp"

namespace nacre {

void write_values(const std::filesystem::path& file, const FlowMethod& flow, Ranks* ranks, const std::string& origin,
                  const MoreArrays& more) {
  FlowValues values = flow.values();
  if (lower_extension(file) != ".pvtp") {
    if (ranks) gather_values(*ranks, values);
    if (!ranks || ranks->first()) write_flow_values(values, file, flow.time(), origin, more);
    return;
  }
  const int own = ranks ? ranks->rank() : 0;
  std::vector<std::uint64_t> cells(static_cast<std::size_t>(ranks ? ranks->count() : 1));
  cells[static_cast<std::size_t>(own)] = values.value.size();
  if (ranks) ranks->sum(cells);
  const auto wait_for_all = [ranks] {
    std::uint64_t nothing = 0;
    if (ranks) ranks->sum({&nothing, 1});
  };
  if (values.value.empty())
    wait_for_all();
  else
    write_flow_values(values, flow_values_piece(file, own), flow.time(), origin, more, wait_for_all);
  wait_for_all();
  std::vector<int> parts;  // not those of processes that have no cells
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (cells[k] > 0) parts.push_back(int(k));
  if (!ranks || ranks->first()) write_flow_values_list(file, parts, origin, more);
}

}  // namespace nacre
