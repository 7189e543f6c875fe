// Nacre: names and colours of labels, if the file of a volume has them.
#include "engine/io/label_names.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <pugixml.hpp>
#include <vector>

#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/system/utf8.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_names = 65536, longest_name = 120;

/// The name as one line that a table can show.
std::string in_one_line(std::string_view text) {
  std::string line = in_utf8(text, longest_name);
  while (!line.empty() && line.back() == ' ') line.pop_back();
  line.erase(0, std::min(line.find_first_not_of(' '), line.size()));
  return line;
}

/// Stores a name; of two names for one label, the first is kept. False where `number` is no label.
bool keep(LabelNames& names, std::string_view number, std::string_view text) {
  std::int64_t label = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), label);
  if (error != std::errc() || end != number.data() + number.size()) return false;
  std::string name = in_one_line(text);
  if (!name.empty() && names.size() < most_names) names.try_emplace(label, std::move(name));
  return true;
}

/// Stores a colour, 0..1; of two for one label, the first is kept.
void keep(LabelColours& colours, std::string_view number, const std::array<double, 3>& colour) {
  std::int64_t label = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), label);
  if (error != std::errc() || end != number.data() + number.size() || colours.size() >= most_names) return;
  for (const double c : colour)
    if (!(c >= 0 && c <= 1)) return;
  colours.try_emplace(label, std::array{float(colour[0]), float(colour[1]), float(colour[2])});
}

/// Takes numbers and names from bytes; after the end, or after a length that cannot be, `good` is false.
class TableBytes {
 public:
  explicit TableBytes(std::string_view bytes) : bytes_(bytes) {}

  bool good = true;

  std::int32_t number() {
    const std::string_view four = take(4);
    return good ? load_number<std::int32_t>(four.data(), std::endian::big) : 0;
  }
  std::string_view text() {
    const std::int32_t length = number();
    good = good && length >= 0;
    const std::string_view text = take(good ? std::size_t(length) : 0);
    return text.substr(0, text.find('\0'));
  }

 private:
  std::string_view take(std::size_t size) {
    good = good && size <= bytes_.size();
    if (!good) return {};
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::string_view bytes_;
};

bool is_number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

double number_in(std::string_view word) {
  double value = -1;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

std::vector<std::string_view> words_of_line(std::string_view line) {
  constexpr std::string_view blank = " \t\r,;";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(blank); at != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(blank, end);
  }
  return words;
}

/// The text in quotes, otherwise everything between the number and the three or more numbers of a colour. Empty if
/// there is no name.
std::string_view name_in_line(std::string_view line, const std::vector<std::string_view>& words) {
  const std::size_t quote = line.find('"'), last_quote = line.rfind('"');
  if (quote != last_quote) return line.substr(quote + 1, last_quote - quote - 1);
  std::size_t last = words.size();
  while (last > 1 && is_number(words[last - 1])) --last;
  if (words.size() - last < 3) last = words.size();
  if (last < 2) return {};
  const char* end = words[last - 1].data() + words[last - 1].size();
  return {words[1].data(), std::size_t(end - words[1].data())};
}

/// Three bytes: behind the number where the name stands in quotes, otherwise behind the name.
std::optional<std::array<double, 3>> colour_in_line(std::string_view line, const std::vector<std::string_view>& words) {
  std::size_t first = 1;
  if (line.find('"') == line.npos) {
    first = words.size();
    while (first > 1 && is_number(words[first - 1])) --first;
    if (words.size() - first > 4) first = words.size() - 4;  // the name ends with a number
  }
  if (first + 3 > words.size()) return {};
  std::array<double, 3> colour;
  for (std::size_t k = 0; k < 3; ++k) colour[k] = number_in(words[first + k]) / 255;
  return colour;
}

}  // namespace

