// Nacre: faults on demand.
#include "engine/system/faults.hpp"

#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

namespace nacre {
namespace {

struct Fault {
  long when = 0;  ///< 0: every time
  long asked = 0;
};

std::map<std::string, Fault, std::less<>> wanted_faults() {
  std::map<std::string, Fault, std::less<>> faults;
  const char* setting = std::getenv("NACRE_FAULTS");
  std::string_view rest = setting ? setting : "";
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    const std::size_t at = word.find('@');
    const long when = at == word.npos ? 0 : std::strtol(std::string(word.substr(at + 1)).c_str(), nullptr, 10);
    faults[std::string(word.substr(0, at))] = {when, 0};
  }
  return faults;
}

}  // namespace

bool fault_due(std::string_view name) {
  static std::map<std::string, Fault, std::less<>> faults = wanted_faults();
  if (faults.empty()) return false;
  static std::mutex mutex;
  std::scoped_lock lock(mutex);
  const auto found = faults.find(name);
  if (found == faults.end()) return false;
  ++found->second.asked;
  return found->second.when == 0 || found->second.when == found->second.asked;
}

}  // namespace nacre
