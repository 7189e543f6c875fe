// Nacre: a file in memory, and the error for a file that cannot be read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace nacre {

/// The whole content of a file. Gzip is unpacked (to at most `unpacked_ratio` times its size, against bombs), a UTF-8
/// byte order mark is removed. Throws Error if the file is missing, not regular, unreadable, empty, or UTF-16 text.
std::string read_file(const std::filesystem::path& path, std::size_t unpacked_ratio = 200);

/// Throws Error if there is no regular file of that name.
void require_file(const std::filesystem::path& path);

/// Lower-case extension without the dot; that of the packed file for `.gz`: "obj" for `motorBike.OBJ.gz`.
std::string format_extension(const std::filesystem::path& path);

/// Whether the file begins like one that is packed with gzip.
bool begins_as_gzip(const std::filesystem::path& path, std::size_t offset = 0);

/// Throws Error "FILE cannot be read (why); advice".
[[noreturn]] void fail_reading(const std::filesystem::path& path, const std::string& why,
                               const std::string& advice = "check that the file is complete");

}  // namespace nacre
