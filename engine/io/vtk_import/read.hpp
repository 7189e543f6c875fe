// Nacre: the VTK reader for a file's extension.
#pragma once

#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

namespace nacre::vtk_import {

/// A reader with the name of the file set and all its arrays enabled. `parts`: patches of an OpenFOAM case, as
/// names_part takes them; empty: all. Throws std::runtime_error for unknown extensions.
vtkSmartPointer<vtkAlgorithm> reader_for(const std::string& file, const std::string& parts = {});

/// The time steps that the reader reports; one step at 0 if it reports none.
std::vector<double> time_steps(vtkAlgorithm& reader);

}  // namespace nacre::vtk_import
