// Nacre: nacre-dicom-import PLACE FOLDER: the volume in a folder of DICOM files, or in a file, as a NRRD in FOLDER.
// Prints "0 path". On failure it prints one line to stderr and exits with 1.
#include <gdcmTrace.h>

#include <cstdio>
#include <exception>
#include <new>

#include "engine/io/dicom_import/series.hpp"
#include "engine/io/import_limits.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: nacre-dicom-import PLACE FOLDER\n", stderr);
    return 2;
  }
  nacre::limit_damage();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  try {
    const std::filesystem::path file = std::filesystem::path(argv[2]) / "volume.seg.nrrd";
    write(nacre::dicom_import::read_series(argv[1]), file);
    std::printf("0 %s\n", file.c_str());
    if (std::fflush(stdout) != 0) return 1;
    return 0;
  } catch (const std::bad_alloc&) {
    std::fputs("nacre-dicom-import: it needs more memory than there is\n", stderr);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "nacre-dicom-import: %s\n", e.what());
  }
  return 1;
}
