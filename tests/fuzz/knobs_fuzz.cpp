// Nacre: fuzz target: a knob and its value, as after --set.
#include "engine/scene/settings/knobs.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_text(data, size, [](const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos) return;
    nacre::Settings settings;
    nacre::set_knob(settings, text.substr(0, equals), text.substr(equals + 1));
    nacre::Settings again;  // what is written can be read, and says the same
    for (const nacre::Knob& knob : nacre::knobs(settings)) nacre::set_knob(again, knob.name, knob.text());
  });
  return 0;
}
