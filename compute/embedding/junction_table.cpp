// Nacre: all interfaces by number, and which of them bound which.
#include "compute/embedding/junction_table.hpp"

#include <algorithm>
#include <string>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

/// Each kind of point once, in an order that depends on the kinds alone.
std::vector<Junction> kinds_of(std::span<const Junction> points) {
  std::vector<Junction> kinds(points.begin(), points.end());
  std::sort(kinds.begin(), kinds.end(), [](const Junction& a, const Junction& b) { return a.packed < b.packed; });
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  return kinds;
}

}  // namespace

JunctionTable make_junction_table(std::span<const Junction> interfaces, std::span<const Junction> points) {
  JunctionTable table;
  table.junctions.assign(interfaces.begin(), interfaces.end());
  const std::vector<Junction> kinds = kinds_of(points);
  table.junctions.insert(table.junctions.end(), kinds.begin(), kinds.end());
  const std::vector<Junction>& all = table.junctions;
  if (all.size() > most_interfaces)
    throw Error("too many interfaces", std::to_string(all.size()) + " pairs, triples and quadruples of materials meet",
                "merge materials with `merge` or keep fewer with `materials`");
  std::vector<std::vector<std::uint32_t>> with(0x10000);  // per material: its curves and points
  for (std::size_t l = 0; l < all.size(); ++l)
    for (int m = 0; all[l].order() < 2 && m < all[l].materials(); ++m)
      with[all[l].material(m)].push_back(std::uint32_t(l));
  table.start.push_back(0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    table.related.push_back(std::uint32_t(k));
    for (const std::uint32_t l : with[all[k].material(0)])
      if (all[l].order() < all[k].order() && all[l].bounds(all[k])) table.related.push_back(l);
    table.start.push_back(std::uint32_t(table.related.size()));
    table.order.push_back(std::uint8_t(all[k].order()));
  }
  return table;
}

std::optional<std::uint32_t> JunctionTable::find(const Junction& junction) const {
  const auto found = std::find(junctions.begin(), junctions.end(), junction);
  if (found == junctions.end()) return {};
  return std::uint32_t(found - junctions.begin());
}

}  // namespace nacre
