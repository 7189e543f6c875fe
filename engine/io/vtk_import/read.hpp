// Nacre: the VTK reader for a file's extension.
#pragma once

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

namespace nacre::vtk_import {

/// A reader with the file's name set and all its arrays switched on. Throws std::runtime_error for unknown extensions.
vtkSmartPointer<vtkAlgorithm> reader_for(const std::string& file);

/// The time steps that the reader announces; one step at 0 where it announces none.
std::vector<double> time_steps(vtkAlgorithm& reader);

}  // namespace nacre::vtk_import