LabelTable label_table_in_bytes(std::string_view bytes) {
  TableBytes table(bytes);
  LabelTable labels;
  const std::int32_t head = table.number();
  const bool numbered = head < 0;
  if (numbered) {
    if (head != -2) return {};
    table.number();  // one more than the highest label
  }
  table.text();  // the file that it came from
  const std::int32_t entries = numbered ? table.number() : head;
  for (std::int32_t i = 0; i < entries && table.good; ++i) {
    const std::int32_t label = numbered ? table.number() : i;
    const std::string_view name = table.text();
    std::array<double, 3> colour;
    for (double& c : colour) c = table.number() / 255.0;
    table.number();  // transparency
    if (!table.good) break;
    keep(labels.names, std::to_string(label), name);
    keep(labels.colours, std::to_string(label), colour);
  }
  return table.good ? labels : LabelTable{};
}

LabelNames read_label_names(const std::filesystem::path& path) { return read_label_table(path).names; }

LabelTable read_label_table(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  LabelTable labels;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++number;
    const std::vector<std::string_view> words = words_of_line(line);
    if (words.empty() || words[0][0] == '#') continue;
    const std::string_view name = name_in_line(line, words);
    if (name.empty() || !keep(labels.names, words[0], name))
      fail_reading(path, fmt::format("line {} is not a number and a name: '{}'", number, in_utf8(line, 60)),
                   "give a label file of ITK-SNAP, a colour table of FreeSurfer, or lines such as `5 liver`");
    if (const auto colour = colour_in_line(line, words)) keep(labels.colours, words[0], *colour);
  }
  if (labels.names.empty())
    fail_reading(path, "it names no labels",
                 "give a label file of ITK-SNAP, a colour table of FreeSurfer, or lines such as `5 liver`");
  return labels;
}

LabelTable label_table_in_xml(std::string_view xml) {
  LabelTable labels;
  const std::string_view text = xml.substr(0, xml.find('\0'));  // padded to full lines of 16 bytes
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return labels;
  const pugi::xml_node table =
      document.find_node([](const pugi::xml_node& node) { return std::string_view(node.name()) == "LabelTable"; });
  for (const pugi::xml_node& label : table.children("Label")) {
    const char* key = label.attribute("Key").value();
    keep(labels.names, key, label.child_value());
    const std::array<double, 3> colour{label.attribute("Red").as_double(-1), label.attribute("Green").as_double(-1),
                                       label.attribute("Blue").as_double(-1)};
    keep(labels.colours, key, colour);
  }
  return labels;
}

std::vector<Segment> find_segments(const std::function<std::optional<std::string>(const std::string& key)>& field) {
  std::vector<Segment> segments;
  const auto whole = [](const std::optional<std::string>& text, std::int64_t& number) {
    if (!text) return false;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), number);
    return error == std::errc() && end == text->data() + text->size();
  };
  for (std::size_t number = 0; number < most_names; ++number) {
    const std::string key = fmt::format("Segment{}_", number);
    const std::optional<std::string> name = field(key + "Name"), label = field(key + "LabelValue");
    if (!name && !label) break;
    Segment segment{in_one_line(name.value_or("")), 0, 0, {}};
    if (!whole(label, segment.label)) continue;
    whole(field(key + "Layer"), segment.layer);
    if (const std::optional<std::string> colour = field(key + "Color"))
      if (const auto words = words_of_line(*colour); words.size() >= 3) {
        LabelColours one;
        keep(one, "0", {number_in(words[0]), number_in(words[1]), number_in(words[2])});
        if (!one.empty()) segment.colour = one.at(0);
      }
    segments.push_back(std::move(segment));
  }
  return segments;
}

LabelTable table_of_segments(const std::vector<Segment>& segments, std::int64_t layer) {
  LabelTable labels;
  for (const Segment& segment : segments) {
    if (segment.layer != layer) continue;
    if (!segment.name.empty()) labels.names.try_emplace(segment.label, segment.name);
    if (segment.colour) labels.colours.try_emplace(segment.label, *segment.colour);
  }
  return labels;
}

}  // namespace nacre
