// Nacre: materials by their labels and names.
#include "app/viewer/mesh/mesh_results.hpp"

#include <fmt/format.h>

#include <sstream>

namespace nacre {

std::vector<std::int64_t> labels_of(const std::string& list) {
  std::vector<std::int64_t> labels;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');) {
    std::istringstream number(item);
    std::int64_t label;
    if (number >> label) labels.push_back(label);
  }
  return labels;
}

std::string material_name(const MeshInput& input, std::size_t number) {
  if (number == 0) return "outside";
  const bool named = number < input.names.size() && !input.names[number].empty();
  return named ? fmt::format("{} {}", input.labels[number], input.names[number])
               : fmt::format("{}", input.labels[number]);
}

}  // namespace nacre
