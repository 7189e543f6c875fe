// Nacre: the VTK reader for a file's extension.
#include "engine/io/vtk_import/read.hpp"

#include <vtkExodusIIReader.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkGenericEnSightReader.h>

#include "engine/io/vtk_import/surface.hpp"
#if NACRE_HAS_VTKHDF
#include <vtkHDFReader.h>
#endif
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkOpenFOAMReader.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLPStructuredGridReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace nacre::vtk_import {
namespace {

template <class Reader>
vtkSmartPointer<vtkAlgorithm> simple_reader(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  return reader.Get();
}

vtkSmartPointer<vtkAlgorithm> legacy_reader(const std::string& file) {
  vtkNew<vtkGenericDataObjectReader> reader;  // reads one array of each kind unless told otherwise
  reader->SetFileName(file.c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllFieldsOn();
  return reader.Get();
}

vtkSmartPointer<vtkAlgorithm> ensight_reader(const std::string& file) {
  vtkNew<vtkGenericEnSightReader> reader;
  reader->SetCaseFileName(file.c_str());
  reader->ReadAllVariablesOn();
  return reader.Get();
}

vtkSmartPointer<vtkAlgorithm> exodus_reader(const std::string& file) {
  vtkNew<vtkExodusIIReader> reader;
  reader->SetFileName(file.c_str());
  reader->GenerateObjectIdCellArrayOff();
  reader->GenerateGlobalElementIdArrayOff();
  reader->GenerateGlobalNodeIdArrayOff();
  reader->UpdateInformation();
  reader->SetAllArrayStatus(vtkExodusIIReader::NODAL, 1);
  reader->SetAllArrayStatus(vtkExodusIIReader::ELEM_BLOCK, 1);
  return reader.Get();
}

/// The wanted parts; if none are named, the patches if there are any (wall values are stored there), otherwise the
/// inner mesh.
vtkSmartPointer<vtkAlgorithm> foam_reader(const std::string& file, const std::string& wanted) {
  vtkNew<vtkOpenFOAMReader> reader;
  reader->SetFileName(file.c_str());
  reader->CreateCellToPointOn();
  reader->UpdateInformation();
  reader->EnableAllCellArrays();
  reader->EnableAllPointArrays();
  const int parts = reader->GetNumberOfPatchArrays();
  const auto is_patch = [&](int i) {
    const std::string name = reader->GetPatchArrayName(i);
    return name.find("internalMesh") == std::string::npos && name.find("group/") == std::string::npos;
  };
  bool any_patch = false;
  for (int i = 0; i < parts; ++i) any_patch = any_patch || is_patch(i);
  const auto is_wanted = [&](int i) {
    if (wanted.empty()) return !any_patch || is_patch(i);
    const std::string name = reader->GetPatchArrayName(i);
    return names_part(wanted, name.substr(name.rfind('/') + 1));
  };
  bool any_wanted = false;
  for (int i = 0; i < parts; ++i) any_wanted = any_wanted || is_wanted(i);
  // With no such part all are read, and their names are told.
  for (int i = 0; i < parts; ++i)
    reader->SetPatchArrayStatus(reader->GetPatchArrayName(i), !any_wanted || is_wanted(i));
  return reader.Get();
}

}  // namespace

vtkSmartPointer<vtkAlgorithm> reader_for(const std::string& file, const std::string& parts) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".vtk") return legacy_reader(file);
  if (extension == ".vts") return simple_reader<vtkXMLStructuredGridReader>(file);
  if (extension == ".vtr") return simple_reader<vtkXMLRectilinearGridReader>(file);
  if (extension == ".vtm" || extension == ".vtmb") return simple_reader<vtkXMLMultiBlockDataReader>(file);
  if (extension == ".pvts") return simple_reader<vtkXMLPStructuredGridReader>(file);
  if (extension == ".pvtr") return simple_reader<vtkXMLPRectilinearGridReader>(file);
  if (extension == ".case" || extension == ".encas") return ensight_reader(file);
  if (extension == ".ex2" || extension == ".exo" || extension == ".e" || extension == ".g") return exodus_reader(file);
  if (extension == ".foam") return foam_reader(file, parts);
#if NACRE_HAS_VTKHDF
  if (extension == ".vtkhdf") return simple_reader<vtkHDFReader>(file);
#endif
  throw std::runtime_error("files that end in \"" + extension + "\" are not read");
}

std::vector<double> time_steps(vtkAlgorithm& reader) {
  reader.UpdateInformation();
  std::vector<double> times;
  vtkInformation* information = reader.GetOutputInformation(0);
  vtkInformationDoubleVectorKey* key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (information && information->Has(key)) {
    const double* values = information->Get(key);
    times.assign(values, values + information->Length(key));
  }
  times.erase(std::remove_if(times.begin(), times.end(), [](double t) { return !std::isfinite(t); }), times.end());
  return times.empty() ? std::vector<double>{0.0} : times;
}

}  // namespace nacre::vtk_import
