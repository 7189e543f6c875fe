// Nacre: reading and writing of session files.
#include "engine/scene/session.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/scene/camera_json.hpp"
#include "engine/scene/knobs.hpp"

namespace nacre {
namespace {

using nlohmann::json;
using std::filesystem::path;

path beside(const path& folder, const path& file) { return file.is_absolute() ? file : folder / file; }

bool has_input(const json& from) { return from.contains("inputs") || from.contains("sample"); }

SessionInput read_input(const json& from, const path& folder) {
  SessionInput input;
  for (const auto& file : from.value("inputs", json::array()))
    input.inputs.push_back(beside(folder, file.get<std::string>()));
  input.sample = from.value("sample", "");
  input.detail = from.value("detail", 0);
  if (!input.inputs.empty() && !input.sample.empty()) throw Error("a session has inputs or a sample, not both");
  if (input.detail < 0) throw Error("the detail of a sample is below zero");
  return input;
}

/// Values as text, each checked against the table.
std::map<std::string, std::string> read_knobs(const json& from) {
  Settings settings;
  set_knobs(settings, from);
  std::map<std::string, std::string> knobs;
  for (const auto& [name, value] : from.items())
    knobs[name] = value.is_string() ? value.get<std::string>() : value.dump();
  return knobs;
}

Screenshot read_screenshot(const json& from, const path& folder) {
  Screenshot shot;
  shot.file = beside(folder, from.at("file").get<std::string>());
  shot.scale = from.value("scale", 1);
  shot.panel = from.value("panel", false);
  shot.transparent = from.value("transparent", false);
  if (shot.scale < 1 || shot.scale > 4) throw Error("the scale of a screenshot is 1 to 4");
  return shot;
}

SessionEvent read_event(const json& from, const path& folder) {
  SessionEvent event;
  event.time = from.at("time").get<double>();
  if (!(event.time >= 0 && event.time < 1e6)) throw Error("the time of an event is not in 0 .. 1e6 seconds");
  if (has_input(from)) event.input = read_input(from, folder);
  if (from.contains("knobs")) event.knobs = read_knobs(from["knobs"]);
  if (from.contains("camera")) event.camera = camera_of(from["camera"]);
  event.over = from.value("over", 0.0);
  if (!(event.over >= 0 && event.over < 1e6)) throw Error("the camera of an event takes 0 .. 1e6 seconds");
  if (from.contains("screenshot")) event.screenshot = read_screenshot(from["screenshot"], folder);
  return event;
}

/// Only names that a session knows: a misspelt one would be left out in silence.
void check_names(const json& object, std::initializer_list<const char*> names) {
  for (const auto& [name, value] : object.items())
    if (std::find(names.begin(), names.end(), name) == names.end()) throw Error("'" + name + "' means nothing here");
}

Session read_json(const json& from, const path& folder) {
  if (!from.is_object()) throw Error("not a JSON object");
  check_names(from, {"nacre", "inputs", "sample", "detail", "knobs", "camera", "events", "duration"});
  Session session;
  static_cast<SessionInput&>(session) = read_input(from, folder);
  if (from.contains("knobs")) set_knobs(session.settings, from["knobs"]);
  if (from.contains("camera")) session.camera = camera_of(from["camera"]);
  for (const json& event : from.value("events", json::array())) {
    check_names(event, {"time", "inputs", "sample", "detail", "knobs", "camera", "over", "screenshot"});
    session.events.push_back(read_event(event, folder));
  }
  std::stable_sort(session.events.begin(), session.events.end(),
                   [](const SessionEvent& a, const SessionEvent& b) { return a.time < b.time; });
  session.duration = from.value("duration", 0.0);
  for (const SessionEvent& e : session.events)
    session.duration = std::max(session.duration, e.time + (e.camera ? e.over : 0));
  return session;
}

void write_input(const SessionInput& input, json& to) {
  to["inputs"] = json::array();
  for (const path& file : input.inputs) to["inputs"].push_back(std::filesystem::absolute(file).string());
  if (!input.sample.empty()) to["sample"] = input.sample;
  if (input.detail != 0) to["detail"] = input.detail;
}

json event_json(const SessionEvent& event) {
  json to;
  to["time"] = event.time;
  if (event.input) write_input(*event.input, to);
  if (!event.knobs.empty()) {
    Settings settings;
    for (const auto& [name, text] : event.knobs) set_knob(settings, name, text);
    const json values = knob_values(settings);  // with their types
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
  if (!stream) throw Error("cannot read session " + file.string(), "no such file or no permission");
  try {
    return read_json(json::parse(stream), file.parent_path());
  } catch (const json::exception& error) {
    throw Error(file.string() + " is no session", error.what());
  } catch (const Error& error) {
    throw Error(file.string() + " is no session", error.what());
  }
}

std::string session_text(const Session& session) {
  json to;
  to["nacre"] = "session 1";
  write_input(session, to);
  to["knobs"] = knob_values(session.settings);
  if (session.camera) to["camera"] = camera_json(*session.camera);
  for (const SessionEvent& event : session.events) to["events"].push_back(event_json(event));
  if (session.duration > 0) to["duration"] = session.duration;
  return to.dump(2) + "\n";
}

std::optional<SessionEvent> session_change(const Session& before, const Session& after) {
  SessionEvent event;
  bool changed = false;
  if (static_cast<const SessionInput&>(before) != after) event.input = after, changed = true;
  Settings was = before.settings, is = after.settings;
  const std::vector<Knob> old = knobs(was), now = knobs(is);
  for (std::size_t k = 0; k < now.size(); ++k)
    if (old[k].text() != now[k].text()) event.knobs[now[k].name] = now[k].text(), changed = true;
  if (after.camera && (!before.camera || camera_json(*before.camera) != camera_json(*after.camera)))
    event.camera = after.camera, changed = true;
  return changed ? std::optional(event) : std::nullopt;
}

void apply_event(const SessionEvent& event, Session& session) {
  if (event.input) static_cast<SessionInput&>(session) = *event.input;
  for (const auto& [name, text] : event.knobs) set_knob(session.settings, name, text);
  if (event.camera) session.camera = event.camera;
}

}  // namespace nacre
