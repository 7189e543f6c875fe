// Nacre: names of labels, if the file of a volume has them.
#include "engine/io/label_names.hpp"

#include <fmt/format.h>

#include <charconv>
#include <pugixml.hpp>

#include "engine/system/utf8.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_names = 65536, longest_name = 120;

/// The name as one line that a table can show.
std::string in_one_line(std::string_view words) {
  std::string line = in_utf8(words, longest_name);
  while (!line.empty() && line.back() == ' ') line.pop_back();
  line.erase(0, std::min(line.find_first_not_of(' '), line.size()));
  return line;
}

/// Stores a name; of two names for one label, the first is kept.
void keep(LabelNames& names, std::string_view number, std::string_view words) {
  std::int64_t label = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), label);
  if (error != std::errc() || end != number.data() + number.size() || names.size() >= most_names) return;
  std::string name = in_one_line(words);
  if (!name.empty()) names.try_emplace(label, std::move(name));
}

}  // namespace

LabelNames names_of_label_table(std::string_view xml) {
  LabelNames names;
  const std::string_view text = xml.substr(0, xml.find('\0'));  // padded to full lines of 16 bytes
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return names;
  const pugi::xml_node table =
      document.find_node([](const pugi::xml_node& node) { return std::string_view(node.name()) == "LabelTable"; });
  for (const pugi::xml_node& label : table.children("Label"))
    keep(names, label.attribute("Key").value(), label.child_value());
  return names;
}

LabelNames names_of_segments(const std::function<std::optional<std::string>(const std::string& key)>& field) {
  LabelNames names;
  for (std::size_t segment = 0; segment < most_names; ++segment) {
    const std::optional<std::string> name = field(fmt::format("Segment{}_Name", segment));
    const std::optional<std::string> label = field(fmt::format("Segment{}_LabelValue", segment));
    if (!name && !label) break;
    if (name && label) keep(names, *label, *name);
  }
  return names;
}

}  // namespace nacre
