// Nacre: formats that libraries of others read, in a child process: a crash there is an error here.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace nacre {

/// A program of ours that a library of others is linked into.
struct Importer {
  const char* program;        ///< beside this program, or in ../libexec/nacre
  const char* variable;       ///< of the environment: names another one
  const char* library;        ///< "VTK"
  const char* other_program;  ///< with which a user may look into the file
};

/// What a child is asked for.
struct ImportRequest {
  std::filesystem::path file;  ///< or folder
  std::vector<std::string> options;
  const char* word;     ///< what is looked for in it: "surface"
  const char* formats;  ///< to which the user may convert it: ".vtp or .vtu"
};

/// What a child made.
struct ImportResult {
  std::shared_ptr<const std::filesystem::path> folder;  ///< removed with the last copy
  std::vector<std::filesystem::path> files;             ///< in `folder`, at least one
  std::vector<double> times;                            ///< one per file, as in the file; 0 if it has none
  std::vector<std::string> parts;                       ///< names of the parts that the file has, as far as it has any
};

/// Whether the child can be run.
bool is_available(const Importer& importer);

/// Runs the child. Throws Error if it reports one (its first line), crashes, or takes more than 120 s; Interrupted if
/// it was stopped by Ctrl-C.
ImportResult import_by_child(const Importer& importer, const ImportRequest& request);

/// From now on children stop (Interrupted) once `*stop` is true. Without this, they stop only if Ctrl-C reaches them
/// themselves, as from a terminal.
void watch_import_children(const std::atomic<bool>* stop);

}  // namespace nacre
