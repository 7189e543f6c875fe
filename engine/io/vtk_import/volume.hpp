// Nacre: a file that VTK reads as an image.
#pragma once

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <string>

namespace nacre::vtk_import {

/// The image in a .slc or legacy .vtk file. Throws std::runtime_error if VTK
/// complains or the file holds none.
vtkSmartPointer<vtkImageData> read_image(const std::string& file);

}  // namespace nacre::vtk_import
