// Nacre: groups of triangles and tetrahedra, and their names.
#include "engine/io/mesh_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

using MaterialLabels = std::span<const std::int64_t>;
using GivenNames = std::span<const std::string>;

constexpr std::size_t longest_word = 60;

/// Everything else becomes one underscore for each run of it.
std::string solver_word(const std::string& name) {
  std::string word;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) && static_cast<unsigned char>(c) < 128;
    if (plain)
      word += c;
    else if (!word.empty() && word.back() != '_')
      word += '_';
  }
  while (!word.empty() && word.back() == '_') word.pop_back();
  if (word.empty() || !std::isalpha(static_cast<unsigned char>(word[0]))) word = "group_" + word;
  return word.substr(0, longest_word);
}

std::string in_upper_case(std::string word) {
  for (char& c : word) c = char(std::toupper(static_cast<unsigned char>(c)));
  return word;
}

}  // namespace

std::vector<std::string> full_names(MaterialLabels labels, GivenNames given) {
  const auto empty = [](const std::string& name) { return name.empty(); };
  if (std::all_of(given.begin(), given.end(), empty)) return {};
  std::vector<std::string> names(labels.size());
  for (std::size_t m = 0; m < labels.size(); ++m) {
    const std::string name = m < given.size() ? given[m] : "";
    const bool shared = !name.empty() && std::count(given.begin(), given.end(), name) > 1;
    names[m] = name.empty() ? fmt::format("material_{}", labels[m])
               : shared     ? fmt::format("{} {}", name, labels[m])
                            : name;
  }
  return names;
}

std::string material_name(std::uint16_t material, MaterialLabels labels, GivenNames names) {
  return names.empty() ? fmt::format("material_{}", labels[material]) : names[material];
}

std::string interface_name(const MaterialPair& pair, MaterialLabels labels, GivenNames names) {
  if (names.empty()) return fmt::format("material_{}_{}", labels[pair[0]], labels[pair[1]]);
  return names[pair[0]] + " - " + names[pair[1]];
}

MeshParts surface_parts(const SurfaceMesh& mesh, MaterialLabels labels, GivenNames names) {
  MeshParts parts;
  parts.points = mesh.points;
  parts.triangles = mesh.triangles;
  parts.materials = mesh.materials;
  for (const MaterialPair& pair : mesh.materials) ++parts.interfaces.try_emplace(pair).first->second.cells;
  std::int32_t tag = 0;
  for (auto& [pair, group] : parts.interfaces) {
    group.tag = ++tag;
    group.name = interface_name(pair, labels, names);
  }
  return parts;
}

MeshParts volume_parts(const TetrahedralMesh& mesh, const SurfaceMesh& surface, MaterialLabels labels,
                       GivenNames names) {
  MeshParts parts = surface_parts(surface, labels, names);
  parts.points = mesh.points;
  parts.cells = mesh.cells;
  parts.material = mesh.material;
  for (const std::uint16_t m : mesh.material) ++parts.volumes.try_emplace(m).first->second.cells;
  const bool usable = std::all_of(parts.volumes.begin(), parts.volumes.end(), [&](const auto& entry) {
    const std::int64_t label = labels[entry.first];
    return label > 0 && label <= std::numeric_limits<std::int32_t>::max();
  });
  for (auto& [m, group] : parts.volumes) {
    group.tag = usable ? std::int32_t(labels[m]) : std::int32_t(m);
    group.name = material_name(m, labels, names);
  }
  return parts;
}

std::string Identifiers::of(const std::string& name) {
  const std::string word = solver_word(name);
  std::string unique = word;
  for (int times = 2; !taken_.insert(in_upper_case(unique)).second; ++times) {
    const std::string number = fmt::format("_{}", times);
    unique = word.substr(0, longest_word - number.size()) + number;
  }
  return unique;
}

void check_counts(const std::filesystem::path& file, const MeshParts& mesh, const char* format) {
  constexpr auto most = std::size_t(std::numeric_limits<std::int32_t>::max());
  if (mesh.point_count() > most || mesh.triangles.size() + mesh.cells.size() > most)
    throw Error("cannot write " + file.string(), fmt::format("{} counts to 2,147,483,647", format), "use .vtp or .vtu");
}

}  // namespace nacre
