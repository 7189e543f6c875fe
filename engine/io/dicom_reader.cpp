// Nacre: DICOM series and segmentations, by GDCM in a child process.
#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>

#include "compute/device/error.hpp"
#include "engine/io/import_child.hpp"
#include "engine/io/volume_readers.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr Importer gdcm{"nacre-dicom-import", "NACRE_DICOM_IMPORT", "GDCM", "3D Slicer"};
constexpr int most_looked_at = 64;  // files of a folder

bool begins_as_dicom(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char head[132] = {};
  return stream.read(head, sizeof(head)) && std::memcmp(head + 128, "DICM", 4) == 0;
}

Volume read_converted(const fs::path& path, const std::function<Volume(const fs::path&)>& read) {
  const ImportResult imported = import_by_child(gdcm, {path, {}, "volume", ".nrrd"});
  const std::string temporary = imported.files[0].string();
  const auto said_of = [&](std::string text) {  // the user knows the file by its own name
    for (std::size_t at = text.find(temporary); at != text.npos; at = text.find(temporary))
      text.replace(at, temporary.size(), path.string());
    return text;
  };
  try {
    Volume volume = read(imported.files[0]);
    for (std::string& warning : volume.warnings) warning = said_of(warning);
    return volume;
  } catch (const Error& error) {
    throw Error(said_of(error.what()));
  }
}

}  // namespace

bool is_dicom(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return fs::is_regular_file(path, error) && begins_as_dicom(path);
  int looked_at = 0;
  for (fs::recursive_directory_iterator it(path, fs::directory_options::skip_permission_denied, error), end;
       !error && it != end && looked_at < most_looked_at; it.increment(error)) {
    if (!it->is_regular_file(error)) continue;
    if (begins_as_dicom(it->path())) return true;
    ++looked_at;
  }
  return false;
}

bool dicom_child_available() { return is_available(gdcm); }

Volume read_dicom(const fs::path& path) { return read_converted(path, read_nrrd); }

Volume read_dicom_layer(const fs::path& path, int layer) {
  return read_converted(path, [layer](const fs::path& file) { return read_nrrd_layer(file, layer); });
}

}  // namespace nacre
