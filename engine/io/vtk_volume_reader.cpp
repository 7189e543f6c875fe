// Nacre: reads the volumes that the child process converts with VTK.
#include "compute/device/error.hpp"
#include "engine/io/volume_readers.hpp"
#include "engine/io/vtk_child.hpp"

namespace nacre {

Volume read_vtk_volume(const std::filesystem::path& path) {
  const VtkConversion conversion = convert_volume_with_vtk(path);
  const std::string temporary = conversion.files[0].string();
  try {
    return read_vti(conversion.files[0]);
  } catch (const Error& error) {
    // The user knows the file by its own name.
    std::string text = error.what();
    for (std::size_t at = text.find(temporary); at != text.npos; at = text.find(temporary))
      text.replace(at, temporary.size(), path.string());
    throw Error(text);
  }
}

}  // namespace nacre
