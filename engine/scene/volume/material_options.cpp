// Nacre: the options for materials, parsed.
#include "engine/scene/volume/material_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == text.npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// `form` is what the option takes.
template <class T>
T parse(std::string_view text, const std::string& option, const std::string& whole, const char* form) {
  T value{};
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(double(value)))
    throw Error(fmt::format("{} takes {}, not '{}'", option, form, whole));
  return value;
}

template <class T>
std::pair<T, T> parse_pair(std::string_view text, const std::string& option, const std::string& whole,
                           const char* form) {
  const std::size_t at = text.find(':');
  if (at == text.npos) throw Error(fmt::format("{} takes {}, not '{}'", option, form, whole));
  return {parse<T>(text.substr(0, at), option, whole, form), parse<T>(text.substr(at + 1), option, whole, form)};
}

}  // namespace

MaterialOptions parse_material_settings(const MaterialSettings& settings) {
  if (int(settings.labels) + int(!settings.isovalue.empty()) + int(!settings.threshold.empty()) > 1)
    throw Error("--labels, --isovalue and --threshold exclude each other", "", "give one of them");
  const bool scalar = !settings.isovalue.empty() || !settings.threshold.empty();
  if (scalar && (!settings.materials.empty() || !settings.merge.empty()))
    throw Error("--materials and --merge apply to labels", "--isovalue and --threshold cut a scalar volume");
  MaterialOptions options;
  if (settings.labels) options.mode = MaterialOptions::Mode::labels;
  if (!settings.isovalue.empty()) {
    options.mode = MaterialOptions::Mode::isovalue;
    for (const std::string_view part : split(settings.isovalue, ','))
      options.isovalues.push_back(parse<double>(part, "--isovalue", settings.isovalue, "V[,V...]"));
  }
  if (!settings.threshold.empty()) {
    options.threshold = parse_pair<double>(settings.threshold, "--threshold", settings.threshold, "LO:HI");
    if (options.threshold->first > options.threshold->second)
      throw Error(fmt::format("--threshold {} ends before it starts", settings.threshold));
  }
  if (!settings.materials.empty())
    for (const std::string_view part : split(settings.materials, ','))
      options.materials.push_back(parse<std::int64_t>(part, "--materials", settings.materials, "L[,L...]"));
  if (!settings.merge.empty())
    for (const std::string_view part : split(settings.merge, ','))
      options.merge.push_back(parse_pair<std::int64_t>(part, "--merge", settings.merge, "A:B[,A:B...]"));
  options.min_component = settings.min_component;
  return options;
}

}  // namespace nacre
