// Nacre: how far two words are apart.
#include "engine/scene/settings/edit_distance.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace nacre {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  constexpr std::size_t most = 64;  // names are short; what someone typed may not be
  a = a.substr(0, most), b = b.substr(0, most);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = corner + (a[i] != b[j]);
      corner = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace nacre
