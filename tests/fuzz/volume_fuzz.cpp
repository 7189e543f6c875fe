// Nacre: fuzz target: the readers of volumes, each under its extension.
#include "engine/io/volume_reader.hpp"
#include "tests/fuzz/fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A packed byte becomes up to 1032; the names of labels in FreeSurfer's files may take 16 MiB.
  constexpr std::size_t fixed = std::size_t(48) << 20;
  nacre::fuzz::read_as_file(data, size, NACRE_FUZZ_EXTENSION, 1100, fixed,
                            [](const std::filesystem::path& file) { nacre::read_volume(file); });
  return 0;
}
