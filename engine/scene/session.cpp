// Nacre: reading and writing of session files.
#include "engine/scene/session.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/scene/knobs.hpp"

namespace nacre {

Session read_session(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw Error("cannot read session " + file.string(), "no such file or no permission");
  Session session;
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    if (!json.is_object()) throw Error(file.string() + " is no session", "not a JSON object");
    for (const auto& input : json.value("inputs", nlohmann::json::array())) {
      const std::filesystem::path path = input.get<std::string>();
      session.inputs.push_back(path.is_absolute() ? path : file.parent_path() / path);
    }
    session.sample = json.value("sample", "");
    session.detail = json.value("detail", 0);
    if (json.contains("knobs")) set_knobs(session.settings, json["knobs"]);
  } catch (const nlohmann::json::exception& error) {
    throw Error(file.string() + " is no session", error.what());
  }
  return session;
}

std::string session_text(const Session& session) {
  nlohmann::json json;
  json["nacre"] = "session 1";
  json["inputs"] = nlohmann::json::array();
  for (const auto& input : session.inputs) json["inputs"].push_back(std::filesystem::absolute(input).string());
  if (!session.sample.empty()) json["sample"] = session.sample;
  if (session.detail != 0) json["detail"] = session.detail;
  json["knobs"] = knob_values(session.settings);
  return json.dump(2) + "\n";
}

}  // namespace nacre
