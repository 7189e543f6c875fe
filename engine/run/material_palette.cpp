// Nacre: the colours of a volume's materials.
#include "engine/run/material_palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "engine/picture/material_colours.hpp"
#include "engine/run/shown_colours.hpp"

namespace nacre {
namespace {

/// Calls take(label, text) for each "label:value" of a list.
template <class Take>
void for_labels(const std::string& list, const Take& take) {
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');) {
    const std::size_t colon = item.find(':'), begin = item.find_first_not_of(' ');
    if (colon == item.npos || begin >= colon) continue;
    std::int64_t label = 0;
    const auto [end, error] = std::from_chars(item.data() + begin, item.data() + colon, label);
    if (error == std::errc() && end == item.data() + colon) take(label, item.substr(colon + 1));
  }
}

template <class Value, class Word>
std::string list_of(const std::map<std::int64_t, Value>& values, const Word& word) {
  std::string text;
  for (const auto& [label, value] : values) text += fmt::format("{}{}:{}", text.empty() ? "" : ",", label, word(value));
  return text;
}

int byte_of(float share) { return int(std::lround(255 * std::clamp(share, 0.0f, 1.0f))); }

}  // namespace

std::map<std::int64_t, Color> parse_label_colours(const std::string& text) {
  std::map<std::int64_t, Color> colours;
  for_labels(text, [&](std::int64_t label, const std::string& word) {
    if (const auto colour = hex_colour(word)) colours[label] = *colour;
  });
  return colours;
}

std::string label_colour_text(const std::map<std::int64_t, Color>& colours) {
  return list_of(colours, [](const Color& c) {
    return fmt::format("#{:02x}{:02x}{:02x}", byte_of(c[0]), byte_of(c[1]), byte_of(c[2]));
  });
}

std::map<std::int64_t, double> parse_label_opacities(const std::string& text) {
  std::map<std::int64_t, double> opacities;
  for_labels(text, [&](std::int64_t label, const std::string& word) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc() && end == word.data() + word.size() && std::isfinite(value))
      opacities[label] = std::clamp(value, 0.0, 1.0);
  });
  return opacities;
}

std::string label_opacity_text(const std::map<std::int64_t, double>& opacities) {
  return list_of(opacities, [](double opacity) { return fmt::format("{:.2g}", opacity); });
}

std::vector<Color> material_palette(const MeshInput& input, const std::string& own) {
  const std::map<std::int64_t, Color> chosen = parse_label_colours(own);
  std::vector<Color> palette(input.labels.size(), Color{0.6f, 0.6f, 0.6f});
  for (std::size_t m = 1; m < palette.size(); ++m) {
    const auto found = chosen.find(input.labels[m]);
    if (found != chosen.end())
      palette[m] = found->second;
    else if (m < input.colours.size() && input.colours[m])
      palette[m] = *input.colours[m];
    else
      palette[m] = material_colour(int(m));
  }
  return palette;
}

}  // namespace nacre
