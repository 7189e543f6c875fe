// Nacre: fuzz target: files that name labels.
#include "engine/io/label_names.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nacre::fuzz::read_as_file(data, size, ".txt", 400, std::size_t(48) << 20,
                            [](const std::filesystem::path& file) { nacre::read_label_names(file); });
  return 0;
}
