// Nacre: the files that a NRRD header names.
#include "engine/io/nrrd_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <string>
#include <string_view>

#include "engine/io/file_bytes.hpp"
#include "engine/io/text_cursor.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_line = 1 << 16;
constexpr std::size_t longest_header = 1 << 22;
constexpr std::size_t most_files = 100000;
/// Teem 1.11 puts lines, values and paths into messages of a fixed size, about a thousand characters, without looking.
constexpr std::size_t longest_in_message = 600;

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

/// One line without its end. False at the end of the file. Throws Error if the text cannot be a header.
bool next_line(std::ifstream& file, std::string& line, std::size_t& read, const fs::path& path) {
  line.clear();
  for (int c = file.get(); c != EOF; c = file.get()) {
    if (++read > longest_header || line.size() > longest_line)
      fail_reading(path, "its header does not end", "check that it is a NRRD file");
    if (c == '\n') return true;
    line += char(c);
  }
  return !line.empty();
}

/// Keys with values and comments may be long: teem has no message with them.
void require_printable(const std::string& line, int number, const fs::path& path) {
  const std::size_t colon = line.find(':');
  const bool is_key = colon != line.npos && line.compare(colon, 2, ":=") == 0;
  if (line.size() > longest_in_message && !is_key && !line.starts_with('#'))
    fail_reading(path, fmt::format("line {} of its header has {} characters", number, line.size()),
                 fmt::format("write at most {}", longest_in_message));
}

void require_short_path(const fs::path& file, const fs::path& path) {
  if (file.native().size() > longest_in_message)
    fail_reading(path, fmt::format("a path of {} characters is too long for NRRD files", file.native().size()),
                 "move them to a folder with a shorter path");
}

/// The text after "data file:", if this line is that field.
bool data_file_field(const std::string& line, std::string& value) {
  for (const std::string_view name : {"data file:", "datafile:"}) {
    if (line.size() < name.size()) continue;
    const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == b; };
    if (!std::equal(line.begin(), line.begin() + std::ptrdiff_t(name.size()), name.begin(), same)) continue;
    value = trimmed(std::string_view(line).substr(name.size()));
    return true;
  }
  return false;
}

/// "slice%03d.raw 1 20 1 [dimension]": the names that this makes; empty if it is not such a pattern.
std::vector<std::string> names_of_pattern(const std::string& field, const fs::path& path) {
  const std::size_t percent = field.find('%');
  if (percent == field.npos) return {};
  std::size_t end = percent + 1;
  while (end < field.size() && std::isdigit(static_cast<unsigned char>(field[end]))) ++end;
  const std::size_t name_end = std::min(field.find_first_of(" \t", end), field.size());
  std::array<std::int64_t, 3> range{};
  TextCursor text(std::string_view(field).substr(name_end));
  for (std::int64_t& value : range)
    if (!text.integer(value)) return {};  // an ordinary file whose name has a percent sign
  int width = 0;
  std::from_chars(field.data() + percent + 1, field.data() + end, width);
  const bool sane = end < field.size() && field[end] == 'd' && field.find('%', end) == field.npos && width <= 20;
  const std::int64_t step = range[2];
  const bool ends = step != 0 && std::max(std::abs(range[0]), std::abs(range[1])) < 1 << 30 &&
                    (range[1] - range[0]) / step >= 0 && std::size_t((range[1] - range[0]) / step) < most_files;
  if (!sane || !ends)
    fail_reading(path, fmt::format("its pattern of data files '{}' is not valid", field.substr(0, 80)));
  const std::string before = field.substr(0, percent), after = field.substr(end + 1, name_end - end - 1);
  const bool zeros = end > percent + 1 && field[percent + 1] == '0';
  std::vector<std::string> names;
  for (std::int64_t i = range[0]; step > 0 ? i <= range[1] : i >= range[1]; i += step)
    names.push_back(before + (zeros ? fmt::format("{:0{}}", i, width) : fmt::format("{:{}}", i, width)) + after);
  return names;
}

std::vector<std::string> listed_names(std::ifstream& file, std::size_t& read, const fs::path& path) {
  std::vector<std::string> names;
  for (std::string line; next_line(file, line, read, path);) {
    std::string name = trimmed(line);
    if (name.empty()) continue;
    names.push_back(std::move(name));
    if (names.size() > most_files) fail_reading(path, "it names too many data files");
  }
  return names;
}

void add_file(NrrdStorage& storage, const std::string& name, const fs::path& path) {
  const fs::path file = fs::path(name).is_absolute() ? fs::path(name) : path.parent_path() / name;
  std::error_code code;
  if (name == "-" || !fs::is_regular_file(file, code))
    fail_reading(path, fmt::format("its data file {} is missing", name), "put it beside the header");
  require_short_path(file, path);
  storage.bytes += fs::file_size(file, code);
  storage.files.push_back(file);
}

}  // namespace

NrrdStorage look_into_nrrd(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t read = 0;
  if (!file) fail_reading(path, "access was denied", "check the file's permissions");
  if (!next_line(file, line, read, path)) fail_reading(path, "it is empty", "check how it was written");
  if (!line.starts_with("NRRD000")) fail_reading(path, "it does not begin with NRRD", "check that it is a NRRD file");
  require_short_path(path, path);
  require_printable(line, 1, path);
  NrrdStorage storage;
  for (int number = 2; next_line(file, line, read, path) && !trimmed(line).empty(); ++number) {
    require_printable(line, number, path);
    std::string value;
    if (!data_file_field(line, value)) continue;
    std::vector<std::string> names;
    if (value.starts_with("LIST") || value.starts_with("SKIPLIST")) {
      if (value.starts_with("SKIPLIST")) fail_reading(path, "it skips bytes in each data file", "write it as one file");
      names = listed_names(file, read, path);
    } else {
      names = names_of_pattern(value, path);
      if (names.empty()) names = {value};
    }
    for (const std::string& name : names) add_file(storage, name, path);
  }
  std::error_code code;
  storage.header_bytes = read;
  if (storage.files.empty())
    storage.bytes = fs::file_size(path, code) - std::min<std::uintmax_t>(read, fs::file_size(path, code));
  return storage;
}

}  // namespace nacre
