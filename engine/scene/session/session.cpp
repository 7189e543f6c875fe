// Nacre: reading and writing of session files.
#include "engine/scene/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/scene/session/camera_json.hpp"
#include "engine/scene/session/compared.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using std::filesystem::path;

constexpr const char* format_name = "session 1";

path beside(const path& folder, const path& file) { return file.is_absolute() ? file : folder / file; }

/// The value of the knob "camera", which may name a file.
std::string camera_beside(const path& folder, const std::string& camera) {
  return is_camera_file(camera) ? beside(folder, camera).string() : camera;
}

/// Settings that name files, with whole names.
void find_files_beside(const path& folder, Settings& settings) {
  settings.camera = camera_beside(folder, settings.camera);
  settings.view.compare = compare_beside(folder, settings.view.compare);
  for (std::string* file : {&settings.materials.names, &settings.materials.size_image})
    if (!file->empty()) *file = beside(folder, *file).string();
}

/// Only names that a session knows: a misspelt one would be left out in silence.
void check_names(const json& object, std::initializer_list<const char*> names, const char* what) {
  if (!object.is_object()) throw Error(fmt::format("{} is not a JSON object", what));
  for (const auto& [name, value] : object.items())
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw Error(fmt::format("'{}' is not valid in {}", name, what), "",
                  fmt::format("use {}", fmt::join(names, ", ")));
}

int whole_number(const json& from, const char* name, int otherwise) {
  if (!from.contains(name)) return otherwise;
  const json& value = from[name];
  if (!value.is_number_integer() || !(value.get<double>() >= 0 && value.get<double>() <= 1e9))
    throw Error(fmt::format("'{}' takes a whole number, not {}", name, value.dump()));
  return value.get<int>();
}

double seconds(const json& from, const char* name) {
  const double value = from.value(name, 0.0);
  if (!(value >= 0 && value <= longest_session))
    throw Error(fmt::format("'{}' {} is out of range", name, value), "",
                fmt::format("use 0..{} seconds", longest_session));
  return value;
}

SessionInput read_input(const json& from, const path& folder) {
  SessionInput input;
  for (const auto& file : from.value("inputs", json::array()))
    input.inputs.push_back(beside(folder, file.get<std::string>()));
  input.sample = from.value("sample", "");
  input.detail = whole_number(from, "detail", 0);
  if (!input.inputs.empty() && !input.sample.empty())
    throw Error("there are inputs and a sample", "", "use one of them");
  return input;
}

Camera read_camera(const json& from) {
  check_names(from, {"eye", "target", "up", "height", "orthographic"}, "a camera");
  return camera_of(from);
}

/// Values as text, each checked against the table; names and values are written as the table writes them.
std::map<std::string, std::string> read_knobs(const json& from, const path& folder) {
  Settings settings;
  set_knobs(settings, from);
  find_files_beside(folder, settings);
  std::map<std::string, std::string> texts;
  const std::vector<Knob> table = knobs(settings);
  for (const auto& item : from.items()) {
    const std::string name = snake_case(item.key());
    const auto knob = std::find_if(table.begin(), table.end(), [&](const Knob& each) { return each.is_named(name); });
    texts[knob->name] = knob->text();
  }
  return texts;
}

Screenshot read_screenshot(const json& from, const path& folder) {
  check_names(from, {"file", "scale", "panel", "transparent"}, "a screenshot");
  Screenshot shot;
  shot.file = beside(folder, from.at("file").get<std::string>());
  shot.scale = whole_number(from, "scale", 1);
  shot.panel = from.value("panel", false);
  shot.transparent = from.value("transparent", false);
  if (shot.scale < 1 || shot.scale > 4) throw Error("the scale of a screenshot is out of range", "", "use 1..4");
  return shot;
}

SessionEvent read_event(const json& from, const path& folder) {
  check_names(from, {"time", "inputs", "sample", "detail", "knobs", "camera", "over", "screenshot"}, "an event");
  SessionEvent event;
  if (!from.contains("time")) throw Error("an event has no time");
  event.time = seconds(from, "time");
  if (from.contains("inputs") || from.contains("sample") || from.contains("detail")) {
    event.input = read_input(from, folder);
    if (event.input->inputs.empty() && event.input->sample.empty())
      throw Error("an event opens nothing", "", "give it inputs or a sample");
  }
  if (from.contains("knobs")) event.knobs = read_knobs(from["knobs"], folder);
  if (from.contains("camera")) event.camera = read_camera(from["camera"]);
  event.over = seconds(from, "over");
  if (event.over > 0 && !event.camera) throw Error("'over' is how long a camera takes", "the event has no camera");
  if (from.contains("screenshot")) event.screenshot = read_screenshot(from["screenshot"], folder);
  return event;
}

