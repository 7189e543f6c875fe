// Nacre: what the environment says about the emulated device.
#include "tests/emulated/runtime/settings.hpp"

#include <cstdio>
#include <cstdlib>

namespace emulated {
namespace {

long number(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text && *text ? std::strtol(text, nullptr, 10) : otherwise;
}

}  // namespace

const Settings& settings() {
  static const Settings read{unsigned(number("NACRE_EMULATED_SEED", 1)), number("NACRE_EMULATED_ORDERED", 0) != 0,
                             std::size_t(number("NACRE_EMULATED_MIB", 1400)) << 20,
                             number("NACRE_EMULATED_TEAMS_ORDERED", 0) != 0, number("NACRE_EMULATED_SCREEN", 0) != 0};
  return read;
}

void broken(const std::string& what, const std::string& where) {
  std::fprintf(stderr, "emulated device: %s%s%s (seed %u)\n", what.c_str(), where.empty() ? "" : " in ", where.c_str(),
               settings().seed);
  std::abort();
}

}  // namespace emulated
