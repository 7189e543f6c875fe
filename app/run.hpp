// Nacre: what the commands that compute share: options for the input, the device, the end of a run.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/common.hpp"
#include "engine/run/origin.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// Options for the input and the size of the picture.
struct InputOptions {
  std::vector<std::string> files;
  std::string sample, size;
  int detail = 0;
};

/// `file_help` and `detail_help` say what a FILE is, and what --detail counts.
void add_input_options(CLI::App& command, InputOptions& input, const std::string& file_help,
                       const std::string& detail_help);

/// The session that a command line asks for: a state, without events. Later ones override earlier ones: `--session`,
/// the input named on the command line, `preset`, knobs (`--camera` overrides the session's camera), `--size`. Throws
/// UsageError for an option with a wrong value, or unless there is exactly one kind of input.
Session requested_session(const CommonOptions& options, const InputOptions& input, const KnobOptions& knobs,
                          std::string_view command, const std::function<void(Settings&)>& preset = {});

/// The device that was asked for; prints which one it is.
std::unique_ptr<Device> open_device(const CommonOptions& options);

/// Writes the report, with `outputs` and how they came about in it, if one was asked for.
void write_report(const CommonOptions& options, nlohmann::json report, const std::vector<std::string>& outputs,
                  const std::optional<Origin>& origin = {});

/// Notes which results a run has, by their options and without what is empty. `nacre rerun` needs that for a report.
void add_beside(Origin& origin, const std::vector<std::pair<std::string, std::string>>& files);

/// How one of them comes about alone. What only other results depend on is left out, so that a result is the same
/// whatever else is written.
Origin origin_alone(Origin origin, const std::string& output);

/// The same as the text that the result carries.
std::string origin_of_output(const Origin& origin, const std::string& output);

/// Notices files that are replaced or changed while they are in use: parts of two different files make no result.
class InputWatch {
 public:
  explicit InputWatch(const std::vector<std::filesystem::path>& files) { add(files); }
  void add(const std::vector<std::filesystem::path>& files);

  /// Throws Error that names a file that is not as it was when it was added.
  void check() const;

 private:
  struct Stamp {
    std::filesystem::path file;
    std::array<std::int64_t, 5> numbers;
  };
  static std::array<std::int64_t, 5> stamp_of(const std::filesystem::path& file);

  std::vector<Stamp> stamps_;
};

/// Prints the result on stdout: one file per line; nothing during the life of a `PrintNothing`.
void print_outputs(const std::vector<std::string>& outputs);

/// For a command that runs inside of another one, and whose files are not the result.
struct PrintNothing {
  PrintNothing();
  ~PrintNothing();
  PrintNothing(const PrintNothing&) = delete;
  PrintNothing& operator=(const PrintNothing&) = delete;
};

}  // namespace nacre
