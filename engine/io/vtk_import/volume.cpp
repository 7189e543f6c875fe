// Nacre: reads a file as an image by VTK.
#include "engine/io/vtk_import/volume.hpp"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSLCReader.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "engine/io/vtk_import/complaints.hpp"
#include "engine/io/vtk_import/read.hpp"

namespace nacre::vtk_import {
namespace {

vtkSmartPointer<vtkAlgorithm> image_reader(const std::string& file, const std::string& extension) {
  if (extension == ".slc") {
    vtkNew<vtkSLCReader> reader;
    reader->SetFileName(file.c_str());
    return reader.Get();
  }
  return reader_for(file);
}

}  // namespace

vtkSmartPointer<vtkImageData> read_image(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const vtkSmartPointer<vtkAlgorithm> reader = image_reader(file, extension);
  reader->Update();
  if (!first_complaint().empty()) throw std::runtime_error(first_complaint());
  const vtkSmartPointer<vtkImageData> image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  if (!image || image->GetNumberOfPoints() == 0) throw std::runtime_error("it holds no volume");
  for (int i = 0; i < image->GetPointData()->GetNumberOfArrays(); ++i)
    if (vtkDataArray* array = image->GetPointData()->GetArray(i); array && !array->GetName()) array->SetName("values");
  return image;
}

}  // namespace nacre::vtk_import
