// Nacre: the commands. Each adds its options to the program; what the user asked for runs after parsing.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>
#include <vector>

namespace nacre {

/// Registers a command; sets `run` to what it does when its name is given. `run` throws Error, UsageError, Interrupted.
void add_flow_command(CLI::App& program, std::function<void()>& run);
void add_mesh_command(CLI::App& program, std::function<void()>& run);
void add_info_command(CLI::App& program, std::function<void()>& run);
void add_sample_command(CLI::App& program, std::function<void()>& run);
void add_bench_command(CLI::App& program, std::function<void()>& run);
void add_join_command(CLI::App& program, std::function<void()>& run);
void add_view_command(CLI::App& program, std::function<void()>& run);

/// `execute` runs nacre with these arguments. Throws as the commands do.
void add_rerun_command(CLI::App& program, std::function<void()>& run,
                       std::function<void(const std::vector<std::string>& arguments)> execute);

}  // namespace nacre
