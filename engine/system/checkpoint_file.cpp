// Nacre: a file that a run can go on from.
#include "engine/system/checkpoint_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

constexpr std::string_view checkpoint_magic = "Nacre checkpoint 1\n";
constexpr std::uint64_t longest_text = std::uint64_t(64) << 20;

std::uint32_t checksum(std::uint32_t before, const void* data, std::size_t bytes) {
  return std::uint32_t(crc32_z(before, static_cast<const Bytef*>(data), bytes));
}

}  // namespace

CheckpointWriter::CheckpointWriter(const std::filesystem::path& file, const std::string& text)
    : out_(file, OutputFile::Devices::refused) {
  const std::uint64_t length = text.size();
  put(std::as_bytes(std::span(checkpoint_magic)));
  put(std::as_bytes(std::span(&length, 1)));
  put(std::as_bytes(std::span(text)));
}

void CheckpointWriter::put(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;  // zlib would take a null pointer for the wish to begin
  out_.write(bytes.data(), bytes.size());
  sum_ = checksum(sum_, bytes.data(), bytes.size());
}

void CheckpointWriter::commit() {
  out_.write(&sum_, sizeof sum_);
  out_.sync();
  out_.commit();
}

CheckpointReader::CheckpointReader(const std::filesystem::path& file) : file_(file), stream_(file, std::ios::binary) {
  if (!stream_) throw Error("cannot read the checkpoint " + file.string(), std::strerror(errno));
  std::string magic(checkpoint_magic.size(), '\0');
  stream_.read(magic.data(), std::streamsize(magic.size()));
  if (!stream_ || magic != checkpoint_magic)
    throw Error(file.string() + " is no checkpoint of this version", "", "give another name, or remove the file");
  left_ = check_sum();
  std::uint64_t length = 0;
  take(std::as_writable_bytes(std::span(&length, 1)));
  if (length > std::min(left_, longest_text)) damaged("its text is too long");
  text_.resize(length);
  take(std::as_writable_bytes(std::span(text_)));
}

/// Reads the file once, and returns to behind its first line. How many bytes follow that and come before the checksum.
std::uint64_t CheckpointReader::check_sum() {
  stream_.seekg(0, std::ios::end);
  const auto size = std::uint64_t(std::max<std::streamoff>(0, stream_.tellg()));
  std::uint32_t expected = 0, sum = 0;
  if (size < checkpoint_magic.size() + sizeof expected) damaged("it ends too early");
  const std::uint64_t summed = size - sizeof expected;
  stream_.seekg(0);
  std::vector<char> piece(std::size_t(1) << 20);
  for (std::uint64_t at = 0; at < summed && stream_; at += piece.size()) {
    const auto bytes = std::size_t(std::min<std::uint64_t>(piece.size(), summed - at));
    stream_.read(piece.data(), std::streamsize(bytes));
    sum = checksum(sum, piece.data(), bytes);
  }
  stream_.read(reinterpret_cast<char*>(&expected), sizeof expected);
  if (!stream_) damaged("it cannot be read to its end");
  if (sum != expected) damaged("its checksum is wrong");
  stream_.seekg(std::streamoff(checkpoint_magic.size()));
  return summed - checkpoint_magic.size();
}

void CheckpointReader::take(std::span<std::byte> bytes) {
  if (bytes.size() > left_) damaged("it ends too early");
  stream_.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!stream_) damaged("it cannot be read to its end");
  left_ -= bytes.size();
}

void CheckpointReader::finish() const {
  if (left_ > 0) damaged("it holds more than this run keeps");
}

void CheckpointReader::damaged(const std::string& why) const {
  throw Error("the checkpoint " + file_.string() + " is damaged", why, "remove it, and the run begins anew");
}

}  // namespace nacre
