// Nacre: arrays with numbered names as time steps.
#include "engine/io/array_families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <tuple>

namespace nacre {
namespace {

struct Candidate {
  ArrayFamily family;
  std::vector<double> times;
  int components = 0;
};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)); }

/// All groups of names that may be families, in the order of their first arrays.
std::vector<Candidate> collect(const std::vector<PointArray>& arrays) {
  using Key = std::tuple<std::string, std::string, int>;
  std::vector<Key> order;
  std::map<Key, std::vector<std::pair<double, std::string>>> groups;
  for (const PointArray& array : arrays) {
    NumberedName parts;
    if (!split_numbered_name(array.name, parts)) continue;
    auto& group = groups[{parts.base, parts.unit, array.components}];
    if (group.empty()) order.push_back({parts.base, parts.unit, array.components});
    group.push_back({parts.number, array.name});
  }
  std::vector<Candidate> candidates;
  for (const Key& key : order) {
    auto& group = groups[key];
    std::sort(group.begin(), group.end());
    Candidate candidate{{std::get<0>(key), {}}, {}, std::get<2>(key)};
    for (const auto& [time, name] : group) {
      if (!candidate.times.empty() && time <= candidate.times.back()) continue;  // "v_1" beside "v_01"
      candidate.times.push_back(time);
      candidate.family.members.push_back(name);
    }
    const bool name_taken = std::any_of(arrays.begin(), arrays.end(),
                                        [&](const PointArray& array) { return array.name == candidate.family.base; });
    const std::size_t least = candidate.components == 3 ? 2 : 3;
    if (candidate.times.size() == group.size() && group.size() >= least && !name_taken)
      candidates.push_back(std::move(candidate));
  }
  return candidates;
}

std::size_t count_vectors(const std::vector<PointArray>& arrays) {
  return std::size_t(std::count_if(arrays.begin(), arrays.end(), [](const auto& a) { return a.components == 3; }));
}

}  // namespace

bool split_numbered_name(const std::string& name, NumberedName& parts) {
  std::size_t end = name.size();
  std::size_t letters = 0;
  while (letters < 2 && end > 0 && is_letter(name[end - 1])) --end, ++letters;
  std::size_t first = end;
  while (first > 0 && is_digit(name[first - 1])) --first;
  if (first == end) return false;
  if (first >= 2 && name[first - 1] == '.' && is_digit(name[first - 2])) {
    --first;
    while (first > 0 && is_digit(name[first - 1])) --first;
  }
  const std::size_t base_end = name.find_last_not_of("_-=@. ", first == 0 ? 0 : first - 1);
  if (first == 0 || base_end == name.npos) return false;
  parts.base = name.substr(0, base_end + 1);
  parts.unit = name.substr(end);
  return std::from_chars(name.data() + first, name.data() + end, parts.number).ec == std::errc{};
}

ArrayFamilies find_array_families(const std::vector<PointArray>& arrays) {
  ArrayFamilies result;
  const std::vector<Candidate> candidates = collect(arrays);
  const auto is_vector = [](const Candidate& candidate) { return candidate.components == 3; };
  const bool have_vectors = std::any_of(candidates.begin(), candidates.end(), is_vector);
  if (candidates.empty() || (!have_vectors && count_vectors(arrays) > 0)) return result;

  const Candidate* longest = nullptr;
  for (const Candidate& candidate : candidates)
    if ((is_vector(candidate) || !have_vectors) && (!longest || candidate.times.size() > longest->times.size()))
      longest = &candidate;
  result.times = longest->times;
  for (const Candidate& candidate : candidates) {
    if (candidate.times == longest->times) {
      result.families.push_back(candidate.family);
    } else if (is_vector(candidate) || !have_vectors) {
      result.warnings.push_back(fmt::format("Arrays '{}..' have other times than '{}..' and are not shown over time.",
                                            candidate.family.members[0], longest->family.members[0]));
    }
  }
  return result;
}

void select_step(Surface& surface, const ArrayFamilies& families, std::size_t step) {
  for (const ArrayFamily& family : families.families) {
    for (PointArray& array : surface.arrays)
      if (array.name == family.members[step]) array.name = family.base;
    std::erase_if(surface.arrays, [&](const PointArray& array) {
      return std::find(family.members.begin(), family.members.end(), array.name) != family.members.end();
    });
  }
}

}  // namespace nacre
