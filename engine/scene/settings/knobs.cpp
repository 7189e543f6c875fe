// Nacre: the knob table.
#include "engine/scene/settings/knobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/scene/settings/edit_distance.hpp"

namespace nacre {
namespace {

std::string range_of(const Knob& knob) {
  if (!knob.choices.empty()) return fmt::format("{}", fmt::join(knob.choices, "|"));
  if (std::holds_alternative<bool*>(knob.value)) return "true|false";
  if (std::holds_alternative<std::string*>(knob.value)) return "text";
  return fmt::format("{}{:.10g}..{:.10g}", knob.or_zero ? "0 or " : "", knob.min, knob.max);
}

[[noreturn]] void out_of_range(const Knob& knob, const std::string& text) {
  throw Error(fmt::format("{} {} is out of range", knob.option(), text), "", fmt::format("use {}", range_of(knob)));
}

template <class T>
T parse_number(const Knob& knob, const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) out_of_range(knob, text);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(
        fmt::format("{} takes a{} number, not '{}'", knob.option(), std::is_integral_v<T> ? " whole" : "", text));
  const bool chosen = knob.or_zero && value == T(0);
  if (!chosen && !(double(value) >= knob.min && double(value) <= knob.max)) out_of_range(knob, text);
  return value;
}

void assign(const Knob& knob, const std::string& text) {
  if (auto* p = std::get_if<int*>(&knob.value)) **p = parse_number<int>(knob, text);
  if (auto* p = std::get_if<double*>(&knob.value)) **p = parse_number<double>(knob, text);
  if (auto* p = std::get_if<std::uint32_t*>(&knob.value)) {
    **p = parse_number<std::uint32_t>(knob, text);
    if (knob.also) *knob.also = **p;
  }
  if (auto* p = std::get_if<bool*>(&knob.value)) {
    if (text != "true" && text != "false" && text != "1" && text != "0")
      throw Error(fmt::format("{} takes true or false, not '{}'", knob.option(), text));
    **p = text == "true" || text == "1";
  }
  const auto chosen = std::find(knob.choices.begin(), knob.choices.end(), text);
  if (!knob.choices.empty() && chosen == knob.choices.end())
    throw Error(fmt::format("no {} '{}'", knob.name, text), "", "use " + range_of(knob));
  if (auto* p = std::get_if<KnobChoice>(&knob.value)) p->set(p->member, int(chosen - knob.choices.begin()));
  if (auto* p = std::get_if<std::string*>(&knob.value)) **p = text;
}

std::string with_dashes(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

}  // namespace

std::string snake_case(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::string Knob::option() const { return "--" + with_dashes(name); }

std::vector<std::string> Knob::off_options() const {
  if (!std::holds_alternative<bool*>(value)) return {};
  std::vector<std::string> options;
  if (!off_option.empty()) options.push_back(off_option);
  options.push_back("--no-" + with_dashes(name));
  return options;
}

std::vector<std::string> Knob::old_options() const {
  std::vector<std::string> options;
  for (const std::string& old : old_names) options.push_back("--" + with_dashes(old));
  return options;
}

bool Knob::is_named(const std::string& wanted) const {
  return name == wanted || std::find(old_names.begin(), old_names.end(), wanted) != old_names.end();
}

bool Knob::concerns(const std::string& command) const {
  const auto in = [&](std::initializer_list<const char*> groups) {
    return std::find(groups.begin(), groups.end(), group) != groups.end();
  };
  if (in({"general"}) || command == "view") return true;
  if (command == "join") return name == "fps";  // its frames are pictures already
  if (in({"picture"})) return command == "flow" || command == "mesh";
  if (in({"labels"})) return command == "mesh" || command == "info";
  if (in({"case"})) return command == "flow" || command == "info";
  if (in({"materials", "fields", "sizing", "particles", "cells"})) return command == "mesh";
  return command == "flow" && !in({"view"});
}

std::string Knob::text() const {
  if (const auto* choice = std::get_if<KnobChoice>(&value)) return choices.at(std::size_t(choice->get(choice->member)));
  return std::visit(
      [](const auto& stored) {
        if constexpr (std::is_pointer_v<std::decay_t<decltype(stored)>>) return fmt::format("{}", *stored);
        return std::string();
      },
      value);
}

void set_knob(Settings& settings, const std::string& name, const std::string& text) {
  const std::string wanted = snake_case(name);
  const std::vector<Knob> table = knobs(settings);
  for (const Knob& knob : table)
    if (knob.is_named(wanted)) return assign(knob, text);
  const auto distance = [&](const Knob& knob) {
    std::size_t least = edit_distance(knob.name, wanted);
    for (const std::string& old : knob.old_names) least = std::min(least, std::size_t(edit_distance(old, wanted)));
    return least;
  };
  const auto nearest = std::min_element(table.begin(), table.end(),
                                        [&](const Knob& a, const Knob& b) { return distance(a) < distance(b); });
  throw Error(fmt::format("no knob '{}'", name), "",
              fmt::format("did you mean {}? `nacre --knobs` lists all", nearest->name));
}

nlohmann::json knob_values(const Settings& settings) {
  Settings copy = settings;
  nlohmann::json values = nlohmann::json::object();
  for (const Knob& knob : knobs(copy))
    std::visit(
        [&](const auto& stored) {
          if constexpr (std::is_pointer_v<std::decay_t<decltype(stored)>>)
            values[knob.name] = *stored;
          else
            values[knob.name] = knob.text();
        },
        knob.value);
  return values;
}

void set_knobs(Settings& settings, const nlohmann::json& values) {
  if (!values.is_object()) throw Error("the knobs of the session are not a JSON object");
  for (const auto& [name, value] : values.items())
    set_knob(settings, name, value.is_string() ? value.get<std::string>() : value.dump());
}

std::string knob_table() {
  Settings defaults;
  std::vector<std::array<std::string, 5>> rows{{"knob", "default", "range", "unit", ""}};
  for (const Knob& knob : knobs(defaults))
    rows.push_back({knob.name, knob.text(), range_of(knob), knob.unit, knob.help});
  std::array<std::size_t, 4> widths{};
  for (const auto& row : rows)
    for (std::size_t k = 0; k < widths.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  std::string table;
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < widths.size(); ++k) table += fmt::format("{:<{}}  ", row[k], widths[k]);
    table += row.back() + "\n";
  }
  return table;
}

}  // namespace nacre