std::vector<SessionEvent> read_events(const json& from, const path& folder) {
  std::vector<SessionEvent> events;
  if (!from.is_array()) throw Error("'events' is not a JSON array");
  for (const json& event : from) try {
      events.push_back(read_event(event, folder));
    } catch (const json::exception& error) {
      throw Error(fmt::format("event {}: {}", events.size() + 1, error.what()));
    } catch (const Error& error) {
      throw Error(fmt::format("event {}: {}", events.size() + 1, error.what()));
    }
  std::stable_sort(events.begin(), events.end(),
                   [](const SessionEvent& a, const SessionEvent& b) { return a.time < b.time; });
  return events;
}

Session read_json(const json& from, const path& folder) {
  check_names(from, {"nacre", "inputs", "sample", "detail", "knobs", "camera", "events", "duration"}, "a session");
  if (from.value("nacre", format_name) != format_name)
    throw Error(fmt::format("it is {}", from["nacre"].dump()), "",
                fmt::format("this version reads \"{}\"", format_name));
  Session session;
  static_cast<SessionInput&>(session) = read_input(from, folder);
  if (from.contains("knobs")) set_knobs(session.settings, from["knobs"]);
  find_files_beside(folder, session.settings);
  if (from.contains("camera")) session.camera = read_camera(from["camera"]);
  if (from.contains("events")) session.events = read_events(from["events"], folder);
  session.duration = seconds(from, "duration");
  for (const SessionEvent& e : session.events) session.duration = std::max(session.duration, e.time + e.over);
  return session;
}

void write_input(const SessionInput& input, json& to) {
  to["inputs"] = json::array();
  for (const path& file : input.inputs) to["inputs"].push_back(std::filesystem::absolute(file).string());
  if (!input.sample.empty()) to["sample"] = input.sample;
  if (input.detail != 0) to["detail"] = input.detail;
}

/// All values, with the whole name of a camera's file.
json whole_knobs(Settings settings) {
  find_files_beside(std::filesystem::current_path(), settings);
  return knob_values(settings);
}

json event_json(const SessionEvent& event) {
  json to = json::object();
  to["time"] = event.time;
  if (event.input) write_input(*event.input, to);
  if (!event.knobs.empty()) {
    Settings settings;
    for (const auto& [name, text] : event.knobs) set_knob(settings, name, text);
    const json values = whole_knobs(settings);  // with their types
    for (const auto& [name, text] : event.knobs) to["knobs"][name] = values.at(name);
  }
  if (event.camera) to["camera"] = camera_json(*event.camera);
  if (event.over > 0) to["over"] = event.over;
  if (event.screenshot)
    to["screenshot"] = {{"file", std::filesystem::absolute(event.screenshot->file).string()},
                        {"scale", event.screenshot->scale},
                        {"panel", event.screenshot->panel},
                        {"transparent", event.screenshot->transparent}};
  return to;
}

}  // namespace

Session read_session(const path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw Error("cannot read session " + file.string(), "no such file or no permission");
  try {
    return read_json(json::parse(stream), file.parent_path());
  } catch (const json::exception& error) {
    throw Error(file.string() + " is not a session", error.what());
  } catch (const Error& error) {
    throw Error(file.string() + " is not a session", error.what());
  }
}

Session parse_session(const std::string& text) {
  try {
    return read_json(json::parse(text), std::filesystem::current_path());
  } catch (const json::exception& error) {
    throw Error("this is not a session", error.what());
  }
}

std::string session_text(const Session& session) {
  json to = json::object();
  to["nacre"] = format_name;
  write_input(session, to);
  to["knobs"] = whole_knobs(session.settings);
  if (session.camera) to["camera"] = camera_json(*session.camera);
  if (!session.events.empty()) to["events"] = json::array();
  for (const SessionEvent& event : session.events) to["events"].push_back(event_json(event));
  if (session.duration > 0) to["duration"] = session.duration;
  try {
    return to.dump(2) + "\n";
  } catch (const json::type_error&) {
    throw Error("a session cannot hold these names", "the name of a file or an array is not UTF-8", "rename it");
  }
}

std::optional<SessionEvent> session_change(const Session& before, const Session& after) {
  SessionEvent event;
  bool changed = false;
  if (static_cast<const SessionInput&>(before) != after) event.input = after, changed = true;
  Settings was = before.settings, is = after.settings;
  const std::vector<Knob> old = knobs(was), now = knobs(is);
  for (std::size_t k = 0; k < now.size(); ++k)
    if (old[k].text() != now[k].text()) event.knobs[now[k].name] = now[k].text(), changed = true;
  if (after.camera && after.camera != before.camera) event.camera = after.camera, changed = true;
  return changed ? std::optional(event) : std::nullopt;
}

bool fits_camera(const SessionEvent& event) { return !event.camera && (event.input || event.knobs.contains("camera")); }

void apply_event(const SessionEvent& event, Session& session) {
  if (event.input) static_cast<SessionInput&>(session) = *event.input;
  for (const auto& [name, text] : event.knobs) set_knob(session.settings, name, text);
  if (event.camera || fits_camera(event)) session.camera = event.camera;
}

}  // namespace nacre
