// Nacre: parses the header of a PLY file.
#include "engine/io/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "engine/io/file_bytes.hpp"

namespace nacre {
namespace {

PlyType type_named(std::string_view name) {
  static constexpr std::pair<std::string_view, PlyType> names[] = {
      {"char", PlyType::int8},      {"uchar", PlyType::uint8},    {"short", PlyType::int16},
      {"ushort", PlyType::uint16},  {"int", PlyType::int32},      {"uint", PlyType::uint32},
      {"float", PlyType::float32},  {"double", PlyType::float64}, {"int8", PlyType::int8},
      {"uint8", PlyType::uint8},    {"int16", PlyType::int16},    {"uint16", PlyType::uint16},
      {"int32", PlyType::int32},    {"uint32", PlyType::uint32},  {"float32", PlyType::float32},
      {"float64", PlyType::float64}};
  for (const auto& [word, type] : names)
    if (word == name) return type;
  return PlyType::none;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t"); at != line.npos; at = line.find_first_not_of(" \t", at)) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Splits header lines, which end in \n, \r\n or \r; the data begin right after the last one.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view bytes) : bytes_(bytes) {}

  bool next(std::string_view& line) {
    if (at_ >= bytes_.size()) return false;
    const std::size_t end = bytes_.find_first_of("\r\n", at_);
    if (end == bytes_.npos) {
      line = bytes_.substr(at_);
      at_ = bytes_.size();
      return true;
    }
    line = bytes_.substr(at_, end - at_);
    const bool two_characters = bytes_.substr(end, 2) == "\r\n";
    if (first_) lone_returns_ = bytes_[end] == '\r' && !two_characters;
    first_ = false;
    at_ = end + (two_characters && !lone_returns_ ? 2 : 1);
    return true;
  }

  std::size_t at() const { return at_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool first_ = true, lone_returns_ = false;
};

PlyHeader::Encoding encoding_named(std::string_view name, const std::filesystem::path& path) {
  if (name == "ascii") return PlyHeader::Encoding::ascii;
  if (name == "binary_little_endian") return PlyHeader::Encoding::little;
  if (name == "binary_big_endian") return PlyHeader::Encoding::big;
  fail_reading(path, fmt::format("its PLY format '{}' is unknown", name));
}

void add_element(PlyHeader& header, const std::vector<std::string_view>& words, const std::filesystem::path& path) {
  PlyElement element;
  const auto end = words.size() < 3 ? nullptr : words[2].data() + words[2].size();
  const auto is_count = [&] {
    const auto [last, code] = std::from_chars(words[2].data(), end, element.count);
    return code == std::errc{} && last == end;
  };
  if (words.size() < 3 || !is_count()) fail_reading(path, "an element of its header has no count");
  element.name = words[1];
  header.elements.push_back(std::move(element));
}

void add_property(PlyHeader& header, const std::vector<std::string_view>& words, const std::filesystem::path& path) {
  PlyProperty property;
  const bool list = words.size() >= 5 && words[1] == "list";
  if (list) property.count_type = type_named(words[2]);
  if (words.size() >= 3) property.type = type_named(words[list ? 3 : 1]);
  if (header.elements.empty() || property.type == PlyType::none || (list && property.count_type == PlyType::none) ||
      ply_is_real(property.count_type))
    fail_reading(path, fmt::format("property '{}' of its header is damaged", words.back()));
  property.name = words[list ? 4 : 2];
  header.elements.back().properties.push_back(std::move(property));
}

}  // namespace

std::size_t ply_size(PlyType type) {
  static constexpr std::size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

int PlyElement::find(std::string_view wanted) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == wanted) return int(i);
  return -1;
}

PlyHeader read_ply_header(std::string_view bytes, const std::filesystem::path& path) {
  PlyHeader header;
  HeaderLines lines(bytes);
  std::string_view line;
  if (!lines.next(line) || words_of(line) != std::vector<std::string_view>{"ply"})
    fail_reading(path, "it does not begin with 'ply'", "check that it is a PLY file");
  bool has_format = false;
  while (lines.next(line)) {
    const auto words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == "end_header") {
      if (!has_format) fail_reading(path, "its PLY header names no format");
      header.body = lines.at();
      return header;
    }
    if (words[0] == "format" && words.size() >= 2) {
      header.encoding = encoding_named(words[1], path);
      has_format = true;
    } else if (words[0] == "element") {
      add_element(header, words, path);
    } else if (words[0] == "property") {
      add_property(header, words, path);
    }  // comment, obj_info and other lines that some programs write there
  }
  fail_reading(path, "its PLY header does not end");
}

}  // namespace nacre
