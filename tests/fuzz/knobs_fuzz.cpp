// Nacre: fuzz target: a knob and its value, as after --set.
#include <nlohmann/json.hpp>

#include "engine/scene/settings/knobs.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_text(data, size, [](const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos) return;
    const std::string name = text.substr(0, equals);
    nacre::Settings settings, again;
    nacre::set_knob(settings, name, text.substr(equals + 1));
    for (const nacre::Knob& knob : nacre::knobs(settings))  // what is written can be read, and says the same
      if (knob.is_named(nacre::snake_case(name))) {
        nacre::set_knob(again, name, knob.text());
        if (nacre::knob_values(again) != nacre::knob_values(settings)) __builtin_trap();
        return;
      }
  });
  return 0;
}
