// Nacre: which files contain the time steps of the user's input.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/io/raw_mesh.hpp"

namespace nacre {

/// One time step; several parts form one surface.
struct FileStep {
  double time = 0;
  std::vector<std::filesystem::path> parts;
};

/// Steps in the order of time, at least one.
struct FileSteps {
  std::vector<FileStep> steps;
  std::vector<std::string> warnings;
  std::shared_ptr<const void> keep_alive;  ///< keeps temporary files; may be null
  std::string patches;                     ///< as find_steps got it
  std::vector<std::string> parts;          ///< names of the parts that the file has, if VTK read it
};

/// Steps of one file: those that a .pvd or .series lists, those that VTK finds in a file of its own formats, otherwise
/// the file itself at time 0. `patches`: as `convert_with_vtk` takes it, for what VTK reads. Throws Error if a listed
/// file is missing, or if VTK is needed and not built in.
FileSteps find_steps(const std::filesystem::path& path, const std::string& patches = {});

/// Several files of one series: at their own times if all have one and all differ, otherwise at 0, 1, 2, ... Throws
/// Error if one of them is itself a series.
FileSteps find_steps(const std::vector<std::filesystem::path>& paths, const std::string& patches = {});

/// True for files that list others: .pvd, and .vtp.series and its like as ParaView writes them.
bool is_file_list(const std::filesystem::path& path);

/// True for files that only VTK reads.
bool goes_through_vtk(const std::filesystem::path& path);

/// The mesh of a step, with its parts combined; `patches` of those that VTK reads. Throws Error if one cannot be read.
RawMesh read_step(const FileStep& step, const std::string& patches = {});

}  // namespace nacre
