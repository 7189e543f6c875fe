// Nacre: reads a file as an image by VTK.
#pragma once

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <string>

namespace nacre::vtk_import {

/// The image in a .slc or legacy .vtk file. Throws std::runtime_error if VTK reports an error or the file contains no
/// image.
vtkSmartPointer<vtkImageData> read_image(const std::string& file);

}  // namespace nacre::vtk_import
