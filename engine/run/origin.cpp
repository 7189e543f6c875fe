// Nacre: how a result came about.
#include "engine/run/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <mutex>

#include "compute/device/error.hpp"
#include "engine/picture/video.hpp"
#include "engine/scene/session/camera_json.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/system/extension.hpp"
#include "engine/system/sha256.hpp"
#include "include/nacre/version.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int format_number = 1;
constexpr std::string_view origin_start = "{\"Nacre origin\":";  // capitals sort before the other keys
constexpr std::size_t longest_origin = std::size_t(4) << 20;

/// The hash of a file, which is read again only where its size or its time of change has changed.
std::string sha256_of(const fs::path& file, std::uintmax_t bytes) {
  struct Known {
    std::uintmax_t bytes;
    fs::file_time_type changed;
    std::string sha256;
  };
  static std::mutex mutex;
  static std::map<fs::path, Known> known;
  std::error_code code;
  const fs::file_time_type changed = fs::last_write_time(file, code);
  {
    std::scoped_lock lock(mutex);
    const auto found = known.find(file);
    if (!code && found != known.end() && found->second.bytes == bytes && found->second.changed == changed)
      return found->second.sha256;
  }
  std::string hash = sha256_of_file(file);
  std::scoped_lock lock(mutex);
  if (!code) known[file] = {bytes, changed, hash};
  return hash;
}

OriginFile read_origin_file(const fs::path& file) {
  std::error_code code;
  const std::uintmax_t bytes = fs::file_size(file, code);
  return {file.string(), bytes, sha256_of(file, bytes)};
}

json files_json(const std::vector<OriginFile>& files) {
  json list = json::array();
  for (const OriginFile& each : files)
    list.push_back({{"file", each.file}, {"bytes", each.bytes}, {"sha256", each.sha256}});
  return list;
}

std::vector<OriginFile> files_of(const json& from, const char* name) {
  std::vector<OriginFile> files;
  if (from.contains(name))
    for (const json& each : from.at(name))
      files.push_back({each.at("file").get<std::string>(), each.at("bytes").get<std::uintmax_t>(),
                       each.at("sha256").get<std::string>()});
  return files;
}

Origin parse_origin(const json& from) {
  Origin origin;
  origin.version = from.at("version").get<std::string>();
  origin.command = from.at("command").get<std::string>();
  origin.backend = from.at("backend").get<std::string>();
  origin.inputs = files_of(from, "inputs");
  origin.others = files_of(from, "others");
  origin.arrays = files_of(from, "arrays");
  origin.frames = files_of(from, "frames");
  origin.sample = from.value("sample", "");
  origin.detail = from.value("detail", 0);
  origin.knobs = from.at("knobs").get<std::map<std::string, std::string>>();
  if (from.contains("camera")) origin.camera = camera_of(from.at("camera"));
  origin.options = from.value("options", std::vector<std::string>());
  origin.output = from.at("output").get<std::string>();
  origin.beside = from.value("beside", std::map<std::string, std::string>());
  origin.pieces = from.value("pieces", 0);
  origin.interrupted = from.value("interrupted", false);
  return origin;
}

/// The text from the start of an origin to the brace that ends it; empty if there is none. A line that is broken into
/// several comments of Abaqus is joined.
std::string cut_out(std::string text) {
  for (std::size_t at; (at = text.find("\n** ")) != text.npos;) text.erase(at, 4);
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      i += c == '\\';
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{') {
      ++depth;
    } else if (c == '}' && --depth == 0) {
      return text.substr(0, i + 1);
    }
  }
  return {};
}

/// Up to `longest_origin` bytes of a file from the first start of an origin on; empty if there is none.
std::string from_origin_on(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string() + " cannot be read", "no such file or no permission", "check its name");
  std::string held, piece(std::size_t(1) << 20, '\0');
  while (stream) {
    stream.read(piece.data(), std::streamsize(piece.size()));
    held.append(piece, 0, std::size_t(std::max<std::streamsize>(stream.gcount(), 0)));
    const std::size_t at = held.find(origin_start);
    if (at == held.npos) {
      held.erase(0, held.size() - std::min(held.size(), origin_start.size()));
      continue;
    }
    held.erase(0, at);
    if (held.size() >= longest_origin || !cut_out(held).empty()) break;
  }
  return held.starts_with(origin_start) ? held : std::string();
}

/// A report is JSON with line breaks, in which the origin is an object like others.
std::optional<json> origin_in_report(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (stream.peek() != '{') return {};
  const json report = json::parse(stream, nullptr, false);
  if (!report.is_object() || !report.contains("origin")) return {};
  return report["origin"];
}

}  // namespace

