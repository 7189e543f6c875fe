// Nacre: what the commands that compute share: options for the input, the device, the end of a run.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/common.hpp"
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

/// Writes the report, with `outputs` in it, if one was asked for.
void write_report(const CommonOptions& options, nlohmann::json report, const std::vector<std::string>& outputs);

/// Prints the result on stdout: one file per line.
void print_outputs(const std::vector<std::string>& outputs);

}  // namespace nacre
