// Nacre: nacre-vtk-import [--parts NAMES] FILE FOLDER: converts a file that VTK reads to one .vtp per time step in
// FOLDER; of its parts (patches, blocks), those that are named.
// nacre-vtk-import --volume FILE FOLDER: converts the image in it to one .vti in FOLDER.
// Prints "part name" for each part that it has, and "time path" for each file. On failure it
// prints one line to stderr and exits with 1.
#include <unistd.h>
#include <vtkAlgorithm.h>
#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

#include "engine/io/import_limits.hpp"
#include "engine/io/vtk_import/complaints.hpp"
#include "engine/io/vtk_import/read.hpp"
#include "engine/io/vtk_import/surface.hpp"
#include "engine/io/vtk_import/volume.hpp"

namespace {

using namespace nacre::vtk_import;

void fail_on_complaint() {
  if (!first_complaint().empty()) throw std::runtime_error(first_complaint());
}

template <class Writer>
void write(vtkDataObject* data, const std::string& path) {
  vtkNew<Writer> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() != 1 || writer->GetErrorCode() != vtkErrorCode::NoError)
    throw std::runtime_error(std::string("cannot write the temporary ") + path + ": " +
                             vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
}

void require(const std::string& file) {
  if (::access(file.c_str(), R_OK) != 0) throw std::runtime_error("it cannot be opened");
}

void import_volume(const std::string& file, const std::filesystem::path& folder) {
  require(file);
  const std::string path = folder / "volume.vti";
  write<vtkXMLImageDataWriter>(read_image(file), path);
  std::printf("0 %s\n", path.c_str());
}

void import(const std::string& file, const std::string& parts, const std::filesystem::path& folder) {
  require(file);
  const vtkSmartPointer<vtkAlgorithm> reader = reader_for(file, parts);
  const std::vector<double> times = time_steps(*reader);
  fail_on_complaint();
  for (std::size_t k = 0; k < times.size(); ++k) {
    reader->UpdateTimeStep(times[k]);
    fail_on_complaint();
    const std::string path = folder / ("step_" + std::to_string(k) + ".vtp");
    vtkDataObject* data = reader->GetOutputDataObject(0);
    write<vtkXMLPolyDataWriter>(surface_of(data, parts), path);
    if (k == 0)
      for (const std::string& name : block_names(data)) std::printf("part %s\n", name.c_str());
    std::printf("%.17g %s\n", times[k], path.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool volume = argc == 4 && std::strcmp(argv[1], "--volume") == 0;
  const bool parts = argc == 5 && std::strcmp(argv[1], "--parts") == 0;
  if (argc != 3 && !volume && !parts) {
    std::fputs("usage: nacre-vtk-import [--volume | --parts NAMES] FILE FOLDER\n", stderr);
    return 2;
  }
  nacre::limit_damage();
  keep_complaints();
  try {
    volume ? import_volume(argv[2], argv[3]) : import(argv[argc - 2], parts ? argv[2] : "", argv[argc - 1]);
    if (std::fflush(stdout) != 0) throw std::runtime_error("the result cannot be handed over");
    return 0;
  } catch (const std::bad_alloc&) {
    std::fputs("nacre-vtk-import: it needs more memory than there is\n", stderr);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "nacre-vtk-import: %s\n", e.what());
  }
  return 1;
}