Origin origin_of(const Session& session, const std::string& command, const std::string& backend,
                 const std::vector<fs::path>& others) {
  Origin origin;
  origin.version = NACRE_VERSION_STRING;
  origin.command = command;
  origin.backend = backend;
  for (const fs::path& file : session.inputs) origin.inputs.push_back(read_origin_file(file));
  for (const fs::path& file : others) origin.others.push_back(read_origin_file(file));
  origin.sample = session.sample;
  origin.detail = session.detail;
  origin.camera = session.camera;
  Settings defaults, settings = session.settings;
  const std::vector<Knob> table = knobs(settings), usual = knobs(defaults);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const bool counts = table[k].concerns(command) && !(table[k].name == "camera" && session.camera);
    if (counts && (table[k].text() != usual[k].text() || table[k].name == "seed"))
      origin.knobs[table[k].name] = table[k].text();
  }
  const auto add_named = [&](const std::string& file) {
    if (!file.empty()) origin.others.push_back(read_origin_file(file));
  };
  if (!session.camera && is_camera_file(settings.camera)) add_named(settings.camera);
  if (command == "mesh") {
    add_named(settings.materials.names);
    add_named(settings.materials.size_image);
  }
  return origin;
}

OriginFile joined(const std::string& name, const std::vector<OriginFile>& parts) {
  OriginFile all{name, 0, {}};
  Sha256 hash;
  for (const OriginFile& part : parts) {
    all.bytes += part.bytes;
    hash.add(part.sha256.data(), part.sha256.size());
  }
  all.sha256 = hash.finish();
  return all;
}

OriginFile read_frames(const fs::path& folder) {
  std::vector<OriginFile> frames;
  const int count = count_frames(folder);
  for (int number = 0; number < count; ++number) frames.push_back(read_origin_file(folder / frame_name(number)));
  return joined(folder.string(), frames);
}

json origin_json(const Origin& origin) {
  json to = {{"Nacre origin", format_number}, {"version", origin.version}, {"command", origin.command},
             {"backend", origin.backend},     {"knobs", origin.knobs},     {"output", origin.output}};
  if (!origin.inputs.empty()) to["inputs"] = files_json(origin.inputs);
  if (!origin.others.empty()) to["others"] = files_json(origin.others);
  if (!origin.arrays.empty()) to["arrays"] = files_json(origin.arrays);
  if (!origin.frames.empty()) to["frames"] = files_json(origin.frames);
  if (!origin.sample.empty()) to["sample"] = origin.sample;
  if (origin.detail != 0) to["detail"] = origin.detail;
  if (origin.camera) to["camera"] = camera_json(*origin.camera);
  if (!origin.options.empty()) to["options"] = origin.options;
  if (!origin.beside.empty()) to["beside"] = origin.beside;
  if (origin.pieces > 0) to["pieces"] = origin.pieces;
  if (origin.interrupted) to["interrupted"] = true;
  return to;
}

std::string origin_text(const Origin& origin) {
  std::string text = origin_json(origin).dump(-1, ' ', true, json::error_handler_t::replace);
  for (std::size_t at; (at = text.find("--")) != text.npos;) text.replace(at + 1, 1, "\\u002d");
  return text;
}

std::optional<Origin> find_origin(const fs::path& file) {
  try {
    std::optional<json> found = origin_in_report(file);
    if (!found) {
      const std::string text = from_origin_on(file);
      if (text.empty()) return {};
      found = json::parse(cut_out(text));
    }
    if (found->value("Nacre origin", 0) != format_number)
      throw Error("a later version of Nacre made " + file.string(), "this one does not understand how", "use that one");
    return parse_origin(*found);
  } catch (const json::exception&) {
    throw Error(file.string() + " does not say how it was made", "what it says about that is damaged");
  }
}

Session session_of(const Origin& origin) {
  if (!origin.arrays.empty())
    throw Error("the data of this result are in no file", "the library made it of arrays in memory",
                "its knobs are in the file: save the arrays, and give them with these knobs");
  Session session;
  for (const OriginFile& input : origin.inputs) session.inputs.emplace_back(input.file);
  session.sample = origin.sample;
  session.detail = origin.detail;
  for (const auto& [name, text] : origin.knobs) set_knob(session.settings, name, text);
  session.camera = origin.camera;
  return session;
}

bool may_hold_session(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".json" || extension == ".png";
}

Session open_session(const fs::path& file) {
  const bool json_file = lower_extension(file) == ".json";
  if (json_file && !origin_in_report(file)) return read_session(file);
  const std::optional<Origin> origin = find_origin(file);
  if (!origin)
    throw Error(file.string() + " is not a session", "it does not say how it was made",
                "give a session file, or a picture made by this program");
  return session_of(*origin);
}

void check_inputs(const Origin& origin, const fs::path& result) {
  for (const OriginFile& folder : origin.frames)
    if (read_frames(folder.file) != folder)
      throw Error("cannot make " + result.string() + " again", "the frames in " + folder.file + " have changed since",
                  "restore the frames that it was made from");
  for (const auto* files : {&origin.inputs, &origin.others})
    for (const OriginFile& each : *files) {
      std::error_code code;
      if (!fs::is_regular_file(each.file, code))
        throw Error("cannot make " + result.string() + " again", each.file + " is not there",
                    "go to the folder from which it was made, or put the file there");
      if (read_origin_file(each.file) != each)
        throw Error("cannot make " + result.string() + " again",
                    fmt::format("{} has changed since (its SHA-256 was {}...)", each.file, each.sha256.substr(0, 12)),
                    "restore the file that it was made from");
    }
}

}  // namespace nacre
