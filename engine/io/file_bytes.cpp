// Nacre: reads whole files; unpacks gzip.
#include "engine/io/file_bytes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "compute/device/error.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

// Text shrinks to a tenth, a smooth volume to a hundredth. A ratio far beyond this is a mistake or an attack.
constexpr std::size_t unpacked_base = std::size_t(16) << 20;

std::string gunzip(const std::string& packed, std::size_t unpacked_ratio, const fs::path& path) {
  const std::size_t limit = unpacked_base + unpacked_ratio * packed.size();
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) fail_reading(path, "zlib could not start");
  struct End {
    z_stream* stream;
    ~End() { inflateEnd(stream); }
  } end{&stream};
  std::string out;
  std::size_t used = 0, filled = 0;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    const std::size_t chunk_in = std::min<std::size_t>(packed.size() - used, 1u << 30);
    if (filled == out.size()) out.resize(std::min(limit + 1, std::max<std::size_t>(1 << 20, out.size() * 2)));
    const std::size_t chunk_out = std::min<std::size_t>(out.size() - filled, 1u << 30);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
    stream.avail_in = uInt(chunk_in);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + filled);
    stream.avail_out = uInt(chunk_out);
    state = inflate(&stream, Z_NO_FLUSH);
    used += chunk_in - stream.avail_in;
    filled += chunk_out - stream.avail_out;
    if (filled > limit)
      fail_reading(path, fmt::format("it expands to more than {} times its size", unpacked_ratio),
                   "decompress it by hand");
    if (state == Z_BUF_ERROR && used == packed.size()) fail_reading(path, "its gzip data ends too early");
    if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR) fail_reading(path, "its gzip data is damaged");
    // A gzip file may consist of several members, one after the other.
    if (state == Z_STREAM_END && used + 18 < packed.size() && packed.compare(used, 2, "\x1f\x8b") == 0) {
      inflateReset(&stream);
      state = Z_OK;
    }
  }
  out.resize(filled);
  return out;
}

void reject_utf16(const std::string& bytes, const fs::path& path) {
  const bool little = bytes.compare(0, 2, "\xff\xfe") == 0, big = bytes.compare(0, 2, "\xfe\xff") == 0;
  if (little || big) fail_reading(path, "it is UTF-16 text", "save it as UTF-8 or plain ASCII");
}

}  // namespace

void fail_reading(const fs::path& path, const std::string& why, const std::string& advice) {
  throw Error(path.string() + " cannot be read", why, advice);
}

void require_file(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found)
    throw Error(path.string() + " cannot be opened", "there is no such file", "check the name");
  if (status.type() == fs::file_type::directory)
    throw Error(path.string() + " cannot be opened", "it is a folder", "name a file in it");
  if (status.type() != fs::file_type::regular)
    throw Error(path.string() + " cannot be opened", code ? code.message() : "it is not a regular file", "name a file");
}

std::string read_file(const fs::path& path, std::size_t unpacked_ratio) {
  require_file(path);
  std::ifstream file(path, std::ios::binary);
  std::error_code code;
  const std::uintmax_t size = fs::file_size(path, code);
  if (!file || code)
    throw Error(path.string() + " cannot be opened", "access was denied", "check the file's permissions");
  if (size == 0) fail_reading(path, "it is empty", "check how it was written");
  std::string bytes(size, '\0');
  file.read(bytes.data(), std::streamsize(size));
  bytes.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  if (bytes.size() != size) fail_reading(path, "reading stopped before the end of the file");
  if (bytes.compare(0, 2, "\x1f\x8b") == 0) bytes = gunzip(bytes, unpacked_ratio, path);
  if (bytes.empty()) fail_reading(path, "its compressed content is empty", "check how it was written");
  reject_utf16(bytes, path);
  if (bytes.compare(0, 3, "\xef\xbb\xbf") == 0) bytes.erase(0, 3);
  return bytes;
}

bool begins_as_gzip(const fs::path& path, std::size_t offset) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(std::streamoff(offset));
  return file.get() == 0x1f && file.get() == 0x8b;
}

std::string format_extension(const fs::path& path) {
  std::string extension = lower_extension(path);
  if (extension == ".gz") extension = lower_extension(path.stem());
  return extension.substr(std::min<std::size_t>(extension.size(), 1));
}

}  // namespace nacre
