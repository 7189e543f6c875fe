// Nacre: fuzz target: lists of files: ParaView's .pvd and .series.
#include "engine/io/file_steps.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_file(data, size, NACRE_FUZZ_EXTENSION, 400, std::size_t(48) << 20,
                            [](const std::filesystem::path& file) { nacre::find_steps(file); });
  return 0;
}
