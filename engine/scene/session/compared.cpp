// Nacre: the second view of a session.
#include "engine/scene/session/compared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "compute/device/error.hpp"
#include "engine/scene/session/window_knobs.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

constexpr std::string_view sample_prefix = "sample:";

/// Beside those of the window.
constexpr const char* shared_knobs[] = {"compare", "compare_knobs", "camera",    "orbit",    "ruler",
                                        "notes",   "play",          "loop",      "begin_at", "samples",
                                        "layout",  "crosshair",     "background"};

template <class Take>
void split(std::string_view text, char separator, const Take& take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (end > 0) take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

SessionInput sample_input(std::string_view name) {
  SessionInput input;
  const std::size_t colon = name.find(':');
  input.sample = name.substr(0, colon);
  if (colon == std::string_view::npos) return input;
  const std::string_view detail = name.substr(colon + 1);
  const auto [end, error] = std::from_chars(detail.data(), detail.data() + detail.size(), input.detail);
  if (error != std::errc() || end != detail.data() + detail.size() || input.detail < 0)
    throw Error(fmt::format("compare: '{}' is no detail of a sample", detail), "", "use sample:NAME:CELLS");
  return input;
}

std::string input_name(const SessionInput& input) {
  if (!input.sample.empty()) return input.sample;
  return input.inputs.empty() ? "" : input.inputs.front().filename().string();
}

/// Knobs that differ, with the values that `settings` has.
std::string heading(const Session& session, const SessionInput& input, Settings settings) {
  std::string line = session.settings.view.compare == compare_same ? "" : input_name(input);
  const std::map<std::string, std::string> differ = parse_compare_knobs(session.settings.view.compare_knobs);
  for (const Knob& knob : knobs(settings))
    if (differ.contains(knob.name)) line += fmt::format("{}{} = {}", line.empty() ? "" : ",  ", knob.name, knob.text());
  return line;
}

}  // namespace

bool can_differ(const std::string& knob) {
  return !is_window_knob(knob) &&
         std::find(std::begin(shared_knobs), std::end(shared_knobs), knob) == std::end(shared_knobs);
}

SessionInput compared_input(const Session& session) {
  const std::string& text = session.settings.view.compare;
  if (text == compare_same) return session;
  if (text.starts_with(sample_prefix)) return sample_input(std::string_view(text).substr(sample_prefix.size()));
  SessionInput input;
  split(text, ';', [&](std::string_view file) { input.inputs.emplace_back(file); });
  return input;
}

std::string compare_text(const SessionInput& input) {
  if (!input.sample.empty())
    return fmt::format("{}{}{}", sample_prefix, input.sample, input.detail > 0 ? fmt::format(":{}", input.detail) : "");
  std::string text;
  for (const std::filesystem::path& file : input.inputs) text += (text.empty() ? "" : ";") + file.string();
  return text;
}

std::string compare_beside(const std::filesystem::path& folder, const std::string& compare) {
  if (compare.empty() || compare == compare_same || compare.starts_with(sample_prefix)) return compare;
  Session named;
  named.settings.view.compare = compare;
  SessionInput input = compared_input(named);
  for (std::filesystem::path& file : input.inputs) file = folder / file;  // a whole name stays
  return compare_text(input);
}

std::map<std::string, std::string> parse_compare_knobs(const std::string& text) {
  std::map<std::string, std::string> differ;
  Settings checked;
  const std::vector<Knob> table = knobs(checked);
  split(text, ';', [&](std::string_view part) {
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw Error(fmt::format("compare_knobs: '{}' is no knob with a value", part), "", "use name=value;name=value");
    const std::string name = snake_case(std::string(part.substr(0, equals)));
    if (!can_differ(name)) throw Error(fmt::format("compare_knobs: both views have the same {}", name));
    set_knob(checked, name, std::string(part.substr(equals + 1)));
    const auto knob = std::find_if(table.begin(), table.end(), [&](const Knob& each) { return each.is_named(name); });
    differ[knob->name] = knob->text();
  });
  return differ;
}

std::string compare_knobs_text(const std::map<std::string, std::string>& knobs) {
  std::string text;
  for (const auto& [name, value] : knobs) text += fmt::format("{}{}={}", text.empty() ? "" : ";", name, value);
  return text;
}

Session compared_session(const Session& session) {
  Session second = session;
  static_cast<SessionInput&>(second) = compared_input(session);
  for (const auto& [name, value] : parse_compare_knobs(session.settings.view.compare_knobs))
    set_knob(second.settings, name, value);
  second.settings.view.compare.clear();
  second.settings.view.compare_knobs.clear();
  second.events.clear();
  second.duration = 0;
  return second;
}

void swap_compared(Session& session) {
  const Session second = compared_session(session);
  std::map<std::string, std::string> differ = parse_compare_knobs(session.settings.view.compare_knobs);
  Settings first = session.settings, other = second.settings;
  for (const Knob& knob : knobs(first))
    if (const auto at = differ.find(knob.name); at != differ.end()) at->second = knob.text();
  for (const Knob& knob : knobs(other))
    if (differ.contains(knob.name)) set_knob(session.settings, knob.name, knob.text());
  ViewSettings& view = session.settings.view;
  view.compare_knobs = compare_knobs_text(differ);
  if (view.compare != compare_same) {
    view.compare = compare_text(session);
    static_cast<SessionInput&>(session) = second;
  }
}

std::string first_heading(const Session& session) { return heading(session, session, session.settings); }

std::string second_heading(const Session& session) {
  const Session second = compared_session(session);
  return heading(session, second, second.settings);
}

}  // namespace nacre
