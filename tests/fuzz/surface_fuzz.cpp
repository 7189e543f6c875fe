// Nacre: fuzz target: the readers of surfaces, each under its extension.
#include "engine/io/reader.hpp"
#include "engine/io/registry.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A packed byte becomes up to 200; two characters of text become a number of 8 bytes in a few arrays.
  constexpr std::size_t fixed = std::size_t(48) << 20;
  nacre::fuzz::read_as_file(data, size, NACRE_FUZZ_EXTENSION, 400, fixed, [](const std::filesystem::path& file) {
    nacre::describe(file);
    nacre::open_surface({file}).load(0);
  });
  return 0;
}
