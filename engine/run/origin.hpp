// Nacre: how a result came about, in a line that the result itself carries, so that it can be made again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// A file that a result depends on.
struct OriginFile {
  std::string file;  ///< as the user named it
  std::uintmax_t bytes = 0;
  std::string sha256;

  bool operator==(const OriginFile&) const = default;
};

/// All that the bytes of a result depend on, and nothing else: no date, no machine, no number of threads, and not the
/// name of the result.
struct Origin {
  std::string version, command;  ///< of nacre: "flow", "mesh", "view"
  std::string backend;           ///< "cpu" or "cuda"
  std::vector<OriginFile> inputs;
  std::vector<OriginFile> others;            ///< that the inputs or the knobs name
  std::vector<OriginFile> arrays;            ///< instead of inputs: in memory of a user of the library, by their names
  std::vector<OriginFile> frames;            ///< of `join`: the folder, with its frames `joined`
  std::string sample;                        ///< instead of inputs
  int detail = 0;                            ///< of the sample
  std::map<std::string, std::string> knobs;  ///< those that are not at their defaults, and the seed
  std::optional<Camera> camera;              ///< of the session, which the knob `camera` does not say
  std::vector<std::string> options;          ///< of the command, beside knobs: "--per-material"
  std::string output;  ///< which result this is: "image", "video", "out", "report"; "screenshot", of a window
  std::map<std::string, std::string> beside;  ///< of a report: the other results of the run, and their extensions
  int pieces = 0;                             ///< of values that several processes wrote; 0: the result is one file
  bool interrupted = false;                   ///< the particles were stopped by Ctrl-C, and nobody knows where
};

/// The inputs with their hashes, and what of the session concerns `command`. Reads all input files, each once in a
/// process as long as it does not change. Throws Error where one cannot be read. `others`: files that the inputs name.
Origin origin_of(const Session& session, const std::string& command, const std::string& backend,
                 const std::vector<std::filesystem::path>& others);

/// Several files or arrays as one: their bytes in all, and the SHA-256 of their hexadecimal SHA-256, joined in order.
OriginFile joined(const std::string& name, const std::vector<OriginFile>& parts);

/// The entry of Origin::frames for a folder of frames. Throws Error if one is missing or cannot be read.
OriginFile read_frames(const std::filesystem::path& folder);

/// One line of ASCII: JSON that begins with {"Nacre origin": and has no two hyphens in a row, so that it can be a
/// comment of any format.
std::string origin_text(const Origin& origin);
nlohmann::json origin_json(const Origin& origin);

/// The origin that a file carries, wherever in it; none if it carries none. Throws Error if it is damaged or of a later
/// version of Nacre that this one does not understand.
std::optional<Origin> find_origin(const std::filesystem::path& file);

/// The session that a result shows: inputs, knobs and camera. Throws Error if it was made of arrays in memory.
Session session_of(const Origin& origin);

/// A session file, or a result of Nacre that says how it was made, such as a picture. Throws Error as `read_session`.
Session open_session(const std::filesystem::path& file);

/// Is the file a session, or a picture or report that may say which session it shows? By its extension.
bool may_hold_session(const std::filesystem::path& file);

/// Throws Error that names the first input that is missing or has changed since.
void check_inputs(const Origin& origin, const std::filesystem::path& result);

}  // namespace nacre
