// Nacre: main: command line in, exit status out.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.hpp"
#include "app/common.hpp"
#include "app/parameter_names.hpp"
#include "app/ranks.hpp"
#include "compute/device/error.hpp"
#include "engine/io/mesh_format_writers.hpp"
#include "engine/io/vtk_child.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/system/output_file.hpp"

namespace {

enum Status { done = 0, failed = 1, usage = 2, interrupted = 130 };

/// Prints one line, whatever the text.
Status fail(Status status, std::string line) {
  nacre::wait_for_the_first();
  for (char& c : line)
    if (c == '\n') c = ' ';
  fmt::print(stderr, "nacre: {}\n", line);
  return status;
}

/// `status`, or failure where the output could not be written: a full disk, a closed pipe.
Status flushed(Status status) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
  const std::string why = errno != 0 ? fmt::format(" ({})", std::strerror(errno)) : "";
  return fail(failed, "cannot write to the standard output" + why + "; redirect it elsewhere");
}

/// The help without CLI11's notes on what a flag sets: "--edges,--no-edges" in place of "--edges,--no-edges{false}".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    std::string name = CLI::Formatter::make_option_name(option, positional);
    for (const std::string note : {"{false}", "{true}"})
      for (std::size_t at; (at = name.find(note)) != name.npos;) name.erase(at, note.size());
    return name;
  }
};

Status run(std::vector<std::string> arguments);

struct Command {
  std::string_view name;
  void (*add)(CLI::App& program, std::function<void()>& run);
};

constexpr std::array<Command, 8> commands = {{
    {"flow", nacre::add_flow_command},
    {"mesh", nacre::add_mesh_command},
    {"info", nacre::add_info_command},
    {"sample", nacre::add_sample_command},
    {"bench", nacre::add_bench_command},
    {"join", nacre::add_join_command},
    {"view", nacre::add_view_command},
    {"rerun",
     [](CLI::App& program, std::function<void()>& command) {
       nacre::add_rerun_command(program, command, [](const std::vector<std::string>& again) { run(again); });
     }},
}};

/// `arguments`: what follows the program's name.
Status run(std::vector<std::string> arguments) {
  CLI::App program("Nacre: unsteady flow on surfaces, and multi-material meshes from labelled volumes.", "nacre");
  nacre::use_hdf5();
  program.formatter(std::make_shared<HelpFormatter>());
  program.set_version_flag("--version", std::string("nacre ") + nacre::version);
  bool knobs = false;
  program.add_flag("--knobs", knobs, "print all knobs with their defaults, ranges and units");
  std::function<void()> command;
  // Declaring options takes most of the start: only those of the command that is named are needed.
  const auto named = std::find_if(commands.begin(), commands.end(), [&](const Command& each) {
    return !arguments.empty() && arguments.front() == each.name;
  });
  for (const Command& each : commands)
    if (named == commands.end() || each.name == named->name) each.add(program, command);
  for (CLI::App* each : program.get_subcommands({})) each->set_version_flag("--version", program.version());
  try {
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    program.parse(std::move(arguments));
  } catch (const CLI::Success& success) {  // --help, --version
    program.exit(success);
    return done;
  } catch (const CLI::ParseError& error) {
    throw nacre::UsageError(std::string(error.what()) + "; see nacre --help");
  }
  if (knobs) {
    fmt::print("{}", nacre::knob_table());
    return done;
  }
  if (!command) {
    fmt::print("{}", program.help());
    return usage;
  }
  if (nacre::run_ranks() && nacre::run_ranks()->count() > 1 && program.get_subcommands().front()->get_name() != "flow")
    throw nacre::UsageError("only nacre flow works on several processes; leave mpirun away");
  command();
  return done;
}

/// Some destructors, such as that of JSON, ask for memory themselves; where there is none, nothing can be caught.
[[noreturn]] void leave_without_memory() noexcept {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    std::fputs("nacre: out of memory\n", stderr);
    nacre::leave_without_unfinished_files(failed);
  } catch (...) {
  }
  std::abort();
}

/// Runs the program; whatever it throws becomes a line and a status.
Status guarded_run(int argc, char** argv) {
  try {
    nacre::join_run();
    return flushed(run({argv + std::min(argc, 1), argv + argc}));
  } catch (const nacre::Interrupted&) {
    nacre::remove_unfinished_files();
    return interrupted;
  } catch (const nacre::UsageError& error) {
    return fail(usage, nacre::with_options(error.what()));
  } catch (const std::bad_alloc&) {
    nacre::remove_unfinished_files();
    return fail(failed, "out of memory; lower --resolution (flow), or raise --max-size and --min-size (mesh)");
  } catch (const std::exception& error) {
    nacre::remove_unfinished_files();
    return fail(nacre::interrupt_flag() ? interrupted : failed, nacre::with_options(error.what()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::set_terminate(leave_without_memory);
  nacre::catch_interrupts();
  nacre::watch_import_children(&nacre::interrupt_flag());
  return nacre::leave_run(guarded_run(argc, argv));
}
