// Nacre: what the commands that compute share: the words of their input, the device, the end of a run.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/common.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// Words that say what goes in and how large the picture is.
struct InputWords {
  std::vector<std::string> files;
  std::string sample, size;
  int detail = 0;
};

/// `file_help` and `detail_help` say what a FILE is, and what --detail counts.
void add_input_options(CLI::App& command, InputWords& words, const std::string& file_help,
                       const std::string& detail_help);

/// The session that the words of `command` ask for: a state, without events. Later ones win: `--session`, the input named
/// on the command line, `preset`, knobs (`--camera` over the session's camera), `--size`. Throws UsageError where a word is off, or there is not exactly one kind of input.
Session asked_session(const CommonOptions& options, const InputWords& words, const KnobOptions& knobs,
                      std::string_view command, const std::function<void(Settings&)>& preset = {});

/// The device that was asked for; says which one it is.
std::unique_ptr<Device> open_device(const CommonOptions& options);

/// Writes the report, `outputs` along with it, where one was asked for.
void write_report(const CommonOptions& options, nlohmann::json report, const std::vector<std::string>& outputs);

/// The result on stdout: one file per line.
void print_outputs(const std::vector<std::string>& outputs);

}  // namespace nacre
