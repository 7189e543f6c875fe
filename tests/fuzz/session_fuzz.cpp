// Nacre: fuzz target: sessions and scripts; what is read is written and read again.
#include "engine/scene/session/session.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_text(data, size, [](const std::string& text) {
    nacre::Session session = nacre::parse_session(text);
    const std::string again = nacre::session_text(session);
    if (nacre::session_text(nacre::parse_session(again)) != again) __builtin_trap();
    for (const nacre::SessionEvent& event : session.events) nacre::apply_event(event, session);
  });
  return 0;
}
