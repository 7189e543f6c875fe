// Nacre: what the targets of libFuzzer share: a file of the given bytes, and a bound on what reading it may allocate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace nacre::fuzz {

/// Calls `read` with a file that holds the bytes and has this extension; it lies in memory. An Error that it throws is
/// the right answer to bytes that are no such file; any other exception is a fault, as is more memory in use at once
/// than `fixed` bytes and 4 times `honest` bytes for each byte of the file: what it may become when it is unpacked or
/// when its text becomes numbers.
void read_as_file(const std::uint8_t* data, std::size_t size, const std::string& extension, double honest,
                  std::size_t fixed, const std::function<void(const std::filesystem::path&)>& read);

/// The same without a file, for options.
void read_as_text(const std::uint8_t* data, std::size_t size, const std::function<void(const std::string&)>& read);

}  // namespace nacre::fuzz
